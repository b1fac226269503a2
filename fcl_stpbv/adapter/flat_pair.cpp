#include "fcl_stpbv/adapter/flat_pair.h"

#include <algorithm>
#include <limits>

#include "fcl_stpbv/adapter/flat_overlap.h"
#include "fcl_stpbv/adapter/simplex.h"

namespace fcl_stpbv {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr int kSteps = 120;  // polytopes take a dozen, round bodies some thirty

enum class Outcome { told, overlap, unknown };

/// GJK between the cores in the first body's frame: only the bodies' own coordinates and their mutual
/// distance enter.
struct Search {
  const Shape &a, &b;
  Matrix3d rotation;
  Vector3d translation;
  double rounding = 0.0;
  std::array<Vector3d, kSteps> onA;
  Simplex simplex;
  Vector3d n{0, 0, 0}, v{0, 0, 0};
  double lower = -std::numeric_limits<double>::infinity(), upper = -lower;

  Search(const Shape& first, const Eigen::Isometry3d& poseA, const Shape& second,
         const Eigen::Isometry3d& poseB)
      : a(first),
        b(second),
        rotation(poseA.linear().transpose() * poseB.linear()),
        translation(poseA.linear().transpose() * (poseB.translation() - poseA.translation())) {}

  /// Until both bounds agree or `told(lower, upper)` says that it has heard enough.
  template <typename Told>
  Outcome run(const Told& told) {
    if (a.unbounded() || b.unbounded() || !a.valid() || !b.valid()) return Outcome::unknown;
    rounding = 8.0 * std::numeric_limits<double>::epsilon() *
               (translation.norm() + a.centre.norm() + a.reach + b.centre.norm() + b.reach);
    if (!(rounding < 1e100)) return Outcome::unknown;
    n = rotation * b.centre + translation - a.centre;
    n = n.norm() > rounding ? Vector3d(n.normalized()) : Vector3d::UnitX();
    v = n;
    for (int k = 0; k < kSteps; ++k) {
      const auto index = static_cast<std::size_t>(k);
      onA[index] = a.support(n);
      const Vector3d w = rotation * b.support(-(rotation.transpose() * n)) + translation - onA[index];
      lower = std::max(lower, n.dot(w));  // any normal gives a lower bound (docs/theory.md, 5)
      if (upper - lower <= 0.5 * rounding || told(lower, upper)) break;
      bool known = false;
      for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.size); ++i)
        known = known || simplex.corner[i].point == w;
      if (known) break;
      Simplex grown = simplex, reduced;
      grown.add({w, k, k});
      const NearestPoint nearest = reduceToNearest(grown, reduced);
      const double length = nearest.point.norm();
      if (nearest.inside || !(length > rounding)) return Outcome::overlap;
      if (!(length < upper)) break;  // rounding
      simplex = reduced;
      v = nearest.point;
      upper = length;
      n = v / length;
    }
    upper = std::max(upper, lower);
    return Outcome::told;
  }
};

}  // namespace

Distance flatDistance(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                      const Eigen::Isometry3d& poseB) {
  Distance result;
  result.lower = -std::numeric_limits<double>::infinity();
  result.upper = std::numeric_limits<double>::infinity();
  Search s(a, poseA, b, poseB);
  if (s.run([](double, double) { return false; }) != Outcome::told || !(s.lower > 0.0)) return result;

  Vector3d pointA(0, 0, 0);
  for (std::size_t i = 0; i < static_cast<std::size_t>(s.simplex.size); ++i)
    pointA += s.simplex.weight[i] * s.onA[static_cast<std::size_t>(s.simplex.corner[i].vertexA)];
  const double margins = a.margin + b.margin;
  result.status = s.upper - s.lower <= s.rounding ? DistanceStatus::exact : DistanceStatus::bounded;
  result.distance = s.upper - margins;
  result.lower = s.lower - margins;
  result.upper = s.upper - margins;
  result.normal = (poseA.linear() * s.n).normalized();
  result.point = {poseA * Vector3d(pointA + a.margin * s.n), poseA * Vector3d(pointA + s.v - b.margin * s.n)};
  return result;
}

bool flatFartherThan(double x, const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                     const Eigen::Isometry3d& poseB) {
  const double core = x + a.margin + b.margin;
  Search s(a, poseA, b, poseB);
  const Outcome outcome =
      s.run([&](double lower, double upper) { return lower > core + s.rounding || upper <= core; });
  if (outcome == Outcome::unknown) return false;
  if (s.lower > core) return true;  // along whatever normal, apart or not
  if (outcome == Outcome::told && s.upper <= core) return false;
  return core < 0.0 && flatOverlap(a, poseA, b, poseB).lower > x;
}

}  // namespace fcl_stpbv
