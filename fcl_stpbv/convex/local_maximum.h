// Proves, for a local maximum of the gap between overlapping cores, that no normal within some angle of it
// has a wider gap.
//
// The maximum has the normal n and the depth D, and the support point of the difference A - B along n is D n.
// The difference contains arcs, segments and caps of balls through that point. Consider a normal at the angle
// t from n:
// 1. The height of the point alone is D cos(t), which is less than D by D (1 - cos(t)).
// 2. Let x be the normal's component along an arc of radius k through the point. The arc reaches higher than
//    the point by at least k x^2 / 2, or, if it ends before, by x times half the distance to its end. A
//    segment reaches higher by x times the distance to its end.
// 3. If the sum of these is at least D (1 - cos(t)), the cores overlap by D or more along that normal.
// For all normals within an angle this is a test of one quadratic form in the plane perpendicular to n
// (docs/theory.md, 5, "Next to a maximum").
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

/// A maximum of the gap, and the arcs, segments and caps of the difference of the cores around its support
/// point.
class LocalMaximum {
 public:
  static constexpr double kEndless = std::numeric_limits<double>::infinity();

  /// No maximum.
  LocalMaximum() = default;
  /// `n`: unit, along which the cores overlap by `depth` (m).
  LocalMaximum(const Eigen::Vector3d& n, double depth) : n_(n), depth_(depth) {}

  double depth() const { return depth_; }

  /// Adds an arc through the point along the unit vector `d`. It is ignored if `d` is not perpendicular to
  /// the normal. `reach`: the radius times the sine of the angle to the nearer end of the arc (m).
  void addArc(const Eigen::Vector3d& d, double radius, double reach) {
    if (!(std::abs(d.dot(n_)) < kAcross)) return;
    if (isFirstArc_) e_ = d, f_ = n_.cross(d), isFirstArc_ = false;
    const double x = d.dot(e_), y = d.dot(f_);
    add({x * x, x * y, y * y, radius, reach});
  }
  /// Adds a segment along `d`. `length`: from the point to its nearer end (m).
  void addSegment(const Eigen::Vector3d& d, double length) {
    if (std::abs(d.dot(n_)) < kExactlyAcross) addArc(d, kEndless, 2.0 * length);
  }
  /// Adds a cap of a ball, that is, an arc along every direction; a disc is one of infinite radius.
  void addCap(double radius, double reach) { add({1.0, 0.0, 1.0, radius, reach}); }
  void addDisc(double length) { addCap(kEndless, 2.0 * length); }

  /// Whether the cores overlap by at least the depth along every normal within an angle from `n`.
  bool holdsWithin(double sine, double cosine) const {
    if (!(cosine > kLeast)) return false;
    double a = 0.0, b = 0.0, c = 0.0;  // [a b; b c]: quadratic form of the radii's sum, times the sine
    for (int i = 0; i < count_; ++i) {
      const Part& p = part_[at(i)];
      const double radius = std::min(p.radius * sine, p.reach);
      a += radius * p.xx, b += radius * p.xy, c += radius * p.yy;
    }
    const double needed = kSafe * 2.0 * depth_ / (1.0 + cosine) * sine;
    return a > needed && (a - needed) * (c - needed) >= b * b;
  }

  /// For the part of the difference B - A beyond the plane with the unit outward normal `m`, near -n, at
  /// `distance` from the origin (m): whether no way out through that part is shorter than this maximum's
  /// depth.
  bool holdsBeyond(const Eigen::Vector3d& m, double distance) const {
    const double c1 = -n_.dot(m), c2 = distance / depth_;
    if (!(c1 > kLeast && c2 > kLeast)) return false;
    const double s1 = n_.cross(m).norm(), s2 = std::sqrt(std::max(0.0, (1.0 - c2) * (1.0 + c2)));
    return holdsWithin(s1 * c2 + c1 * s2, c1 * c2 - s1 * s2);
  }

 private:
  struct Part {
    double xx, xy, yy;     // products of its direction's coordinates
    double radius, reach;  // m
  };
  static constexpr int kMost = 6;                  // parts of both bodies; further ones are ignored
  static constexpr double kLeast = 0.7;            // cosine: normals at a larger angle need another proof
  static constexpr double kSafe = 1.001;           // allows for the point being D n only up to rounding
  static constexpr double kAcross = 1e-9;          // cosine: beyond it the direction is only rounding
  static constexpr double kExactlyAcross = 4e-15;  // cosine: an inclined segment is higher on one side only

  void add(const Part& p) {
    if (p.reach > 0.0 && count_ < kMost) part_[at(count_++)] = p;
  }

  Eigen::Vector3d n_{0, 0, 1}, e_{0, 0, 0}, f_{0, 0, 0};  // the first arc's direction, and across it and n
  double depth_ = 0;
  std::array<Part, kMost> part_;
  int count_ = 0;
  bool isFirstArc_ = true;
};

}  // namespace fcl_stpbv::detail
