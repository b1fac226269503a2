// How long a moving mesh or tree certainly stays apart from another geometry: of all its elements those near
// enough to matter, each with a plane of its own between it and the other body.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "fcl_stpbv/adapter/moving_bodies.h"
#include "fcl_stpbv/adapter/posed_geometry.h"

namespace fcl_stpbv::detail {

/// Two geometries on their way, at one time. A geometry without bounds does not turn.
struct MovingNow {
  const PosedPair& pair;
  Eigen::Isometry3d pose;                ///< of the first one
  Eigen::Vector3d normal;                ///< of the distance now: unit, from the first to the second
  std::array<Eigen::Vector3d, 2> point;  ///< its witness points
  Eigen::Vector3d about;                 ///< between these: what the velocities are of
  std::array<BodyVelocity, 2> velocity;
  double speed;         ///< most at which any two of their points come nearer now (m)
  double acceleration;  ///< most by which that speed grows in a unit of time (m)
  double margin;
  double slack;  ///< for rounding, of a gap (m)
};

/// For how long, up to `most`, planes between their elements keep them apart: no shorter than `known`, which
/// any two of them are.
Cover elementCover(const MovingNow& now, double most, const Cover& known);

}  // namespace fcl_stpbv::detail
