// A common view of FCL's hierarchies: bounding volume trees of meshes, with any type of bounding volume, and
// octrees.
// 1. A node's box becomes an oriented box that also covers the rounding of FCL's fitting.
// 2. Inner boxes that FCL has merged from their children may miss elements. They are replaced by axis-aligned
//    boxes, fitted from the leaves up.
// 3. Children and elements (triangle, point, cell) are read from FCL's own nodes.
#include "fcl_stpbv/adapter/element_tree.h"

#include <fcl/config.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif

#include <algorithm>
#include <cstring>
#include <limits>

#include "fcl_stpbv/adapter/mesh_boxes.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/convex/vertex_set.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/packed.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Node = ElementTree::Node;

/// Rounding in FCL's fitting of a bounding volume may leave a triangle's corner outside by this share of its
/// size.
constexpr double kFit = 1e-9;

/// Whether there is anything in it, and its boxes belong to its vertices: not between FCL's begin and end.
template <typename BV>
bool isBuilt(const fcl::BVHModel<BV>& mesh) {
  const fcl::BVHBuildState state = mesh.build_state;
  return mesh.getNumBVs() > 0 && mesh.vertices &&
         (state == fcl::BVH_BUILD_STATE_PROCESSED || state == fcl::BVH_BUILD_STATE_UPDATED);
}

template <typename BV>
Node meshNode(const fcl::BVHModel<BV>& mesh, int index, const std::vector<Eigen::AlignedBox3d>* fitted) {
  const fcl::BVNode<BV>& node = mesh.getBV(index);
  OrientedBox box;
  if (!fitted) {
    box = boxAround(node.bv);
  } else {
    const Eigen::AlignedBox3d& own = (*fitted)[at(index)];
    box = {own.center(), Matrix3d::Identity(), 0.5 * own.sizes()};
  }
  box.half.array() += kFit * (box.half.sum() + box.centre.lpNorm<1>());
  return {node.isLeaf() ? node.primitiveId() : index, node.isLeaf(), nullptr, box};
}

/// Calls `action` with the geometry as the BVHModel that it is. Returns `otherwise` if it is none.
template <typename Action, typename Result>
Result withMesh(const fcl::CollisionGeometryd& g, const Action& action, Result otherwise) {
  switch (g.getNodeType()) {
    case fcl::BV_AABB:
      return action(static_cast<const fcl::BVHModel<fcl::AABBd>&>(g));
    case fcl::BV_OBB:
      return action(static_cast<const fcl::BVHModel<fcl::OBBd>&>(g));
    case fcl::BV_RSS:
      return action(static_cast<const fcl::BVHModel<fcl::RSSd>&>(g));
    case fcl::BV_kIOS:
      return action(static_cast<const fcl::BVHModel<fcl::kIOSd>&>(g));
    case fcl::BV_OBBRSS:
      return action(static_cast<const fcl::BVHModel<fcl::OBBRSSd>&>(g));
    case fcl::BV_KDOP16:
      return action(static_cast<const fcl::BVHModel<fcl::KDOP<double, 16>>&>(g));
    case fcl::BV_KDOP18:
      return action(static_cast<const fcl::BVHModel<fcl::KDOP<double, 18>>&>(g));
    case fcl::BV_KDOP24:
      return action(static_cast<const fcl::BVHModel<fcl::KDOP<double, 24>>&>(g));
    default:
      return otherwise;
  }
}

template <typename Mesh>
Shape meshElement(const Mesh& mesh, std::intptr_t id) {
  if (isCloud(mesh)) {
    const Vector3d p = mesh.vertices[id];
    return Shape::triangleOf(p, p, p);
  }
  const fcl::Triangle& t = mesh.tri_indices[id];
  return Shape::triangleOf(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
}

#if FCL_HAVE_OCTOMAP
using Cell = fcl::OcTreed::OcTreeNode;

const fcl::OcTreed* asOcTree(const fcl::CollisionGeometryd& g) {
  return g.getNodeType() == fcl::GEOM_OCTREE ? static_cast<const fcl::OcTreed*>(&g) : nullptr;
}

Node treeNode(const fcl::OcTreed& tree, const Cell* cell, bool leaf, const fcl::AABBd& box) {
  return {cell - tree.getRoot(), leaf, cell, boxAround(box)};
}

/// Free cells are left out. The mark of an inner cell may be older than the marks of the cells below it.
int treeChildren(const fcl::OcTreed& tree, const Node& node, std::array<Node, 8>& child) {
  const Cell* cell = static_cast<const Cell*>(node.handle);
  const fcl::AABBd box(node.box.centre - node.box.half, node.box.centre + node.box.half);
  int count = 0;
  for (unsigned i = 0; i < 8; ++i) {
    if (!tree.nodeChildExists(cell, i)) continue;
    const Cell* below = tree.getNodeChild(cell, i);
    const bool leaf = !tree.nodeHasChildren(below);
    if (leaf && !tree.isNodeOccupied(below)) continue;
    fcl::AABBd part;
    fcl::computeChildBV(box, i, part);
    child[at(count++)] = treeNode(tree, below, leaf, part);
  }
  return count;
}
#endif

/// Whether all vertices are finite and below 1e150 m. Each coordinate is scaled so that a larger one
/// overflows to infinity. Zero times infinity or NaN is NaN, and so is every sum with it.
FCL_STPBV_VECTORIZED
bool areNumbers(const Vector3d* corner, int count) {
  constexpr double kToEnd = std::numeric_limits<double>::max() / kFarthest;
  const auto load = [](const Vector3d* from, int part) {
    Packed four;
    std::memcpy(&four, from->data() + 4 * part, sizeof four);
    return four;
  };
  Packed x{}, y{}, z{};  // four corners fill three registers
  int i = 0;
  for (; i + 4 <= count; i += 4) {
    x += 0.0 * (kToEnd * load(corner + i, 0));
    y += 0.0 * (kToEnd * load(corner + i, 1));
    z += 0.0 * (kToEnd * load(corner + i, 2));
  }
  Vector3d rest(0, 0, 0);
  for (; i < count; ++i) rest += 0.0 * (kToEnd * corner[i]);
  const Packed all = x + y + z;
  return all[0] + all[1] + all[2] + all[3] + rest.sum() == 0.0;
}

}  // namespace

bool isSound(const fcl::CollisionGeometryd& geometry) {
  const bool merged = withMesh(
      geometry, [](const auto& mesh) { return isBuilt(mesh) && hasMergedBoxes(mesh); }, false);
  return !merged && ElementTree(geometry, /*known=*/true).finite();
}

ElementTree::ElementTree(const fcl::CollisionGeometryd& geometry, bool known) : geometry_(geometry) {
  using Boxes = std::vector<Eigen::AlignedBox3d>;
  any_ = withMesh(
      geometry, [](const auto& mesh) { return isBuilt(mesh); }, false);
  if (any_ && !known)
    fitted_ = withMesh(
        geometry,
        [](const auto& mesh) {
          return hasMergedBoxes(mesh) ? std::make_shared<const Boxes>(fittedBoxes(mesh)) : nullptr;
        },
        std::shared_ptr<const Boxes>());
#if FCL_HAVE_OCTOMAP
  if (const fcl::OcTreed* tree = asOcTree(geometry)) any_ = tree->getRoot() != nullptr;
#endif
}

bool ElementTree::finite() const {
  return withMesh(
      geometry_, [](const auto& mesh) { return areNumbers(mesh.vertices, mesh.num_vertices); }, true);
}

int ElementTree::corners() const {
  return withMesh(
      geometry_, [](const auto& mesh) { return mesh.num_vertices; }, 0);
}

double ElementTree::reach(const Vector3d& n) const {
  return withMesh(
      geometry_,
      [&](const auto& mesh) {
        return n.dot(mesh.vertices[furthestAlong(n, mesh.vertices, mesh.num_vertices)]);
      },
      kInfinity);
}

Node ElementTree::root() const {
#if FCL_HAVE_OCTOMAP
  if (const fcl::OcTreed* tree = asOcTree(geometry_))
    return treeNode(*tree, tree->getRoot(), !tree->nodeHasChildren(tree->getRoot()), tree->getRootBV());
#endif
  const Node none{-1, true, nullptr, {Vector3d::Zero(), Matrix3d::Zero(), Vector3d::Zero()}};
  return withMesh(
      geometry_, [this](const auto& mesh) { return meshNode(mesh, 0, fitted_.get()); }, none);
}

int ElementTree::children(const Node& node, std::array<Node, 8>& child) const {
#if FCL_HAVE_OCTOMAP
  if (const fcl::OcTreed* tree = asOcTree(geometry_)) return treeChildren(*tree, node, child);
#endif
  return withMesh(
      geometry_,
      [&](const auto& mesh) {
        const auto& inner = mesh.getBV(static_cast<int>(node.id));
        child[0] = meshNode(mesh, inner.leftChild(), fitted_.get());
        child[1] = meshNode(mesh, inner.rightChild(), fitted_.get());
        return 2;
      },
      0);
}

bool ElementTree::occupied(const Node& node) const {
  Shape shape;
  Vector3d place;
  if (node.leaf) return element(node, shape, place);
  std::array<Node, 8> child;
  const auto end = child.begin() + children(node, child);
  return std::any_of(child.begin(), end, [this](const Node& next) { return occupied(next); });
}

bool ElementTree::element(const Node& leaf, Shape& shape, Vector3d& place) const {
#if FCL_HAVE_OCTOMAP
  if (const fcl::OcTreed* tree = asOcTree(geometry_)) {
    if (!tree->isNodeOccupied(static_cast<const Cell*>(leaf.handle))) return false;
    shape = Shape::boxOf(2.0 * leaf.box.half);
    place = leaf.box.centre;
    return true;
  }
#endif
  place.setZero();
  shape = withMesh(
      geometry_, [&](const auto& mesh) { return meshElement(mesh, leaf.id); }, Shape{});
  return true;
}

bool ElementTree::find(std::intptr_t id, const Vector3d& x, double off, Shape& shape, Vector3d& place) const {
  if (!any()) return false;
  Node node = root();
  if (!node.handle) {  // a mesh: any id within bounds
    const bool within = withMesh(
        geometry_,
        [&](const auto& mesh) { return id >= 0 && id < (isCloud(mesh) ? mesh.num_vertices : mesh.num_tris); },
        false);
    return within && element({id, true, nullptr, node.box}, shape, place);
  }
  // Descends an octree to the cells that contain `x` up to rounding. A point between cells may lie in
  // several.
  constexpr int kPending = 8 * 17;  // octomap is sixteen levels deep
  std::array<Node, kPending> pending;
  int count = 0;
  pending[at(count++)] = node;
  while (count > 0) {
    node = pending[at(--count)];
    const double slack = off + 1e-9 * (node.box.half.norm() + node.box.centre.norm());
    if (((x - node.box.centre).cwiseAbs() - node.box.half).maxCoeff() > slack) continue;
    if (node.leaf) {
      if (node.id == id) return element(node, shape, place);
      continue;
    }
    std::array<Node, 8> child;
    const int children = this->children(node, child);
    for (int i = 0; i < children && count < kPending; ++i) pending[at(count++)] = child[at(i)];
  }
  return false;
}

}  // namespace fcl_stpbv::detail
