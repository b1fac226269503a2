// Farther than a threshold?
//
// 1. Boxes around both geometries.
// 2. Down both hierarchies, near children first.
// 3. Of two bodies the gap along the remembered normal.
// 4. A search that ends as soon as its bounds tell.
#include "fcl_stpbv/adapter/proximity.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/distance/shape_distance.h"
#include "fcl_stpbv/distance/shape_pair.h"

namespace fcl_stpbv {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// A single body of a pair: an STP-BV or a shape, placed in the world.
struct Body {
  const StpBv* volume = nullptr;
  Shape shape;
  Isometry3d pose;

  /// Height of the supporting plane with the world's unit normal `n` above the body's origin (m).
  double support(const Vector3d& n) const {
    const Vector3d m = pose.linear().transpose() * n;
    return volume ? volume->support(m) : m.dot(shape.support(m)) + shape.margin;
  }
  /// Bound on its coordinates, for rounding (m).
  double extent() const {
    return volume ? volume->extent() : shape.centre.lpNorm<1>() + shape.reach + shape.margin;
  }
};

/// One geometry: a body, or the elements of a mesh or a tree.
class Side {
 public:
  /// A box with a ball swept over it, in the frame of the first geometry, and what is in it.
  struct Part {
    OrientedBox box;
    double margin;
    bool leaf;
    ElementTree::Node node;
  };

  Side(const fcl::CollisionGeometryd& geometry, const Isometry3d& pose, const Isometry3d& inFrame)
      : tree_(geometry), inFrame_(inFrame) {
    body_.pose = pose;
    if (const StpBvGeometry* g = asStpBv(&geometry))
      body_.volume = &g->volume();
    else
      isShape_ = shapeOf(geometry, body_.shape) && body_.shape.valid();
  }
  bool known() const { return body_.volume || isShape_ || tree_.any(); }
  bool unbounded() const { return isShape_ && body_.shape.unbounded(); }

  Part whole() const {
    if (!isBody()) return part(tree_.root());
    const Shape& s = body_.shape;
    const bool isBox = !body_.volume && s.kind == ShapeKind::box;
    const OrientedBox box{inFrame_ * (body_.volume ? body_.volume->centre() : s.centre), inFrame_.linear(),
                          isBox ? s.size : Vector3d(0, 0, 0)};
    const double margin = body_.volume ? body_.volume->enclosingRadius() : s.margin + (isBox ? 0.0 : s.reach);
    return {box, margin, true, {-1, true, nullptr, box}};
  }
  int children(const Part& of, std::array<Part, 8>& child) const {
    std::array<ElementTree::Node, 8> node;
    const int count = tree_.children(of.node, node);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) child[i] = part(node[i]);
    return count;
  }
  /// What a leaf is. False for a cell that is free.
  bool body(const Part& leaf, Body& body) const {
    body = body_;
    if (isBody()) return true;
    Vector3d place;
    if (!tree_.element(leaf.node, body.shape, place)) return false;
    body.pose.translation() = body_.pose * place;
    return true;
  }

 private:
  bool isBody() const { return body_.volume || isShape_; }
  Part part(const ElementTree::Node& node) const {
    return {
        {inFrame_ * node.box.centre, inFrame_.linear() * node.box.axes, node.box.half}, 0.0, node.leaf, node};
  }

  ElementTree tree_;
  Isometry3d inFrame_;
  Body body_;
  bool isShape_ = false;
};

/// No more than the distance of two boxes with balls swept over them: the widest gap along the line of their
/// centres and their axes (m).
double gapOf(const Side::Part& a, const Side::Part& b) {
  const Vector3d d = b.box.centre - a.box.centre;
  const double length = d.norm();
  if (!(length > 0.0)) return -std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  const auto along = [&](const Vector3d& n) {
    most = std::max(most, std::abs(n.dot(d)) - a.box.reach(n) - b.box.reach(n));
  };
  along(d / length);
  for (int i = 0; i < 3; ++i) {
    along(a.box.axes.col(i));
    along(b.box.axes.col(i));
  }
  constexpr double kRounding = 1e-14;
  return most - a.margin - b.margin - kRounding * (length + a.box.half.sum() + b.box.half.sum());
}

/// A walk down both hierarchies that ends with the first pair of elements within `x`.
class Walk {
 public:
  Walk(double x, const Side& a, const Side& b, const QueryContext& context) : x_(x), a_(a), b_(b) {
    if (context.cache) cache_ = *context.cache;
    if (context.proximity) counts_ = context.proximity;
  }
  const PairCache& cache() const { return cache_; }

  bool farther(const Side::Part& a, const Side::Part& b) {
    if (a.leaf && b.leaf) return leavesFarther(a, b);
    // Down the bigger one, near children first: one within `x` decides.
    const bool first = !a.leaf && (b.leaf || a.box.half.squaredNorm() >= b.box.half.squaredNorm());
    std::array<Side::Part, 8> child;
    std::array<double, 8> gap;
    std::array<std::size_t, 8> order;
    const auto count = static_cast<std::size_t>(first ? a_.children(a, child) : b_.children(b, child));
    for (std::size_t i = 0; i < count; ++i) {
      gap[i] = bound(first ? child[i] : a, first ? b : child[i]);
      order[i] = i;
      for (std::size_t j = i; j > 0 && gap[order[j]] < gap[order[j - 1]]; --j)
        std::swap(order[j], order[j - 1]);
    }
    for (std::size_t k = 0; k < count; ++k) {
      const Side::Part& next = child[order[k]];
      if (!(gap[order[k]] > x_) && !farther(first ? next : a, first ? b : next)) return false;
    }
    return true;
  }

  /// Of two parts: nothing is known without it for a half space or a plane, which no box holds.
  double bound(const Side::Part& a, const Side::Part& b) {
    if (counts_) ++counts_->bounds;
    return a_.unbounded() || b_.unbounded() ? -std::numeric_limits<double>::infinity() : gapOf(a, b);
  }

 private:
  bool leavesFarther(const Side::Part& leafA, const Side::Part& leafB) {
    Body a, b;
    if (!a_.body(leafA, a) || !b_.body(leafB, b)) return true;  // a free cell
    if (!a_.unbounded() && !b_.unbounded() && rememberedPlaneTells(a, b)) return true;
    if (counts_) ++counts_->solved;
    if (!a.volume && !b.volume) return fcl_stpbv::isFartherThan(x_, a.shape, a.pose, b.shape, b.pose);
    const Distance d = !b.volume   ? distance(*a.volume, a.pose, b.shape, b.pose, &cache_)
                       : !a.volume ? distance(a.shape, a.pose, *b.volume, b.pose, &cache_)
                                   : distance(*a.volume, a.pose, *b.volume, b.pose, &cache_);
    return d.status != DistanceStatus::invalid && d.lower > x_;
  }

  /// The gap along the remembered normal, a lower bound like that along any other (docs/theory.md, 5).
  bool rememberedPlaneTells(const Body& a, const Body& b) {
    const double length = cache_.normal.norm();
    if (!(length > 0.5 && length < 2.0)) return false;
    if (counts_) ++counts_->bounds;
    const Vector3d n = cache_.normal / length, d = b.pose.translation() - a.pose.translation();
    const double rounding = kGapRounding * (d.lpNorm<1>() + a.extent() + b.extent());
    return n.dot(d) - a.support(n) - b.support(-n) > x_ + rounding;
  }

  double x_;
  const Side &a_, &b_;
  PairCache cache_;
  ProximityCounts* counts_ = nullptr;
};

}  // namespace

bool isFartherThan(double x, const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& given1,
                   const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& given2,
                   const QueryContext& context) {
  Isometry3d pose1 = given1, pose2 = given2;
  if (!makeRigid(pose1) || !makeRigid(pose2)) return false;  // bounds take the transpose for the inverse
  Isometry3d between = Isometry3d::Identity();
  between.linear() = pose1.linear().transpose() * pose2.linear();
  between.translation() = pose1.linear().transpose() * (pose2.translation() - pose1.translation());
  const Side a(geometry1, pose1, Isometry3d::Identity()), b(geometry2, pose2, between);
  if (!a.known() || !b.known() || (a.unbounded() && b.unbounded())) return false;
  Walk walk(x, a, b, context);
  const Side::Part wholeA = a.whole(), wholeB = b.whole();
  if (walk.bound(wholeA, wholeB) > x) return true;
  const bool farther = walk.farther(wholeA, wholeB);
  if (context.cache) *context.cache = walk.cache();
  return farther;
}

Distance distance(const StpBvGeometry& geometry, const fcl::Transform3d& pose, const Eigen::Vector3d& point,
                  PairCache* cache) {
  return distance(geometry.volume(), pose, point, cache);
}

}  // namespace fcl_stpbv
