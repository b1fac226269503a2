#include "fcl_stpbv/adapter/octree_traversal.h"

#include <fcl/config.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif

#include <algorithm>
#include <array>
#include <utility>

namespace fcl_stpbv {

#if FCL_HAVE_OCTOMAP
namespace {

using Node = fcl::OcTreed::OcTreeNode;

double boundOf(const fcl::AABBd& cell, const NearestElement& search) {
  return search.lowerBound(
      {0.5 * (cell.min_ + cell.max_), Eigen::Matrix3d::Identity(), 0.5 * (cell.max_ - cell.min_)});
}

void visit(const fcl::OcTreed& tree, const Node* node, const fcl::AABBd& cell, double bound,
           NearestElement& search) {
  if (!search.mayImprove(bound)) return;
  if (!tree.nodeHasChildren(node)) {
    if (!tree.isNodeOccupied(node)) return;
    Eigen::Isometry3d at = search.pose();
    at.translation() = search.pose() * Eigen::Vector3d(0.5 * (cell.min_ + cell.max_));
    search.offer(Shape::boxOf(cell.max_ - cell.min_), at, node - tree.getRoot());
    return;
  }
  std::array<std::pair<double, unsigned>, 8> order;
  std::size_t count = 0;
  for (unsigned i = 0; i < 8; ++i) {
    if (!tree.nodeChildExists(node, i)) continue;
    fcl::AABBd child;
    fcl::computeChildBV(cell, i, child);
    order[count++] = {boundOf(child, search), i};
  }
  for (std::size_t k = 1; k < count; ++k)  // near cells first
    for (std::size_t j = k; j > 0 && order[j] < order[j - 1]; --j) std::swap(order[j], order[j - 1]);
  for (std::size_t k = 0; k < count; ++k) {
    fcl::AABBd child;
    fcl::computeChildBV(cell, order[k].second, child);
    visit(tree, tree.getNodeChild(node, order[k].second), child,
          std::max(order[k].first, boundOf(child, search)), search);
  }
}

}  // namespace

bool searchOcTree(const fcl::CollisionGeometryd& geometry, NearestElement& search) {
  if (geometry.getNodeType() != fcl::GEOM_OCTREE) return false;
  const auto& tree = static_cast<const fcl::OcTreed&>(geometry);
  if (tree.getRoot())
    visit(tree, tree.getRoot(), tree.getRootBV(), boundOf(tree.getRootBV(), search), search);
  return true;
}
#else
bool searchOcTree(const fcl::CollisionGeometryd&, NearestElement&) { return false; }
#endif

}  // namespace fcl_stpbv
