// Exact signed distance between two STP-BVs, and between an STP-BV and a simple convex shape or a point, with
// its derivative and certified lower and upper bounds. Also between two simple shapes: certified, but without
// a continuous gradient.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

#include "fcl_stpbv/convex/shape.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// How accurate an answer is.
enum class DistanceStatus {
  /// The signed distance up to rounding: for bodies apart, touching, or penetrating by at most r1 + r2. For
  /// half spaces and planes at any depth; for two simple shapes often deeper, too.
  exact,
  /// Deeper penetration: the translation that separates is only locally the shortest; the true value lies in
  /// [lower, upper].
  local,
  bounded,  ///< not solved up to rounding; the true value lies in [lower, upper]
  /// A pose is not a rigid motion (an entry of its rotation is off by more than 1e-6) or is 1e150 m away. The
  /// distance and the lower bound are minus infinity, the upper bound is infinite; normal and points are
  /// zero, the patches -1.
  invalid,
};

/// Name of a status, as in reports.
constexpr const char* toString(DistanceStatus status) {
  switch (status) {
    case DistanceStatus::exact:
      return "exact";
    case DistanceStatus::local:
      return "local";
    case DistanceStatus::bounded:
      return "bounded";
    case DistanceStatus::invalid:
      break;
  }
  return "invalid";
}

/// Derivative of the distance with respect to a body's twist, [linear; angular], about the origin of the
/// body's frame, in world axes. Unaligned, so that its memory layout does not depend on the caller's compiler
/// flags.
using TwistGradient = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;

/// Answer to one query. World frame, metres.
struct Distance {
  DistanceStatus status = DistanceStatus::invalid;  ///< how good the answer is
  /// Signed: negative where the bodies overlap. Minus infinity if the status is `invalid`, so that no
  /// comparison takes the pair for clear.
  double distance = -std::numeric_limits<double>::infinity();
  /// Certified lower bound: the gap between the two supporting planes perpendicular to `normal`, rounded
  /// down.
  double lower = -std::numeric_limits<double>::infinity();
  /// Certified upper bound, rounded up: from the distance of two points of the cores; if the cores overlap,
  /// minus a proven lower bound on the depth. Both bounds are widened by more than the rounding error, so
  /// `lower <= truth <= upper` holds exactly (docs/theory.md, 5). They differ by a few roundings of the
  /// bodies' size, or of R if the cores nearly touch.
  double upper = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal{0, 0, 0};  ///< unit vector from body 1 to body 2
  std::array<Eigen::Vector3d, 2> point{Eigen::Vector3d(0, 0, 0),
                                       Eigen::Vector3d(0, 0, 0)};  ///< witness points, on the smooth surfaces
  std::array<int, 2> patch{-1, -1};                                ///< patches that the witness points lie on
  /// Number of patch pairs solved, a measure of the work.
  int patchPairs = 0;
  int patchSteps = 0;  ///< number of region boundaries crossed on the two Gauss maps

  /// The same answer with the two bodies exchanged.
  Distance mirrored() const {
    Distance other = *this;
    other.normal = -normal;
    other.point = {point[1], point[0]};
    other.patch = {patch[1], patch[0]};
    return other;
  }
  /// Derivative of the distance with respect to the twist of body `which` (0 or 1) about `origin`, the
  /// position of that body's frame in the world (m) (paper eq. 2; docs/theory.md, 6).
  TwistGradient gradient(int which, const Eigen::Vector3d& origin) const {
    const Eigen::Vector3d n = (which == 0 ? -1.0 : 1.0) * normal;
    TwistGradient g;
    g.head<3>() = n;
    g.tail<3>() = (point[static_cast<std::size_t>(which)] - origin).cross(n);
    return g;
  }
};

/// State of a pair between queries, for a warm start: the next query starts near the last answer. The adapter
/// can also fill it from the witness points of FCL's polyhedra. The caller owns it. It is optional and
/// changes only the time of a query, with two exceptions: a `local` answer may be another local maximum, and
/// where bodies just touch the status may change between `exact` and `bounded`.
struct PairCache {
  Eigen::Vector3d normal{0, 0, 0};   ///< last normal, world frame; zero: none
  std::array<int, 2> patch{-1, -1};  ///< last patches; -1: none
  /// The last normal in each body's own frame, pointing outward; zero: not known.
  std::array<Eigen::Vector3f, 2> seen{Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0, 0, 0)};

  /// The same with the two bodies exchanged.
  PairCache mirrored() const { return {-normal, {patch[1], patch[0]}, {seen[1], seen[0]}}; }
  /// The last normal, scaled to unit length. Zero if there is none, or if the caller has stored a vector that
  /// is not near unit length.
  Eigen::Vector3d direction() const {
    const double squared = normal.squaredNorm();
    return isDirection(squared) ? Eigen::Vector3d(normal / std::sqrt(squared)) : Eigen::Vector3d(0, 0, 0);
  }
  /// Whether a vector of this squared length is near enough to unit length to be a direction.
  static constexpr bool isDirection(double squared) { return squared > 0.25 && squared < 4.0; }
};

/// Signed distance between `a` placed at `poseA` and `b` placed at `poseB` (poses in the world). Never
/// throws, allocates or returns NaN. A pose that is not rigid gives the status `invalid`.
Distance distance(const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b,
                  const Eigen::Isometry3d& poseB, PairCache* cache = nullptr);

/// Signed distance between `volume` placed at `poseVolume` and `shape` placed at `poseShape`. The distance is
/// C1, because one strictly convex body in a pair is enough (paper Th. 2.1). Never throws, allocates or
/// returns NaN.
///
/// The status is `exact` while the two cores are apart, that is, down to a penetration of the volume's r plus
/// the shape's margin, and always for half spaces and planes. Body 1 of the result is the volume; `patch[1]`
/// is -1.
Distance distance(const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
                  const Eigen::Isometry3d& poseShape, PairCache* cache = nullptr);

/// The same with the shape as body 1.
Distance distance(const Shape& shape, const Eigen::Isometry3d& poseShape, const StpBv& volume,
                  const Eigen::Isometry3d& poseVolume, PairCache* cache = nullptr);

/// Signed distance of a point (world, m) to the volume; `normal` points from the volume to the point.
Distance distance(const StpBv& volume, const Eigen::Isometry3d& pose, const Eigen::Vector3d& point,
                  PairCache* cache = nullptr);

/// Signed distance of two shapes, at least one of them bounded. Never throws or allocates.
///
/// The method depends on the pair. A half space or a plane: closed form. Cores apart: GJK. Cores that
/// overlap: EPA. Newton's method on the two nearest features then makes normal and points accurate to
/// rounding. The status is `exact` if both bounds agree up to rounding, else `bounded`. For overlapping round
/// bodies the bounds then agree within 1e-6 of the cores' depth, unless rounding or the size limit of EPA's
/// polytope stops the search sooner. The status is `invalid` for a shape that is not `valid()`, a pose that
/// is not rigid, and two unbounded shapes. Both orders of the shapes give the same answer, with the bodies
/// exchanged.
///
/// For shapes that are apart, `distance` is the distance of the two witness points. For shapes that overlap,
/// it is minus the length of the translation along `normal` that separates them.
Distance distance(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                  const Eigen::Isometry3d& poseB);

/// Whether the two shapes are certainly farther apart than `x` (m). Uses the same searches as distance(), but
/// stops as soon as a bound decides. For overlapping shapes the depth is searched only if `x` is negative.
/// False for an invalid pair. If a plane between the shapes decides, the cache keeps its normal.
bool isFartherThan(double x, const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                   const Eigen::Isometry3d& poseB, PairCache* cache = nullptr);

/// A common point of two bounded shapes that overlap, up to rounding (world, m). If they do not overlap, a
/// point between them. The pair must be valid.
Eigen::Vector3d commonPoint(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b,
                            const Eigen::Isometry3d& poseB);

}  // namespace fcl_stpbv
