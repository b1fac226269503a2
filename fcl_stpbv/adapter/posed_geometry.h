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
  /// Height of the supporting plane with the world's unit normal `n` above the body's origin (m). An STP-BV
  /// looks for its patch from `hint` on.
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
  /// The same as support() along a unit vector `m` of the body's own frame.
  double localSupport(const Eigen::Vector3d& m, int hint = -1) const {
    return volume ? volume->support(m, hint) : m.dot(shape.support(m)) + shape.margin;
  }
  /// Bound on how far the support function is off, beyond its rounding (m).
  double supportError() const { return volume ? volume->tables().supportError : 0.0; }
  /// Bound on its coordinates, for rounding (m).
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

/// Signed distance of two bodies; the cache serves pairs with an STP-BV, and keeps the normal of any.
Distance distance(const ConvexBody& a, const ConvexBody& b, PairCache* cache = nullptr);

/// Whether two bodies are certainly farther apart than `x` (m): first by isFartherByBounds(), then by a
/// search. Poses must be rigid; with an STP-BV they need not be, and the result is then false.
bool isFartherThan(double x, const ConvexBody& a, const ConvexBody& b, PairCache* cache,
                   ProximityCounts* counts = nullptr);
/// The cheap part of the test: the supporting planes along the cache's normal, since the gap along any normal
/// is a lower bound (docs/theory.md, 5), and the balls around STP-BVs, because their boxes were not compared.
bool isFartherByBounds(double x, const ConvexBody& a, const ConvexBody& b, const PairCache& cache);

/// Two convex bodies at their poses, which need no boxes around them: with an STP-BV at any poses, else
/// valid ones, one of them bounded, at poses that are made rigid. False for any other two.
bool areBodies(const fcl::CollisionGeometryd& geometry1, const Eigen::Isometry3d& pose1,
               const fcl::CollisionGeometryd& geometry2, const Eigen::Isometry3d& pose2, ConvexBody& a,
               ConvexBody& b);

/// One geometry at a pose: a body, or the elements of a mesh or a tree below their boxes. A view; the
/// geometry must outlive it.
class PosedGeometry {
 public:
  /// A box in the frame of the pair's first geometry, and what is in it.
  struct Part {
    OrientedBox box;
    bool leaf;
    ElementTree::Node node;            ///< for a body: its id is -1, its box in the body's own frame
    const ConvexBody* body = nullptr;  ///< null where only the box is known
    double coordinates = 0;            ///< all that make up the two boxes, summed, for rounding (m)

    /// How far it reaches along a unit vector of the box's frame, from the box's centre (m).
    double reach(const Eigen::Vector3d& n) const {
      if (!body) return box.reach(n);
      const Eigen::Vector3d m = box.axes.transpose() * n;
      return body->localSupport(m) - m.dot(node.box.centre);
    }
  };

  /// `inFrame`: the pose seen from the pair's first geometry. Poses are rigid. `known`: to be sound
  /// (isSound()), but for what the `tree` has found, where there is one.
  PosedGeometry(const fcl::CollisionGeometryd& geometry, const Eigen::Isometry3d& pose,
                const Eigen::Isometry3d& inFrame, bool known = false, const ElementTree* tree = nullptr);

  /// Whether it is a valid body, or a mesh or a tree with anything in it.
  bool known() const { return isBody() || tree_.any(); }
  /// Whether all corners of a mesh are numbers. Looks at each of them.
  bool finite() const { return isBody() || tree_.finite(); }
  /// Whether FCL has merged its inner boxes (ElementTree::merged()).
  bool merged() const { return tree_.merged(); }
  /// Whether only leaves tell where the elements are (ElementTree::loose()).
  bool loose() const { return tree_.loose(); }
  /// Its elements, of which there may be none.
  const ElementTree& tree() const { return tree_; }
  /// Its axes in the frame of the pair's first geometry.
  Eigen::Matrix3d axes() const { return inFrame_.linear(); }
  bool isBody() const { return body_.volume || isShape_; }
  bool unbounded() const { return isShape_ && body_.shape.unbounded(); }
  /// The body. Only where it is one.
  const ConvexBody& body() const { return body_; }

  /// How far a mesh reaches along `n` (frame of the pair's first geometry, m): looks at each corner.
  double reach(const Eigen::Vector3d& n) const {
    return n.dot(inFrame_.translation()) + tree_.reach(inFrame_.linear().transpose() * n);
  }

  Part whole() const;
  /// At most eight; how many.
  std::size_t children(const Part& of, std::array<Part, 8>& child) const;
  /// What a leaf is. False for a cell that is free.
  bool body(const Part& leaf, ConvexBody& body) const;

 private:
  Part part(const ElementTree::Node& node, const ConvexBody* body = nullptr) const;

  ElementTree tree_;
  Eigen::Isometry3d inFrame_;
  bool unmoved_;  // its frame is the pair's
  ConvexBody body_;
  bool isShape_ = false;
};

/// Two geometries whose poses were made rigid.
struct PosedPair {
  /// `known` and `trees`: as PosedGeometry's, of both geometries.
  PosedPair(const fcl::CollisionGeometryd& geometry1, Eigen::Isometry3d pose1,
            const fcl::CollisionGeometryd& geometry2, Eigen::Isometry3d pose2, bool known,
            const KnownTrees& trees = {});

  /// Whether all corners of meshes are numbers. Without it nothing is known about the pair.
  bool finite() const { return first.finite() && second.finite(); }
  /// Whether neither is a body: surfaces, which have no depth, and so no distance below 0.
  bool areSurfaces() const { return !first.isBody() && !second.isBody(); }
  /// The cache's normal, unit, in the frame of the first geometry; zero where it has none.
  Eigen::Vector3d known(const PairCache& cache) const { return toWorld.transpose() * cache.direction(); }

  bool valid;  ///< both poses rigid, both geometries known, one of them bounded
  PosedGeometry first, second;
  Eigen::Matrix3d toWorld;  ///< the first geometry's axes
  /// Beside a tree: a bounded body's box along the axes that all the tree's cells have.
  std::optional<OrientedBox> besideTree;
};

/// Lower bound on the distance of two parts (m): the widest gap along `n` (unit or zero, frame of the first
/// geometry), the line of their centres and the axes of their boxes; stops at the first gap above `enough`.
/// For a half space or a plane, the gap along its normal.
double gapOf(const PosedPair& pair, const PosedGeometry::Part& a, const PosedGeometry::Part& b, double enough,
             const Eigen::Vector3d& n = {0, 0, 0});

/// What a gap between two parts may be off by rounding, and by their support functions (m).
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
