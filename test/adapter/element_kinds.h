// Meshes of every bounding volume, clouds, octrees and flat shapes as FCL's geometries, with their triangles
// in long double.
#pragma once

#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/triangle_p.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "test/reference/shapes.h"
#include "test/reference/triangles.h"

namespace fcl_stpbv::test {

struct ElementKind {
  std::string name;
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
  /// The triangles of each element at a pose, by FCL's number of the element; -1 for a shape.
  std::function<std::map<std::intptr_t, std::vector<TriangleL>>(const Eigen::Isometry3d&)> triangles;
  bool surface;  ///< whether it is a mesh or a tree
};

template <typename BV>
ElementKind meshKind(const std::string& name, int rings = 4) {
  auto mesh = std::make_shared<fcl::BVHModel<BV>>();
  fcl::generateBVHModel(*mesh, fcl::Ellipsoidd(0.2, 0.15, 0.25), fcl::Transform3d::Identity(),
                        static_cast<unsigned>(rings), static_cast<unsigned>(rings));
  return {name, mesh,
          [mesh](const Eigen::Isometry3d& pose) {
            std::map<std::intptr_t, std::vector<TriangleL>> all;
            for (int t = 0; t < mesh->num_tris; ++t) {
              const fcl::Triangle& i = mesh->tri_indices[t];
              all[t] = {placed(pose, mesh->vertices[i[0]], mesh->vertices[i[1]], mesh->vertices[i[2]])};
            }
            return all;
          },
          true};
}

#if FCL_HAVE_OCTOMAP
inline void collectCells(const fcl::OcTreed& tree, const fcl::OcTreed::OcTreeNode* node,
                         const fcl::AABBd& box, const Eigen::Isometry3d& pose,
                         std::map<std::intptr_t, std::vector<TriangleL>>& all) {
  if (tree.nodeHasChildren(node)) {
    for (unsigned i = 0; i < 8; ++i) {
      if (!tree.nodeChildExists(node, i)) continue;
      fcl::AABBd part;
      fcl::computeChildBV(box, i, part);
      collectCells(tree, tree.getNodeChild(node, i), part, pose, all);
    }
  } else if (tree.isNodeOccupied(node)) {
    Eigen::Isometry3d at = pose;
    at.translation() = pose * Eigen::Vector3d(box.center());
    all[node - tree.getRoot()] = boxTriangles(at, box.max_ - box.min_);
  }
}

inline ElementKind treeKind() {
  auto cells = std::make_shared<octomap::OcTree>(0.1);
  Random random(5);
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3f p = (0.2 * random.direction()).cast<float>();
    cells->updateNode(octomap::point3d(p.x(), p.y(), p.z()), i % 4 != 0);
  }
  const auto tree = std::make_shared<fcl::OcTreed>(cells);
  return {"octree", tree,
          [tree](const Eigen::Isometry3d& pose) {
            std::map<std::intptr_t, std::vector<TriangleL>> all;
            collectCells(*tree, tree->getRoot(), tree->getRootBV(), pose, all);
            return all;
          },
          true};
}
#endif

/// All kinds, about 0.4 m in size.
inline std::vector<ElementKind> elementKinds() {
  std::vector<ElementKind> all{meshKind<fcl::OBBRSSd>("OBBRSS"),
                               meshKind<fcl::RSSd>("RSS"),
                               meshKind<fcl::kIOSd>("kIOS"),
                               meshKind<fcl::AABBd>("AABB"),
                               meshKind<fcl::OBBd>("OBB"),
                               meshKind<fcl::KDOP<double, 16>>("KDOP16"),
                               meshKind<fcl::KDOP<double, 18>>("KDOP18"),
                               meshKind<fcl::KDOP<double, 24>>("KDOP24")};
#if FCL_HAVE_OCTOMAP
  all.push_back(treeKind());
#endif
  const Eigen::Vector3d sides(0.3, 0.2, 0.4);
  all.push_back({"box", std::make_shared<fcl::Boxd>(sides),
                 [sides](const Eigen::Isometry3d& pose) {
                   return std::map<std::intptr_t, std::vector<TriangleL>>{{-1, boxTriangles(pose, sides)}};
                 },
                 false});
  const Eigen::Vector3d a(0.2, 0, 0), b(-0.1, 0.2, 0), c(0, -0.2, 0.1);
  all.push_back({"triangle", std::make_shared<fcl::TrianglePd>(a, b, c),
                 [a, b, c](const Eigen::Isometry3d& pose) {
                   return std::map<std::intptr_t, std::vector<TriangleL>>{{-1, {placed(pose, a, b, c)}}};
                 },
                 false});
  return all;
}

}  // namespace fcl_stpbv::test
