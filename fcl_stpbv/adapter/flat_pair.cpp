#include "fcl_stpbv/adapter/flat_pair.h"

#include <limits>

#include "fcl_stpbv/adapter/simplex.h"

namespace fcl_stpbv {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Distance flatDistance(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                      const Eigen::Isometry3d& poseB) {
  constexpr int kSteps = 120;  // polytopes take a dozen, round bodies some thirty
  Distance result;
  result.lower = -std::numeric_limits<double>::infinity();
  result.upper = std::numeric_limits<double>::infinity();
  if (a.unbounded() || b.unbounded() || !a.valid() || !b.valid()) return result;
  // In the first body's frame: only the bodies' own coordinates and their mutual distance enter.
  const Matrix3d rotation = poseA.linear().transpose() * poseB.linear();
  const Vector3d translation = poseA.linear().transpose() * (poseB.translation() - poseA.translation());
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() *
                          (translation.norm() + a.centre.norm() + a.reach + b.centre.norm() + b.reach);
  if (!(rounding < 1e100)) return result;

  std::array<Vector3d, kSteps> onA;
  Simplex simplex;
  Vector3d n = rotation * b.centre + translation - a.centre;
  n = n.norm() > rounding ? Vector3d(n.normalized()) : Vector3d::UnitX();
  Vector3d v = n;
  double lower = -std::numeric_limits<double>::infinity(), upper = -lower;
  for (int k = 0; k < kSteps; ++k) {
    const auto index = static_cast<std::size_t>(k);
    onA[index] = a.support(n);
    const Vector3d w = rotation * b.support(-(rotation.transpose() * n)) + translation - onA[index];
    lower = std::max(lower, n.dot(w));  // any normal gives a lower bound (docs/theory.md, 5)
    if (upper - lower <= 0.5 * rounding) break;
    bool known = false;
    for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.size); ++i)
      known = known || simplex.corner[i].point == w;
    if (known) break;
    Simplex grown = simplex, reduced;
    grown.add({w, k, k});
    const NearestPoint nearest = reduceToNearest(grown, reduced);
    const double length = nearest.point.norm();
    if (nearest.inside || !(length > rounding)) return result;
    if (!(length < upper)) break;  // rounding
    simplex = reduced;
    v = nearest.point;
    upper = length;
    n = v / length;
  }
  if (!(lower > 0.0)) return result;

  Vector3d pointA(0, 0, 0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.size); ++i)
    pointA += simplex.weight[i] * onA[static_cast<std::size_t>(simplex.corner[i].vertexA)];
  const double margins = a.margin + b.margin;
  upper = std::max(upper, lower);
  result.status = upper - lower <= rounding ? DistanceStatus::exact : DistanceStatus::bounded;
  result.distance = upper - margins;
  result.lower = lower - margins;
  result.upper = upper - margins;
  result.normal = (poseA.linear() * n).normalized();
  result.point = {poseA * Vector3d(pointA + a.margin * n), poseA * Vector3d(pointA + v - b.margin * n)};
  return result;
}

}  // namespace fcl_stpbv
