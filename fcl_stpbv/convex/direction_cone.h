// The directions that may still hold the widest gap: a convex cone, cut down plane by plane.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace fcl_stpbv::detail {

/// A convex cone of directions, kept as its corner rays in order. Every cut through its middle takes about
/// half of it, so a search that cuts at each trial ends whatever the bodies look like.
class DirectionCone {
 public:
  static constexpr int kMaxCuts = 200;  ///< halving a hemisphere down to rounding takes about 110

  /// All directions `m` with `m.pole >= 0`.
  explicit DirectionCone(const Eigen::Vector3d& pole);

  /// Keeps the directions with `m.g >= 0`. False when none is left.
  bool cut(const Eigen::Vector3d& g);

  /// A unit direction well inside.
  Eigen::Vector3d middle() const;

 private:
  static constexpr std::size_t kMost = kMaxCuts + 8;  // few sides but the first need their middle

  bool cutHemisphere(const Eigen::Vector3d& g);

  Eigen::Vector3d pole_;
  std::array<Eigen::Vector3d, kMost> corner_;
  std::size_t count_ = 0;  // none: still the hemisphere
};

/// One direction tried: the gap of the cores along it, and the difference of the two points that tell it,
/// second body's less first's.
struct DirectionTrial {
  Eigen::Vector3d n;  ///< unit, from the first body to the second
  double gap;         ///< between the supporting planes, `n.difference` (m)
  Eigen::Vector3d difference;

  /// Gradient of the gap on the sphere (m).
  Eigen::Vector3d across() const { return difference - difference.dot(n) * n; }
};

/// Looks for the widest gap between two convex cores by bisection of the directions left.
///
/// 1. The points of a trial bound the gap everywhere: along `m` it is at most `m.difference`.
///    So where a trial has no gap, all directions with one lie in the half space of its
///    difference, and the trial itself does not.
/// 2. Where it has a gap, the wider ones lie where its gradient points
///    (docs/theory.md, 5: the set is convex).
/// 3. Either way a plane cuts the cone in two, and the next trial is the middle of what is left.
///
/// `trial(n)` looks along `n`, and `done(t)` ends the search. True where it did; false where no direction is
/// left, or where the plane to cut by is shorter than `flat` (m), rounding.
template <typename Trial, typename Done>
bool bisectDirections(const DirectionTrial& first, double flat, Trial&& trial, Done&& done) {
  DirectionTrial t = first;
  const auto plane = [](const DirectionTrial& x) { return x.gap > 0.0 ? x.across() : x.difference; };
  DirectionCone cone(t.gap > 0.0 ? t.n : t.difference);
  for (int i = 0; i < DirectionCone::kMaxCuts; ++i) {
    const Eigen::Vector3d g = plane(t);
    if (!(g.norm() > flat) || !cone.cut(g)) return false;
    t = trial(cone.middle());
    if (done(t)) return true;
  }
  return false;
}

}  // namespace fcl_stpbv::detail
