// A lower bound on how long a moving mesh or octree stays apart from another geometry. It examines the
// elements that are near enough, each with its own separating plane.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "fcl_stpbv/adapter/moving_bodies.h"
#include "fcl_stpbv/adapter/posed_geometry.h"

namespace fcl_stpbv::detail {

/// Two moving geometries at one time. An unbounded geometry must not rotate.
struct MovingNow {
  const PosedPair& pair;
  Eigen::Isometry3d pose;  ///< pose of the first geometry
  Eigen::Vector3d normal;  ///< unit normal of the present distance, from the first geometry to the second
  std::array<Eigen::Vector3d, 2> point;  ///< witness points of the present distance
  Eigen::Vector3d about;  ///< a point between the witness points, to which the velocities refer
  std::array<BodyVelocity, 2> velocity;
  /// Upper bound on the speed at which any two points of the geometries approach now (m per unit of time).
  double speed;
  double acceleration;  ///< upper bound on the growth of that speed per unit of time
  double margin;
  double slack;  ///< allowance for rounding in a gap (m)
};

/// The time, up to `most`, for which planes between their elements keep the geometries apart. At least
/// `known`, a time that is already known to hold for any two elements.
Cover elementCover(const MovingNow& now, double most, const Cover& known);

}  // namespace fcl_stpbv::detail
