// Fills FCL's hierarchy of oriented boxes and swept spheres.
#include "fcl_stpbv/robot/triangle_tree.h"

#include <fcl/geometry/bvh/BVH_model.h>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

std::shared_ptr<const fcl::CollisionGeometryd> triangleTree(
    const std::vector<Eigen::Vector3d>& vertices, const std::vector<std::array<int, 3>>& triangles) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> corners;
  for (const auto& t : triangles) corners.emplace_back(at(t[0]), at(t[1]), at(t[2]));
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(vertices.size()));
  model->addSubModel(vertices, corners);
  model->endModel();
  model->computeLocalAABB();
  return model;
}

}  // namespace fcl_stpbv::detail
