// The ball hull of a cloud by quickhull: fast where the cloud is far from
// degenerate, and it says where it is not.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/volume/ball_faces.h"

namespace fcl_stpbv::detail {

struct QuickFaces {
  std::vector<Ring> faces;
  bool mayJoin = false;  ///< some neighbours may lie on one ball to rounding (join_faces.h)
  long asked = 0;        ///< how many times the side of a point was asked: the work done
};

/// Triangles of the ball hull, each from its smallest index on, ascending. Empty where the cloud
/// needs the rolling ball (rolling_ball.h): where it is flat, so small for the ball that two vertices are
/// joined by two edges, or has vertices closer together than rounding.
///
/// What comes back is closed, and each triangle's ball holds the corners of its three neighbours, exactly.
/// That proves the hull of its own vertices where the regions of normals also tile the sphere; that no other
/// point is outside is for the caller to check (surface_check.h).
QuickFaces quickhull(const std::vector<Eigen::Vector3d>& points, double radius);

}  // namespace fcl_stpbv::detail
