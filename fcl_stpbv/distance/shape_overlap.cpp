#include "fcl_stpbv/distance/shape_overlap.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/convex/direction_cone.h"
#include "fcl_stpbv/convex/epa.h"
#include "fcl_stpbv/convex/support.h"

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

/// To the top of the hill that the search ended on, where rounding or the size of the polytope stopped it:
/// tries normals around the best one, nearer and nearer.
template <typename Search>
void climbToLeastOverlap(Search& epa) {
  constexpr int kTrials = 4000;
  double step = 0.02;  // rad
  for (int trials = 0; step > 1e-9 && trials < kTrials;) {
    const Vector3d n = epa.n, e = n.unitOrthogonal(), f = n.cross(e);
    const double gap = epa.gap;
    for (int k = 0; k < 8 && epa.gap <= gap; ++k, ++trials) {
      const double angle = 0.785398163397448 * k + 40.0 * step;  // turned a little each round
      epa.look((n + step * (std::cos(angle) * e + std::sin(angle) * f)).normalized());
    }
    if (epa.gap <= gap) step *= 0.5;
  }
}

}  // namespace

WidestGap widestGapByCuts(ShapeQuery& q, const StartNormal& start) {
  Trial trial = trialAlong(q, start.n, start.patch);
  WidestGap best{trial.at, trial.difference.norm(), false, false};
  if (!(best.bound > q.rounding.gap)) return {trial.at, best.bound, false, true};  // touching
  const auto asTrial = [&] { return DirectionTrial{trial.at.n, trial.at.gap, trial.difference}; };
  constexpr auto never = [](const DirectionTrial&) { return false; };
  best.solved = !bisectDirections(
      asTrial(), 0.25 * q.rounding.gap,
      [&](const Vector3d& n) {
        trial = trialAlong(q, n, trial.at.patch);
        best.bound = std::min(best.bound, trial.difference.norm());
        if (trial.at.gap > best.at.gap) best.at = trial.at;
        return asTrial();
      },
      never);
  best.at.apart = best.at.gap > 0.0;
  best.overlap = best.at.gap < -q.rounding.gap;
  return best;
}

WidestGap leastOverlap(ShapeQuery& q, const StartNormal& start) {
  StpBvCore core{q.body, start.patch, q.steps};
  using Difference = ConvexDifference<StpBvCore, const Shape>;
  Difference difference(core, q.shape, q.pose);
  Epa<Difference> epa(difference, q.rounding.gap);
  epa.look(start.n);
  if (!epa.run()) climbToLeastOverlap(epa);
  // The strictly convex body's point is the only one; of a face the shape gave a corner, so take what is
  // opposite.
  WidestGap best{{}, std::max(epa.bound, epa.gap), true, epa.solved()};
  const SupportPoint onBody = core.supportPoint(epa.n);
  best.at.n = epa.n;
  best.at.patch = onBody.patch;
  best.at.gap = epa.gap;
  best.at.y = onBody.point + epa.gap * epa.n;
  best.at.corners = 1;
  return best;
}

}  // namespace fcl_stpbv
