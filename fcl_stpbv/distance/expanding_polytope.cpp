#include "fcl_stpbv/distance/expanding_polytope.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/distance/polytope.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// Where the polytope is this much of the depth from the surface, a maximum is likely to be next to it.
constexpr double kNear = 0.1;

/// Where it is this near, the maximum that its normal leads to is the only one there.
constexpr double kClose = 1e-3;

/// Normals of one maximum found twice differ by less (rad).
constexpr double kSame = 1e-7;

/// The difference's point furthest against the sample's normal.
Vector3d furthest(const Sample& s) { return s.core * s.n + s.across; }

/// Three unit vectors across `n`, a third of a turn apart.
std::array<Vector3d, 3> around(const Vector3d& n) {
  const Vector3d e = n.unitOrthogonal(), f = std::sqrt(0.75) * n.cross(e);
  return {e, f - 0.5 * e, -f - 0.5 * e};
}

bool isMaximum(const BodyPair& pair, const Sample& x) {
  return x.across.squaredNorm() <= pair.acrossRounding() * pair.acrossRounding();
}

/// The points supporting normals a little off a maximum: what the polytope would find last, and with them it is
/// close to the surface there.
std::array<Vector3d, 3> pointsAround(const BodyPair& pair, const Sample& top, Work& work) {
  // A tilt that no radius of curvature turns into more than a part of that.
  const double tilt =
      std::sqrt(0.5 * kClose * std::abs(top.core) / (pair.a().radii().rho + pair.b().radii().rho));
  std::array<Vector3d, 3> points = around(top.n);
  for (Vector3d& m : points)
    m = furthest(pair.sampleFrom((top.n + tilt * m).normalized(), top.patch, work.steps));
  return points;
}

bool grow(const BodyPair& pair, Polytope& polytope, Sample& x, double& bound, Work& work) {
  double least = std::numeric_limits<double>::infinity();  // distance of the faces done with
  bool solved = false;
  while (polytope.sound() && !solved) {
    const Polytope::Face nearest = polytope.nearest();
    solved = -x.core - nearest.distance <= pair.gapRounding();
    // The polytope lies inside the difference, so with the origin inside it no direction leads out sooner.
    bound = -std::max(0.0, std::min(least, nearest.distance));
    if (solved) break;
    Sample trial = pair.sampleFrom(-nearest.normal, {-1, -1}, work.steps);
    if (trial.core > 0.0) return false;
    const Vector3d point = furthest(trial);
    const double open = -trial.core - nearest.distance;
    Vector3d ignored;
    const bool top = open <= kNear * nearest.distance && settle(pair, trial, ignored, work);
    const bool another = top && (trial.n - x.n).squaredNorm() > kSame * kSame;
    if (trial.core > x.core) x = trial;
    if (open <= pair.gapRounding() || (top && open <= kClose * nearest.distance) || !polytope.expand(point)) {
      least = std::min(least, nearest.distance);
      polytope.putAside();
      continue;
    }
    if (!another) continue;
    for (const Vector3d& p : pointsAround(pair, trial, work))
      if (polytope.sound()) polytope.expand(p);
  }
  return solved;
}

}  // namespace

bool expandPolytope(const BodyPair& pair, const std::array<Vector3d, 4>& corner, Sample& x, double& bound,
                    Work& work) {
  Polytope polytope(corner);
  return grow(pair, polytope, x, bound, work);
}

FCL_STPBV_VECTORIZED
bool expandPolytope(const BodyPair& pair, Sample& x, double& bound, Work& work) {
  if (isMaximum(pair, x)) {
    const std::array<Vector3d, 3> near = pointsAround(pair, x, work);
    Polytope polytope({near[0], near[1], near[2], furthest(pair.sampleFrom(-x.n, {-1, -1}, work.steps))},
                      Polytope::Origin::anywhere);
    return grow(pair, polytope, x, bound, work);
  }
  const std::array<Vector3d, 3> m = around(x.n);
  const auto from = [&](const Vector3d& n) { return furthest(pair.sampleFrom(n, {-1, -1}, work.steps)); };
  Polytope polytope({from(m[0]), from(m[1]), from(m[2]), from(-x.n)}, Polytope::Origin::anywhere);
  return grow(pair, polytope, x, bound, work);
}

}  // namespace fcl_stpbv
