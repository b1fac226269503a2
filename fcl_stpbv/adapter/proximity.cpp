// Threshold test of two geometries: are they farther apart than x?
//
// 1. Compare the boxes around both geometries, or, for two convex bodies, the balls around them.
// 2. Descend through both hierarchies, near children first.
// 3. For two bodies, compute the gap along the cached normal, and compare the balls inside them.
// 4. Last, a search that stops as soon as its bounds decide.
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/threshold.h"

namespace fcl_stpbv {

namespace {

using namespace detail;
using Eigen::Vector3d;

/// Visitor of descend() that ends the walk at the first pair of elements within `x`.
class Within {
 public:
  Within(double x, const PosedPair& pair, const QueryContext& context) : x_(x), pair_(pair) {
    if (context.cache) cache_ = *context.cache;
    counts_ = context.proximity;
  }
  const PairCache& cache() const { return cache_; }

  double bound(const PosedGeometry::Part& a, const PosedGeometry::Part& b) {
    if (counts_) ++counts_->bounds;
    return gapOf(pair_, a, b, x_, pair_.known(cache_));
  }
  bool skip(double bound) const { return bound > x_; }

  bool leaves(const PosedGeometry::Part& leafA, const PosedGeometry::Part& leafB) {
    ConvexBody a, b;
    if (!pair_.first.body(leafA, a) || !pair_.second.body(leafB, b)) return false;  // a free cell
    return !isFartherThan(x_, a, b, &cache_, counts_);
  }

 private:
  double x_;
  const PosedPair& pair_;
  PairCache cache_;
  ProximityCounts* counts_ = nullptr;
};

/// Radius of a ball about a bounded shape's centre that lies in the shape. It is only the margin if a larger
/// radius takes longer to find.
double ballInside(const Shape& shape) {
  switch (shape.kind) {
    case ShapeKind::box:
    case ShapeKind::ellipsoid:
      return shape.size.minCoeff() + shape.margin;
    case ShapeKind::cylinder:
      return std::min(shape.radius, shape.half) + shape.margin;
    default:
      return shape.margin;
  }
}

/// Bounds on the distance of two bounded shapes without a search.
class ShapeBounds {
 public:
  ShapeBounds(const ConvexBody& a, const ConvexBody& b)
      : a_(a), b_(b), d_(b.pose.translation() - a.pose.translation()) {
    rounding_ = kGapRounding * (d_.lpNorm<1>() + a.extent() + b.extent());
    centres_ = (b.pose.linear() * b.shape.centre + d_ - a.pose.linear() * a.shape.centre).norm();
  }

  /// Whether the balls around the bodies, or the planes along the cache's normal, are farther apart than `x`.
  bool areFarther(double x, const PairCache& cache) const {
    const auto ballAround = [](const Shape& shape) { return shape.reach + shape.margin; };
    if (centres_ - ballAround(a_.shape) - ballAround(b_.shape) > x + rounding_) return true;
    const Vector3d n = cache.direction();
    return !n.isZero(0) && n.dot(d_) - a_.support(n) - b_.support(-n) > x + rounding_;
  }
  /// Whether the balls inside the bodies are no farther apart than `x`.
  bool areWithin(double x) const {
    return centres_ - ballInside(a_.shape) - ballInside(b_.shape) + rounding_ <= x;
  }

 private:
  const ConvexBody &a_, &b_;
  Vector3d d_;       // from a's origin to b's (m)
  double rounding_;  // rounding of a gap (m)
  double centres_;   // distance of the two centres (m)
};

/// isFartherThan() for a valid pair, by its elements.
bool areElementsFarther(double x, const PosedPair& pair, const QueryContext& context) {
  if (x < 0 && pair.areSurfaces()) return true;  // surfaces have no depth: their distance is at least 0
  Within within(x, pair, context);
  const PosedGeometry::Part a = pair.first.whole(), b = pair.second.whole();
  if (within.skip(within.bound(a, b))) return true;
  const bool farther = !descend(pair, a, b, within);
  if (context.cache) *context.cache = within.cache();
  return farther;
}

}  // namespace

namespace detail {

bool isFartherByBounds(double x, const ConvexBody& a, const ConvexBody& b, const PairCache& cache) {
  if (a.volume && b.volume) return isFartherByBounds(x, *a.volume, a.pose, *b.volume, b.pose, cache);
  if (a.volume) return isFartherByBounds(x, *a.volume, a.pose, b.shape, b.pose, cache);
  if (b.volume) return isFartherByBounds(x, *b.volume, b.pose, a.shape, a.pose, cache.mirrored());
  return !a.unbounded() && !b.unbounded() && ShapeBounds(a, b).areFarther(x, cache);
}

bool isFartherThan(double x, const ConvexBody& a, const ConvexBody& b, PairCache* cache,
                   ProximityCounts* counts) {
  x += a.rounding + b.rounding;
  if (counts) ++counts->bounds;
  const PairCache nothing;
  const PairCache& known = cache ? *cache : nothing;
  const bool areShapes = !a.volume && !b.volume;
  if (areShapes && !a.unbounded() && !b.unbounded()) {
    const ShapeBounds bounds(a, b);
    if (bounds.areFarther(x, known)) return true;
    if (bounds.areWithin(x)) return false;
  } else if (a.volume && b.volume  // the usual case, without a call between
                 ? isFartherByBounds(x, *a.volume, a.pose, *b.volume, b.pose, known)
                 : isFartherByBounds(x, a, b, known)) {
    return true;
  }
  if (counts) ++counts->solved;
  if (areShapes) return isFartherThan(x, a.shape, a.pose, b.shape, b.pose, cache);
  if (a.volume && b.volume) return isFartherThan(x, *a.volume, a.pose, *b.volume, b.pose, cache);
  if (a.volume) return isFartherThan(x, *a.volume, a.pose, b.shape, b.pose, cache);
  PairCache mirrored;
  if (cache) mirrored = cache->mirrored();
  const bool farther = isFartherThan(x, *b.volume, b.pose, a.shape, a.pose, cache ? &mirrored : nullptr);
  if (cache) *cache = mirrored.mirrored();
  return farther;
}

}  // namespace detail

bool isFartherThan(double x, const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                   const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                   const QueryContext& context) {
  if (std::isnan(x)) return false;  // no distance is known to be greater than NaN
  ConvexBody bodyA, bodyB;
  if (areBodies(geometry1, pose1, geometry2, pose2, bodyA, bodyB))
    return isFartherThan(x, bodyA, bodyB, context.cache, context.proximity);
  const PosedPair pair(geometry1, pose1, geometry2, pose2, context.finite);
  if (!pair.valid) return false;
  // The vertices are checked last: a pair that is within x needs no check.
  return areElementsFarther(x, pair, context) && (context.finite || pair.finite());
}

}  // namespace fcl_stpbv
