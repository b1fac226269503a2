#include "fcl_stpbv/distance/shape_overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/distance/first_corners.h"
#include "fcl_stpbv/distance/polytope.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// The gap along one normal between the two whole cores, and the difference of the points that tell it.
struct Trial {
  Nearest at;
  Vector3d difference;
};

Trial trialAlong(ShapeQuery& q, const Vector3d& n, int hint) {
  const VolumeView view = viewVolume(q.body, n, hint, q.steps);
  Trial trial;
  trial.at.n = n;
  trial.at.patch = view.patch;
  trial.at.y = q.facing(n);
  trial.at.gap = view.gap(trial.at.y);
  trial.at.corners = 1;
  trial.difference = trial.at.y - view.point;
  ++q.pairs;
  return trial;
}

}  // namespace

WidestGap widestGapByCuts(ShapeQuery& q, const StartNormal& start) {
  Trial trial = trialAlong(q, start.n, start.patch);
  WidestGap best{trial.at, trial.difference.norm(), false, false};
  if (!(best.bound > q.rounding.gap)) return {trial.at, best.bound, false, true};  // touching
  NormalCone cone(trial.at.gap > 0.0 ? trial.at.n : Vector3d(trial.difference));
  for (int i = 0; i < NormalCone::kMaxCuts; ++i) {
    // With a gap the better normals lie where its gradient points; without one, where the difference does.
    const Vector3d across = trial.difference - trial.difference.dot(trial.at.n) * trial.at.n;
    const Vector3d cut = trial.at.gap > 0.0 ? across : trial.difference;
    if (!(cut.norm() > 0.25 * q.rounding.gap) || !cone.cut(cut)) {
      best.solved = true;
      break;
    }
    trial = trialAlong(q, cone.middle(), trial.at.patch);
    best.bound = std::min(best.bound, trial.difference.norm());
    if (trial.at.gap > best.at.gap) best.at = trial.at;
  }
  best.at.apart = best.at.gap > 0.0;
  best.overlap = best.at.gap < -q.rounding.gap;
  return best;
}

WidestGap leastOverlap(ShapeQuery& q, const StartNormal& start) {
  constexpr double kRelative = 1e-6;  // of the depth, which is as good as proven
  constexpr int kMore = 16;           // steps from there for a normal to rounding, which flat faces give
  constexpr int kAttempts = 4;
  WidestGap best{trialAlong(q, start.n, start.patch).at, 0.0, true, false};
  const auto take = [&](const Vector3d& n) {
    const Trial trial = trialAlong(q, n, -1);
    if (trial.at.gap > best.at.gap) best.at = trial.at;
    return trial.difference;
  };
  struct Corner {
    Vector3d w;
  };
  // Rounding may spoil a polytope, of slivers along edges and generators: another start makes other faces.
  for (int attempt = 0; attempt < kAttempts && !best.solved; ++attempt) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(attempt, Vector3d(0.48, 0.6, 0.64)).toRotationMatrix();
    std::array<Corner, 4> first;
    const auto furthest = [&](const Vector3d& m) { return Corner{take(-(turn * m).normalized())}; };
    if (!firstCorners(furthest, q.rounding.gap, first)) break;
    // Not yet around the origin: hulls grow over it as over any other point.
    Polytope polytope({first[0].w, first[1].w, first[2].w, first[3].w}, Polytope::Origin::anywhere);
    double bound = 0.0;
    int more = 0;
    while (polytope.sound()) {
      const Polytope::Face nearest = polytope.nearest();
      // Inside the difference, so with the origin inside it no direction leads out sooner.
      bound = std::min(bound, -nearest.distance);
      const Vector3d difference = take(-nearest.normal);
      const double open = -best.at.gap - nearest.distance;
      if (nearest.distance > 0.0 && open <= kRelative * nearest.distance + q.rounding.gap) {
        best.solved = true;
        if (open <= q.rounding.gap || ++more > kMore) break;
      }
      if (!(nearest.normal.dot(difference) - nearest.distance > q.rounding.gap)) break;
      if (!polytope.expand(difference)) break;
    }
    best.bound = std::min(best.bound, bound);
  }
  if (!best.solved) {  // rounding or the size of the polytope stopped it: at least to the top of this hill
    constexpr int kTrials = 4000;
    double step = 0.02;  // rad
    for (int trials = 0; step > 1e-9 && trials < kTrials;) {
      const Vector3d n = best.at.n, e = n.unitOrthogonal(), f = n.cross(e);
      const double gap = best.at.gap;
      for (int k = 0; k < 8 && best.at.gap <= gap; ++k, ++trials) {
        const double angle = 0.785398163397448 * k + 40.0 * step;  // turned a little each round
        take((n + step * (std::cos(angle) * e + std::sin(angle) * f)).normalized());
      }
      if (best.at.gap <= gap) step *= 0.5;
    }
  }
  // The strictly convex body's point is the only one; of a face the shape gave a corner, so take what is
  // opposite.
  best.at.y = viewVolume(q.body, best.at.n, best.at.patch, q.steps).point + best.at.gap * best.at.n;
  return best;
}

}  // namespace fcl_stpbv
