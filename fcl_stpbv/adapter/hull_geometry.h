// Converts a convex hull to FCL's types.
#pragma once

#include <fcl/geometry/shape/convex.h>

#include <memory>
#include <vector>

#include "fcl_stpbv/convex/hull_graph.h"

namespace fcl_stpbv::detail {

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
