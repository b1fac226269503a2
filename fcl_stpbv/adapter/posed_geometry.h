// A view of any FCL geometry as a hierarchy of boxes with convex bodies as leaves, and the descent through
// two such hierarchies. Distances of meshes, contacts and threshold tests all use it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/volume/query_tables.h"

namespace fcl_stpbv {
struct ProximityCounts;
}

namespace fcl_stpbv::detail {

/// A single convex body: an STP-BV or a shape, placed in the world.
struct ConvexBody {
  const StpBv* volume = nullptr;
  Shape shape;
  Eigen::Isometry3d pose;
  double rounding = 0;  ///< rounding error of its position (m), for a cell of an octree at a pose

  bool unbounded() const { return !volume && shape.unbounded(); }
  /// Height of the supporting plane with the world's unit normal `n` above the body's origin (m). For an
  /// STP-BV the search for the patch starts at `hint`.
  double support(const Eigen::Vector3d& n, int hint = -1) const {
    return localSupport(pose.linear().transpose() * n, hint);
  }
  /// Largest d.(x - about) over the body, for `d` of any length (world, m). For an unbounded body only its
  /// own normal is allowed as `d`; its plane goes through `point`.
  double reach(const Eigen::Vector3d& d, const Eigen::Vector3d& about, const Eigen::Vector3d& point,
               int hint = -1) const {
    if (unbounded()) return d.dot(point - about);
    const double length = d.norm();
    return length * support(d / length, hint) + d.dot(pose.translation() - about);
  }
  /// support() along a unit vector `m` of the body's own frame.
  double localSupport(const Eigen::Vector3d& m, int hint = -1) const {
    return volume ? volume->support(m, hint) : m.dot(shape.support(m)) + shape.margin;
  }
  /// Bound on the error of the support function, beyond its rounding (m).
  double supportError() const { return volume ? volume->tables().supportError : 0.0; }
  /// Bound on the body's coordinates (m). Bounds on rounding errors use it.
  double extent() const {
    return volume ? volume->extent() : shape.centre.lpNorm<1>() + shape.reach + shape.margin;
  }
};

/// Whether a geometry can have contacts: false if FCL marks it as free or unknown. FCL's dynamic AABB trees
/// may pass unknown cells of an octree as boxes with such marks. For an octree itself each cell has its own
/// mark.
bool isOccupied(const fcl::CollisionGeometryd& geometry);

/// Whether the geometry is one valid convex body, and if so that body, without a pose.
bool isConvex(const fcl::CollisionGeometryd& geometry, ConvexBody& body);

/// Signed distance of two bodies. The cache is used for pairs with an STP-BV. For other pairs it receives the
/// normal.
Distance distance(const ConvexBody& a, const ConvexBody& b, PairCache* cache = nullptr);

/// Whether two bodies are certainly farther apart than `x` (m): first by isFartherByBounds(), then by a
/// search. Poses must be rigid; with an STP-BV they need not be, and the result is then false.
bool isFartherThan(double x, const ConvexBody& a, const ConvexBody& b, PairCache* cache,
                   ProximityCounts* counts = nullptr);
/// The cheap part of isFartherThan(). It uses the supporting planes along the cache's normal, because the gap
/// along any normal is a lower bound (docs/theory.md, 5). It also uses the balls around STP-BVs, because
/// their boxes were not compared.
bool isFartherByBounds(double x, const ConvexBody& a, const ConvexBody& b, const PairCache& cache);

/// Whether both geometries are convex bodies that need no boxes around them. If so, `a` and `b` are these
/// bodies at their poses. A pair with an STP-BV may have any poses. Otherwise both shapes must be valid and
/// one of them bounded, and their poses are made rigid.
bool areBodies(const fcl::CollisionGeometryd& geometry1, const Eigen::Isometry3d& pose1,
               const fcl::CollisionGeometryd& geometry2, const Eigen::Isometry3d& pose2, ConvexBody& a,
               ConvexBody& b);

/// One geometry at a pose: a body, or the elements of a mesh or a tree below their boxes. It is a view; the
/// geometry must outlive it.
class PosedGeometry {
 public:
  /// A box in the frame of the pair's first geometry, and what is in it.
  struct Part {
    OrientedBox box;
    bool leaf;
    /// For a body: its id is -1, its box in the body's own frame.
    ElementTree::Node node;
    /// Null if only the box is known.
    const ConvexBody* body = nullptr;
    /// Sum of the coordinates and half sides of both boxes, for bounds on rounding (m)
    double coordinates = 0;

    /// How far the part reaches along a unit vector of the box's frame, from the box's centre (m).
    double reach(const Eigen::Vector3d& n) const {
      if (!body) return box.reach(n);
      const Eigen::Vector3d m = box.axes.transpose() * n;
      return body->localSupport(m) - m.dot(node.box.centre);
    }
  };

  /// `inFrame`: the pose seen from the pair's first geometry. Poses are rigid. `known`: the geometry is known
  /// to be sound (isSound()). If there is a `tree`, it is copied, and `known` has no effect.
  PosedGeometry(const fcl::CollisionGeometryd& geometry, const Eigen::Isometry3d& pose,
                const Eigen::Isometry3d& inFrame, bool known = false, const ElementTree* tree = nullptr);

  /// Whether the geometry is a valid body, or a mesh or a tree with anything in it.
  bool known() const { return isBody() || tree_.any(); }
  /// Whether all corners of a mesh are numbers. Looks at each corner.
  bool finite() const { return isBody() || tree_.finite(); }
  /// Whether FCL has merged the geometry's inner boxes (ElementTree::merged()).
  bool merged() const { return tree_.merged(); }
  /// Whether only the leaves' boxes bound the elements tightly (ElementTree::loose()).
  bool loose() const { return tree_.loose(); }
  /// The geometry's elements; there may be none.
  const ElementTree& tree() const { return tree_; }
  /// The geometry's axes in the frame of the pair's first geometry.
  Eigen::Matrix3d axes() const { return inFrame_.linear(); }
  bool isBody() const { return body_.volume || isShape_; }
  bool unbounded() const { return isShape_ && body_.shape.unbounded(); }
  /// The body. Only to be called if isBody().
  const ConvexBody& body() const { return body_; }

  /// How far a mesh reaches along `n` (frame of the pair's first geometry, m): looks at each corner.
  double reach(const Eigen::Vector3d& n) const {
    return n.dot(inFrame_.translation()) + tree_.reach(inFrame_.linear().transpose() * n);
  }

  Part whole() const;
  /// Fills `child` with the part's children. Returns their number, at most eight.
  std::size_t children(const Part& of, std::array<Part, 8>& child) const;
  /// The body of a leaf. False for a free cell.
  bool body(const Part& leaf, ConvexBody& body) const;

 private:
  Part part(const ElementTree::Node& node, const ConvexBody* body = nullptr) const;

  ElementTree tree_;
  Eigen::Isometry3d inFrame_;
  bool unmoved_;  // whether its frame is that of the pair
  ConvexBody body_;
  bool isShape_ = false;
};

/// Two geometries whose poses were made rigid.
struct PosedPair {
  /// `known` and `trees`: as for PosedGeometry, for both geometries.
  PosedPair(const fcl::CollisionGeometryd& geometry1, Eigen::Isometry3d pose1,
            const fcl::CollisionGeometryd& geometry2, Eigen::Isometry3d pose2, bool known,
            const KnownTrees& trees = {});

  /// Whether all corners of meshes are numbers. If not, nothing is known about the pair.
  bool finite() const { return first.finite() && second.finite(); }
  /// Whether neither geometry is a body. Such surfaces have no depth, so their distance is not below 0.
  bool areSurfaces() const { return !first.isBody() && !second.isBody(); }
  /// The cache's unit normal in the frame of the first geometry; zero if the cache has none.
  Eigen::Vector3d known(const PairCache& cache) const { return toWorld.transpose() * cache.direction(); }

  bool valid;  ///< both poses rigid, both geometries known, one of them bounded
  PosedGeometry first, second;
  Eigen::Matrix3d toWorld;  ///< the first geometry's axes
  /// If one geometry is a tree and the other a bounded body: the body's box along the axes of the tree's
  /// cells.
  std::optional<OrientedBox> besideTree;
};

/// Lower bound on the distance of two parts (m): the widest gap along `n` (unit or zero, frame of the first
/// geometry), the line of their centres and the axes of their boxes; stops at the first gap above `enough`.
/// For a half space or a plane, the gap along its normal.
double gapOf(const PosedPair& pair, const PosedGeometry::Part& a, const PosedGeometry::Part& b, double enough,
             const Eigen::Vector3d& n = {0, 0, 0});

/// Bound on the error of a gap between two parts, from rounding and from their support functions (m).
double boxRounding(const PosedGeometry::Part& a, const PosedGeometry::Part& b);

/// Descends through both hierarchies, the bigger part first and near children first. `visitor.bound(a, b)`
/// returns a lower bound on the distance of two parts. `visitor.skip(bound)` returns whether the pair can be
/// skipped; it is called again before the descent into the pair. `visitor.leaves(a, b)` handles two leaves,
/// and returns true to end the descent. @returns whether it ended so.
template <class Visitor>
bool descend(const PosedPair& pair, const PosedGeometry::Part& a, const PosedGeometry::Part& b,
             Visitor& visitor) {
  if (a.leaf && b.leaf) return visitor.leaves(a, b);
  const bool first = !a.leaf && (b.leaf || a.box.half.squaredNorm() >= b.box.half.squaredNorm());
  std::array<PosedGeometry::Part, 8> child;
  std::array<double, 8> gap;
  std::array<std::size_t, 8> order;
  const std::size_t count = first ? pair.first.children(a, child) : pair.second.children(b, child);
  for (std::size_t i = 0; i < count; ++i) {
    gap[i] = visitor.bound(first ? child[i] : a, first ? b : child[i]);
    order[i] = i;
    for (std::size_t j = i; j > 0 && gap[order[j]] < gap[order[j - 1]]; --j)
      std::swap(order[j], order[j - 1]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const PosedGeometry::Part& next = child[order[k]];
    if (!visitor.skip(gap[order[k]]) && descend(pair, first ? next : a, first ? b : next, visitor))
      return true;
  }
  return false;
}

}  // namespace fcl_stpbv::detail
