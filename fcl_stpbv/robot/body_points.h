// A body approximated by points with a ball around each. Their convex hull contains the body, so a proof that
// the hull is clear holds for the body.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace fcl_stpbv::detail {

struct BodyPoints {
  std::vector<Eigen::Vector3d> points;  ///< at least one (m)
  double radius = 0;                    ///< radius of the ball around each point (m)
  Eigen::Vector3d centre{0, 0, 0};      ///< centre of a sphere that contains the points
  double reach = 0;                     ///< radius of that sphere (m)
  double narrowest = 0;                 ///< least width over some directions, with the balls (m)
};

/// The points of a geometry in the frame that `pose` leads to: an STP-BV by its vertices and its largest
/// over-cover, a polyhedron by its vertices, a sphere and a capsule exactly, a cylinder and a cone by
/// polygons around their rims, an ellipsoid by its box. No value for meshes, trees and unbounded geometries.
std::optional<BodyPoints> bodyPoints(const fcl::CollisionGeometryd& geometry, const Eigen::Isometry3d& pose);

/// Upper bound on the penetration depth of two such bodies at any poses (m). Reason: along a unit vector n,
/// the gaps in the two directions add up to minus the sum of both widths. So one of them is at least minus
/// half of that sum.
double mostDepth(const BodyPoints& a, const BodyPoints& b);

}  // namespace fcl_stpbv::detail
