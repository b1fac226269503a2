// Second derivatives of the distance, and how normal and witness points move, in closed form.
#pragma once

#include <Eigen/Core>
#include <array>

#include "fcl_stpbv/convex/shape.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv {

/// What a small motion of both bodies does to an answer, to the next order than its gradient. Columns are the
/// 12 components of both twists, [linear; angular] of body 1 about its origin, then of body 2; world axes.
/// The distance is piecewise C2: on a boundary between patches, or between a shape's faces, edges and
/// corners, these are the values of one side.
struct DistanceHessian {
  /// Along poses with origins `o + v t` and rotations `exp(w t) R`, the distance's second derivative is
  /// `twists^T matrix twists`; symmetric.
  Eigen::Matrix<double, 12, 12, Eigen::DontAlign> matrix;
  /// Times the twists: the velocity of the normal (1/s).
  Eigen::Matrix<double, 3, 12, Eigen::DontAlign> normal;
  /// Times the twists: the velocities of the witness points, which slide on their bodies (m/s).
  std::array<Eigen::Matrix<double, 3, 12, Eigen::DontAlign>, 2> point;
};

/// Derivatives at the answer `d` of `distance(a, poseA, b, poseB)` (docs/theory.md, 6). False, leaving
/// `result` alone, where they do not exist: an answer that is neither exact nor a regular local one, cores
/// that touch in a point of no curvature.
bool hessian(const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b, const Eigen::Isometry3d& poseB,
             const Distance& d, DistanceHessian& result);

/// The same for a simple shape, in either order, where `d` is `exact`. Next to a face the normal
/// turns with the shape alone; next to an edge or a generator it is free to turn about that, and the distance
/// is the maximum over those turns.
bool hessian(const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
             const Eigen::Isometry3d& poseShape, const Distance& d, DistanceHessian& result);
/// The same, the other way round.
bool hessian(const Shape& shape, const Eigen::Isometry3d& poseShape, const StpBv& volume,
             const Eigen::Isometry3d& poseVolume, const Distance& d, DistanceHessian& result);

/// The same for two simple shapes. Two of their features have derivatives where one of them is a corner, a
/// rim or round, and where they are edges or generators that cross.
bool hessian(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b, const Eigen::Isometry3d& poseB,
             const Distance& d, DistanceHessian& result);

/// How an answer moves while both bodies do: what a controller asks for at every tick, at a fraction of the
/// time of the matrices above.
struct DistanceRate {
  Eigen::Vector3d normal{0, 0, 0};  ///< velocity of the normal (1/s)
  /// Velocities of the witness points, which slide on their bodies (m/s).
  std::array<Eigen::Vector3d, 2> point{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
};

/// The velocities of both bodies, as DistanceHessian takes them: [linear; angular] of body 1 about its
/// origin, then of body 2; world axes.
using BodyTwists = Eigen::Matrix<double, 12, 1, Eigen::DontAlign>;

/// Velocities of normal and witness points at the answer `d`: `hessian().normal * twists` and `.point[i] *
/// twists`. False, leaving `result` alone, where hessian() is.
bool rate(const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b, const Eigen::Isometry3d& poseB,
          const Distance& d, const BodyTwists& twists, DistanceRate& result);
/// The same of an STP-BV and a shape.
bool rate(const StpBv& volume, const Eigen::Isometry3d& poseVolume, const Shape& shape,
          const Eigen::Isometry3d& poseShape, const Distance& d, const BodyTwists& twists,
          DistanceRate& result);
/// The same, the other way round.
bool rate(const Shape& shape, const Eigen::Isometry3d& poseShape, const StpBv& volume,
          const Eigen::Isometry3d& poseVolume, const Distance& d, const BodyTwists& twists,
          DistanceRate& result);

/// The same of two shapes.
bool rate(const Shape& a, const Eigen::Isometry3d& poseA, const Shape& b, const Eigen::Isometry3d& poseB,
          const Distance& d, const BodyTwists& twists, DistanceRate& result);

}  // namespace fcl_stpbv
