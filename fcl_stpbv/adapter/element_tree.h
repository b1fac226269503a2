// Access to the triangles of a mesh, the points of a cloud or the cells of an octree, through FCL's own
// hierarchy.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "fcl_stpbv/convex/shape.h"

namespace fcl_stpbv::detail {

/// An oriented box in the frame of a mesh or an octree. Every FCL bounding volume is converted to one.
struct OrientedBox {
  Eigen::Vector3d centre;
  Eigen::Matrix3d axes;  ///< the box's directions, as columns
  Eigen::Vector3d half;  ///< half sides (m)

  /// Half the width of the box along a unit vector (m).
  double reach(const Eigen::Vector3d& n) const { return half.dot((axes.transpose() * n).cwiseAbs()); }
};

/// Bound on the rounding error of a point's coordinates after a pose was applied (m): three products and
/// their sum with the translation, and the same again for a pose that was made rigid. 0 for the origin, which
/// needs no rotation.
inline double placeRounding(const Eigen::Isometry3d& pose, const Eigen::Vector3d& place) {
  constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();
  return place.isZero(0) ? 0.0 : kRounding * (place.lpNorm<1>() + pose.translation().lpNorm<1>());
}

/// Whether a mesh needs no further checks: its vertices are finite, and its boxes are not merged
/// (ElementTree::finite() and merged()).
bool isSound(const fcl::CollisionGeometryd& geometry);

/// A view of a BVHModel of any bounding volume or of an OcTree; the geometry must outlive it. It allocates
/// only the boxes that replace merged ones; copies share these boxes.
class ElementTree {
 public:
  struct Node {
    /// Of a leaf: the element's number as in FCL's `b1`, `b2`; otherwise the inner node's number.
    std::intptr_t id;
    bool leaf;
    const void* handle;  ///< the node of an octree; null for a mesh
    OrientedBox box;     ///< contains everything below the node, in the geometry's frame
  };

  /// `known`: the caller knows that the geometry is sound (isSound()).
  explicit ElementTree(const fcl::CollisionGeometryd& geometry, bool known = false);

  /// Whether the geometry is a mesh or a tree with anything in it.
  bool any() const { return any_; }
  /// Whether all vertices are finite and below 1e150 m. FCL's boxes hide vertices that are not. Checks each
  /// vertex, even if no triangle uses it.
  bool finite() const;
  /// corners(): number of a mesh's corners, 0 for a tree. reach(): how far any corner reaches along `n`
  /// (geometry's frame, m); it looks at each corner. For a tree it is infinite.
  int corners() const;
  double reach(const Eigen::Vector3d& n) const;
  /// Whether FCL has merged the inner boxes from their children. All boxes were then replaced by new ones,
  /// fitted to the present vertices.
  bool merged() const { return fitted_ != nullptr; }
  /// Whether inner boxes bound the elements only loosely, as those of an octree, whose root box is kilometres
  /// wide.
  bool loose() const { return geometry_.getNodeType() == fcl::GEOM_OCTREE; }
  Node root() const;
  /// Whether there is an occupied element below the node: a tree's cells may all be free. Looks at cells
  /// until it finds one.
  bool occupied(const Node& node) const;
  /// Fills `child` with the node's children, without free cells. Returns their number, at most eight.
  int children(const Node& node, std::array<Node, 8>& child) const;
  /// The shape of a leaf, and its place in the geometry's frame. False for a free cell.
  bool element(const Node& leaf, Shape& shape, Eigen::Vector3d& place) const;
  /// Finds the element with this id that is within `off` (m) of `x` (geometry's frame).
  bool find(std::intptr_t id, const Eigen::Vector3d& x, double off, Shape& shape,
            Eigen::Vector3d& place) const;

 private:
  const fcl::CollisionGeometryd& geometry_;
  bool any_ = false;
  /// Boxes in place of merged ones, by FCL's index of the node.
  std::shared_ptr<const std::vector<Eigen::AlignedBox3d>> fitted_;
};

/// Trees of a pair's two geometries that the caller has made before; null: a query makes its own.
using KnownTrees = std::array<const ElementTree*, 2>;

}  // namespace fcl_stpbv::detail
