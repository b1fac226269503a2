// The ball hull of a cloud by quickhull. It is fast, but works only for clouds that are not degenerate; for
// other clouds it reports failure.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fcl_stpbv/volume/ball_faces.h"

namespace fcl_stpbv::detail {

struct QuickFaces {
  std::vector<Ring> faces;
  bool mayJoin = false;  ///< some neighbours may lie on one ball to rounding (join_faces.h)
  long asked = 0;        ///< number of point-side tests, a measure of the work
};

/// Triangles of the ball hull, sorted; each starts with its smallest index. Empty if the cloud needs the
/// rolling ball (rolling_ball.h) instead: if it is flat, if the ball is so small that two vertices are joined
/// by two edges, or if vertices are closer together than rounding.
///
/// The triangles form a closed surface, and each triangle's ball contains the corners of its three
/// neighbours, exactly. If the regions of normals also tile the sphere, this proves that they are the ball
/// hull of their own vertices. The caller must check that no other point is outside (surface_check.h).
QuickFaces quickhull(const std::vector<Eigen::Vector3d>& points, double radius);

}  // namespace fcl_stpbv::detail
