// A mesh's triangles as a geometry for FCL.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

namespace fcl_stpbv::detail {

/// A bounding volume hierarchy of triangles (m).
std::shared_ptr<const fcl::CollisionGeometryd> triangleTree(const std::vector<Eigen::Vector3d>& vertices,
                                                            const std::vector<std::array<int, 3>>& triangles);

}  // namespace fcl_stpbv::detail
