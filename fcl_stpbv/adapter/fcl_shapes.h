// Conversions between FCL's geometries and this library's shapes and hulls.
#pragma once

#include <fcl/geometry/collision_geometry.h>
#include <fcl/geometry/shape/convex.h>

#include <memory>
#include <vector>

#include "fcl_stpbv/convex/hull_graph.h"
#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// Fills `shape` from a Sphere, Capsule, Ellipsoid, Box, Cylinder, Cone, Convex, Halfspace, Plane or
/// TriangleP; false for any other type. A Convex lends its own vertices: nothing is copied or allocated, and
/// the geometry must outlive the shape.
bool shapeOf(const fcl::CollisionGeometryd& geometry, Shape& shape);

/// The hull's vertices for `fcl::Convexd`, with the coordinates that they have in `cloud` (m), which the hull
/// was made of: FCL must see the points unrounded.
std::shared_ptr<const std::vector<fcl::Vector3d>> fclVertices(const HullGraph& hull,
                                                              const std::vector<Eigen::Vector3d>& cloud);

/// The hull's faces in the format of `fcl::Convexd`: for each face the number of its vertices, then the
/// vertices, counter-clockwise seen from outside.
std::shared_ptr<const std::vector<int>> fclFaces(const HullGraph& hull);

/// The convex hull of a cloud (m), with flat faces. It is for pairs whose other body is smooth. May be
/// degenerate.
/// @throws Error for a cloud that is empty or not finite.
std::shared_ptr<fcl::Convexd> hullGeometry(const std::vector<Eigen::Vector3d>& cloud);

}  // namespace fcl_stpbv::detail
