// A pair of simple shapes, and the steps of its searches (shape_pair.cpp, shape_depth.cpp).
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <optional>

#include "fcl_stpbv/convex/gjk.h"
#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv::detail {

/// Two points of the cores that are opposite each other along a normal. Frame of the first shape.
struct OppositePoints {
  Eigen::Vector3d n{0, 0, 1};  ///< unit, from the first shape to the second
  double gap =
      -std::numeric_limits<double>::infinity();  ///< between the cores' supporting planes along it (m)
  Eigen::Vector3d onA{0, 0, 0};                  ///< the first core's point
  Eigen::Vector3d toB{0, 0, 0};  ///< from there to the second core's, `gap` along `n` to rounding
};

/// A pair of shapes in canonical order, in the frame of the first one.
struct ShapePair {
  using Difference = ConvexDifference<const Shape, const Shape>;
  using Corner = Difference::Corner;
  using Gjk = GjkResult<Corner>;
  /// Largest error of a normal for which Newton's method is tried (rad).
  static constexpr double kWidest = 0.1;

  const Shape &a, &b;
  RelativePose pose;
  double rounding = 0.0;     ///< of a gap (m)
  double certificate = 0.0;  ///< bound on that error, with the poses' own rounding (m)
  bool valid = false;

  ShapePair(const Shape& first, const Eigen::Isometry3d& poseA, const Shape& second,
            const Eigen::Isometry3d& poseB)
      : a(first), b(second), pose(relativePose(poseA, poseB)) {
    if (!pose.valid || !a.valid() || !b.valid() || (a.unbounded() && b.unbounded())) return;
    const double size = unpack(pose.translation).lpNorm<1>() + a.centre.lpNorm<1>() + a.reach +
                        b.centre.lpNorm<1>() + b.reach;
    rounding = 8.0 * std::numeric_limits<double>::epsilon() * size;
    certificate = kGapRounding * (size + a.margin + b.margin);
    valid = rounding < 1e100;  // squares of squares must not overflow
  }

  double margins() const { return a.margin + b.margin; }

  /// Whether a shape is curved, so that GJK only approximates the answer, by chords.
  bool curved() const { return curved(a) || curved(b); }
  static bool curved(const Shape& s) {
    return s.kind == ShapeKind::cylinder || s.kind == ShapeKind::cone || s.kind == ShapeKind::ellipsoid;
  }

  /// Whether a shape is given by its corners.
  static bool isHull(const Shape& s) {
    return s.kind == ShapeKind::triangle || s.kind == ShapeKind::polytope;
  }

  /// Tests whether `way`, from the first core's point `found.onA` to a point of the second core, connects the
  /// nearest points, and completes `found`. False if it is no longer than rounding, or if the gap between the
  /// whole cores along it is smaller than its length.
  bool isNearest(const Packed& way, OppositePoints& found) const {
    const double length = std::sqrt(dot(way, way));
    if (!(length > rounding)) return false;
    found.n = unpack(way / length);
    found.toB = unpack(way);
    found.gap = Difference(a, b, pose).support(found.n).gap;
    return length - found.gap <= rounding;
  }

  /// A corner of the difference from two points of the cores that are near each other. They come from at most
  /// `rounds` alternating projections onto the two cores (von Neumann 1950). A shape given by its corners
  /// contributes its centre.
  Corner nearCorner(int rounds) const;

  /// GJK from two points of the cores, until both bounds agree or `told(lower, upper)` returns true. It
  /// starts from the line of the centres instead if `from` has no points, if the points are the centres, or
  /// if they are so near to each other that tetrahedra with their corner are too flat to detect an overlap.
  template <typename Told>
  Gjk search(const Told& told, const Corner& from) const {
    constexpr double kApart = 1e8;  // of rounding
    constexpr int kSteps = 120;     // polytopes take a dozen, round bodies some thirty
    Simplex<Corner> start;
    if (from.w.norm() > kApart * rounding && !(isHull(a) && isHull(b))) start.add(from);
    const Eigen::Vector3d d = pose.placed(b.centre) - a.centre;
    Difference difference(a, b, pose);
    return gjk<Corner>(
        difference, start, d.norm() > rounding ? Eigen::Vector3d(d.normalized()) : Eigen::Vector3d::UnitX(),
        rounding, kSteps,
        [&](double lower, double upper) { return upper - lower <= 0.5 * rounding || told(lower, upper); });
  }

  /// Converts the result of a search to the world frame: `n` is the normal from A to B, `onA` a point of A's
  /// core, `toB` the vector from there to a point of B's core.
  Distance inWorld(const Eigen::Vector3d& n, const Eigen::Vector3d& onA, const Eigen::Vector3d& toB) const;
};

/// The points opposite each other for pairs that need no search: a ball and a shape of few features, two
/// capsules, and most boxes. False for other pairs, and if there is no closed form; `found` may then still
/// have a gap along a normal.
bool oppositeInClosedForm(const ShapePair& p, OppositePoints& found);

/// What a search knows about the widest gap between two cores. Frame of the first shape.
struct NearNormal {
  Eigen::Vector3d n;    ///< unit, from the first shape to the second
  double gap;           ///< along it (m)
  Eigen::Vector3d onA;  ///< a point of the first core near the answer's
  double angle;         ///< error of `n` (rad)
  /// The answer's features probably reach from the support points along `n` down to these heights (m); not
  /// used if negative.
  double featureA = -1.0, featureB = -1.0;
};

/// The widest gap between the cores of two bounded shapes, with the two points; for cores apart these are the
/// nearest points. Lengths within `rounding` (m) count as equal. No value if the features near the known
/// normal do not contain an answer with at least its gap.
std::optional<OppositePoints> nearestOnFeatures(const Shape& a, const Shape& b, const RelativePose& pose,
                                                const NearNormal& known, double rounding);

/// For two cores apart and a normal `n` that is accurate to the square root of rounding: the widest gap and
/// two points opposite each other. No value if rounding prevents it.
std::optional<OppositePoints> oppositeLevel(const ShapePair& p, Eigen::Vector3d n);

/// For cores that have a common point according to GJK: the shortest translation that separates them.
Distance overlapping(const ShapePair& p, const ShapePair::Gjk& found);

}  // namespace fcl_stpbv::detail
