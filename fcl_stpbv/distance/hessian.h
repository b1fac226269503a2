// Second derivatives of the distance, and the velocities of the normal and the witness points, in closed
// form.
#pragma once

#include <Eigen/Core>
#include <array>

#include "fcl_stpbv/convex/shape.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv {

/// Second derivatives of an answer: how it changes with a small motion of both bodies, to second order. The
/// columns are the 12 components of both twists: [linear; angular] of body 1 about its origin, then of body
/// 2; world axes. The distance is piecewise C2. On a boundary between patches, or between a shape's faces,
/// edges and corners, these are the values of one side.
struct DistanceHessian {
  /// Along poses with origins `o + v t` and rotations `exp(w t) R`, the distance's second derivative is
  /// `twists^T matrix twists`; symmetric.
  Eigen::Matrix<double, 12, 12, Eigen::DontAlign> matrix;
  /// Multiplied by the twists it gives the velocity of the normal (1/s).
  Eigen::Matrix<double, 3, 12, Eigen::DontAlign> normal;
  /// Multiplied by the twists it gives the velocities of the witness points (m/s), including that they slide
  /// on their bodies.
  std::array<Eigen::Matrix<double, 3, 12, Eigen::DontAlign>, 2> point;
};

/// Derivatives at the answer `d` of `distance(a, poseA, b, poseB)` (docs/theory.md, 6). Returns false and
/// does not change `result` if they do not exist: for an answer that is neither exact nor a regular local
/// one, or for cores that touch at a point without curvature.
bool hessian(const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b, const Eigen::Isometry3d& poseB,
             const Distance& d, DistanceHessian& result);

/// The same for an STP-BV and a simple shape, if `d` is `exact`. If the witness point is on a face of the
/// shape, the normal turns with the shape. If it is on an edge or a generator, the normal can also turn about
/// that line, and the distance is the maximum over these turns.
bool hessian(const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
             const Eigen::Isometry3d& poseShape, const Distance& d, DistanceHessian& result);
/// The same, the other way round.
bool hessian(const Shape& shape, const Eigen::Isometry3d& poseShape, const StpBv& volume,
             const Eigen::Isometry3d& poseVolume, const Distance& d, DistanceHessian& result);

/// The same for two simple shapes. The derivatives exist if one of the two features is a corner, a rim or a
/// round surface, or if both are edges or generators that cross.
bool hessian(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b, const Eigen::Isometry3d& poseB,
             const Distance& d, DistanceHessian& result);

/// How an answer changes while both bodies move. A controller needs this in every period; it takes a fraction
/// of the time of the matrices above.
struct DistanceRate {
  Eigen::Vector3d normal{0, 0, 0};  ///< velocity of the normal (1/s)
  /// Velocities of the witness points (m/s), world axes, including that they slide on their bodies.
  std::array<Eigen::Vector3d, 2> point{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
};

/// The velocities of both bodies, in the order of DistanceHessian: [linear; angular] of body 1 about its
/// origin, then of body 2 (m/s, rad/s); world axes.
using BodyTwists = Eigen::Matrix<double, 12, 1, Eigen::DontAlign>;

/// Velocities of normal and witness points at the answer `d`: `hessian().normal * twists` and `.point[i] *
/// twists`. Returns false and does not change `result` if hessian() would.
bool rate(const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b, const Eigen::Isometry3d& poseB,
          const Distance& d, const BodyTwists& twists, DistanceRate& result);
/// The same for an STP-BV and a shape.
bool rate(const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
          const Eigen::Isometry3d& poseShape, const Distance& d, const BodyTwists& twists,
          DistanceRate& result);
/// The same, the other way round.
bool rate(const Shape& shape, const Eigen::Isometry3d& poseShape, const StpBv& volume,
          const Eigen::Isometry3d& poseVolume, const Distance& d, const BodyTwists& twists,
          DistanceRate& result);

/// The same for two shapes.
bool rate(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b, const Eigen::Isometry3d& poseB,
          const Distance& d, const BodyTwists& twists, DistanceRate& result);

}  // namespace fcl_stpbv
