// The set of directions that may still give the widest gap: a convex cone, which planes cut smaller and
// smaller.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace fcl_stpbv::detail {

/// A convex cone of directions, stored as its corner rays in order. Every cut through its middle removes
/// about half of it. So a search that cuts at each trial always ends, for any bodies.
class DirectionCone {
 public:
  static constexpr int kMaxCuts = 200;  ///< halving a hemisphere down to rounding takes about 110

  /// All directions `m` with `m.pole >= 0`.
  explicit DirectionCone(const Eigen::Vector3d& pole);

  /// Keeps the directions with `m.g >= 0`. False when none is left.
  bool cut(const Eigen::Vector3d& g);

  /// A unit direction near the middle of the cone.
  Eigen::Vector3d middle() const;

 private:
  static constexpr std::size_t kMost = kMaxCuts + 8;  // few sides apart from the first need their middle

  bool cutHemisphere(const Eigen::Vector3d& g);

  Eigen::Vector3d pole_;
  std::array<Eigen::Vector3d, kMost> corner_;
  std::size_t count_ = 0;  // 0: the whole hemisphere
};

/// One direction that was tried: the gap of the cores along it, and the second body's support point minus the
/// first body's.
struct DirectionTrial {
  Eigen::Vector3d n;  ///< unit, from the first body to the second
  double gap;         ///< between the supporting planes, `n.difference` (m)
  Eigen::Vector3d difference;

  /// Gradient of the gap on the sphere (m).
  Eigen::Vector3d across() const { return difference - difference.dot(n) * n; }
};

/// Searches the widest gap between two convex cores by bisection of the remaining directions.
///
/// 1. The support points of a trial bound the gap along all directions: along `m` it is at most
///    `m.difference`. So if a trial has no gap, every direction with a gap lies in the half space
///    `m.difference > 0`, and the trial's own direction does not.
/// 2. If a trial has a gap, the directions with wider gaps lie on the side to which its gradient points
///    (docs/theory.md, 5: the set is convex).
/// 3. In both cases a plane cuts the cone in two. The next trial is the middle of the remaining part.
///
/// `trial(n)` evaluates the direction `n`. `done(t)` returns true to end the search; the result is then true.
/// The result is false if no direction is left, or if the normal of the cutting plane is shorter than `flat`
/// (m), so that it is only rounding.
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
