// The nearest two elements and the runner-up, by branch and bound down both hierarchies, near parts first
// (Larsen, Gottschalk, Lin, Manocha 1999):
// 1. bound two parts from below by their gap along the normals of elements solved before, then by their boxes
//    and the body's support points (posed_geometry.h);
// 2. skip parts that cannot contain one of the nearest two pairs;
// 3. compute the distance of two elements exactly, and keep the two smallest.
// If the geometries are apart, one normal is usually enough for most bounds. If they overlap, each side of a
// body needs its own normal. If the search over two meshes takes many steps, all their vertices are compared
// with the planes of the nearest elements. This helps for parallel faces of many triangles: all of them are
// equally near, and FCL's boxes, which are larger, cannot prove that none is nearer.
#include "fcl_stpbv/adapter/nearest_pair.h"

#include <algorithm>
#include <array>
#include <limits>

#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;
using Part = PosedGeometry::Part;

/// Visitor of descend() that takes the first two elements on the way down to near boxes.
struct FirstElements {
  Part a, b;
  double bound(const Part& partA, const Part& partB) const {
    return (partB.box.centre - partA.box.centre).squaredNorm();
  }
  bool skip(double) const { return false; }
  bool leaves(const Part& leafA, const Part& leafB) {
    a = leafA, b = leafB;
    return true;
  }
};

class NearestElements {
 public:
  NearestElements(const PosedPair& pair, PairCache* cache)
      : pair_(pair), surfaces_(pair.areSurfaces()), cache_(cache) {
    constexpr long kLeast = 100, kPart = 16;  // one gap of two boxes takes as long as some twenty corners
    if (surfaces_) patience_ = kLeast + (pair.first.tree().corners() + pair.second.tree().corners()) / kPart;
  }

  const ElementsDistance& result() const { return result_; }

  /// any(): whether a nearest pair is known. first(): its element of the first geometry.
  bool any() const { return result_.found.status != DistanceStatus::invalid; }
  const Part& first() const { return first_; }
  /// After both hierarchies have been gone through: whether no element was found, because all cells are free.
  bool foundNothing() const { return !any() && !unknown_; }

  double bound(const Part& a, const Part& b) {
    if (surfaces_) {
      if (++result_.looks > patience_) tryAllCorners();
      return gapOf(pair_, a, b, any() ? result_.runnerUp : kInfinity, plane_[0].n);
    }
    const Vector3d d = b.box.centre - a.box.centre;
    const double rounding = boxRounding(a, b);
    double most = -kInfinity;
    for (std::size_t i = 0; i < planes_ && !skip(most); ++i) {
      const Plane& plane = plane_[i];
      const double reachA = a.body ? plane.reach : a.box.reach(plane.n),
                   reachB = b.body ? plane.reach : b.box.reach(plane.n);
      most = std::max(most, plane.n.dot(d) - reachA - reachB - rounding);
    }
    return skip(most) ? most : std::max(most, gapOf(pair_, a, b, result_.runnerUp));
  }
  // The second nearest pair is wanted, too. If two surfaces meet, the search ends at once.
  bool skip(double bound) const { return any() && (noneNearer_ || bound >= result_.runnerUp); }

  bool leaves(const Part& leafA, const Part& leafB) {
    ConvexBody a, b;
    // This pair is solved already.
    if (any() && result_.element == std::array{leafA.node.id, leafB.node.id}) return false;
    if (!pair_.first.body(leafA, a) || !pair_.second.body(leafB, b)) return false;  // a free cell
    if (skip(gapAlongPlanes(leafA, a, leafB, b))) return false;
    PairCache start;
    if (any())
      start = {result_.found.normal, result_.found.patch};
    else if (cache_)
      start = *cache_;
    const Distance found = distance(a, b, &start);
    ++result_.solved;
    if (found.status == DistanceStatus::invalid) {  // an element is no valid body: nothing is known
      result_ = {};
      return unknown_ = true;
    }
    Distance& best = result_.found;
    bounds(found);
    const bool least = !(any() && found.distance >= best.distance);
    keepPlane(leafA, leafB, found.normal, least);
    if (!least) {
      result_.runnerUp = std::min(result_.runnerUp, found.distance);
    } else {
      result_.runnerUp = any() ? best.distance : kInfinity;
      best = found;
      result_.element = {leafA.node.id, leafB.node.id};
      first_ = leafA;
      if (cache_) *cache_ = start;
    }
    if (exact_)
      best.status = DistanceStatus::exact;
    else if (best.status == DistanceStatus::exact)
      best.status = DistanceStatus::bounded;
    best.lower = lower_;
    best.upper = upper_;
    if (!surfaces_ || best.distance > 0) return false;
    meet(a, b);
    return true;
  }

 private:
  // Two parallel planes that touch the elements of an answer. They bound the distances of all other elements.
  struct Plane {
    Vector3d n{0, 0, 0};      // unit normal from the first geometry to the second, in the first one's frame
    Vector3d world{0, 0, 0};  // the normal in the world
    // If one geometry is a body: how far it reaches along the normal, from its box's centre and from its
    // origin.
    double reach = 0, support = 0;
  };

  // Bounds on the least distance. An answer that is not exact may be the least, even if its own `distance` is
  // not.
  void bounds(const Distance& found) {
    if (found.lower < lower_) exact_ = found.status == DistanceStatus::exact;
    lower_ = std::min(lower_, found.lower);
    upper_ = std::min(upper_, found.upper);
  }

  double gapAlongPlanes(const Part& leafA, const ConvexBody& a, const Part& leafB,
                        const ConvexBody& b) const {
    if (a.unbounded() || b.unbounded()) return -kInfinity;
    const Vector3d d = b.pose.translation() - a.pose.translation();
    const double rounding = a.rounding + b.rounding + a.supportError() + b.supportError() +
                            kGapRounding * (d.lpNorm<1>() + a.extent() + b.extent());
    double most = -kInfinity;
    for (std::size_t i = 0; i < planes_ && !skip(most); ++i) {
      const Vector3d& n = plane_[i].world;
      const double supportA = leafA.body ? plane_[i].support : a.support(n),
                   supportB = leafB.body ? plane_[i].support : b.support(-n);
      most = std::max(most, n.dot(d) - supportA - supportB - rounding);
    }
    return most;
  }

  // Tests whether a gap along the best answer's normal is as wide as the answer. If it is, no elements are
  // nearer, but others may be as near.
  void tryAllCorners() {
    patience_ *= 2;
    Distance& best = result_.found;
    if (noneNearer_ || planes_ == 0 || !any()) return;
    const Vector3d& n = plane_[0].n;
    const double onA = pair_.first.reach(n), onB = -pair_.second.reach(-n);
    const double rounding =
        kGapRounding * (pair_.first.whole().coordinates + pair_.second.whole().coordinates);
    const double gap = onB - onA - rounding;
    if (!(gap >= best.distance - 2.0 * rounding)) return;
    noneNearer_ = true;
    result_.runnerUp = best.distance;
    best.lower = lower_ = std::min(lower_, gap);
  }

  // Keeps one plane of each direction. The plane of the best answer is the first.
  void keepPlane(const Part& a, const Part& b, const Vector3d& world, bool best) {
    constexpr double kAlike = 0.999;  // cosine of 2.6 degrees
    if (world.isZero(0) || pair_.first.unbounded() || pair_.second.unbounded()) return;
    const Vector3d n = pair_.toWorld.transpose() * world;
    std::size_t place = 0;
    if (!best) {
      if (surfaces_) return;  // for surfaces that are apart, one normal is enough for most bounds
      for (std::size_t i = 0; i < planes_; ++i)
        if (plane_[i].n.dot(n) > kAlike) return;
      place = planes_ < plane_.size() ? planes_ : oldest_;
      if (planes_ == plane_.size()) oldest_ = oldest_ % (plane_.size() - 1) + 1;
    }
    planes_ = std::max(planes_, place + 1);
    Plane& plane = plane_[place] = {n, world};
    if (a.body) plane.reach = a.reach(n), plane.support = a.body->support(world);
    if (b.body) plane.reach = b.reach(-n), plane.support = b.body->support(-world);
  }

  // Surfaces have no depth, so the distance is 0, at a point of both elements. If it is not proven that the
  // two elements meet, they may be apart by up to `upper_`.
  void meet(const ConvexBody& a, const ConvexBody& b) {
    Distance& found = result_.found;
    const double rounding =
        kGapRounding * (a.extent() + b.extent() + (b.pose.translation() - a.pose.translation()).lpNorm<1>());
    found.point[0] = found.point[1] = commonPoint(a.shape, a.pose, b.shape, b.pose);
    found.normal.setZero();
    found.status = upper_ <= rounding ? DistanceStatus::exact : DistanceStatus::bounded;
    found.distance = 0;
    found.lower = -rounding;
    found.upper = std::max(rounding, upper_);
    result_.runnerUp = 0;  // other elements may meet as well
  }

  const PosedPair& pair_;
  const bool surfaces_;
  ElementsDistance result_;
  Part first_;
  double lower_ = kInfinity, upper_ = kInfinity;
  bool exact_ = false;  // whether the answer that gave the lower bound is exact
  std::array<Plane, 16> plane_;
  std::size_t planes_ = 0, oldest_ = 1;
  PairCache* cache_;
  long patience_ = 0;
  bool noneNearer_ = false, unknown_ = false;
};

/// The answer if there is no element: the largest double, which is FCL's own value for this.
ElementsDistance nothingThere() {
  ElementsDistance answer;
  answer.found.status = DistanceStatus::exact;
  answer.found.distance = answer.found.lower = std::numeric_limits<double>::max();
  return answer;
}

/// Searches both hierarchies from their roots. Two surfaces first start from near elements.
void search(const PosedPair& pair, NearestElements& nearest) {
  const Part a = pair.first.whole(), b = pair.second.whole();
  if (pair.areSurfaces()) {
    FirstElements start;
    if (!descend(pair, a, b, start)) return;  // a tree of free cells
    if (descend(pair, a, start.b, nearest)) return;
    if (nearest.any() && descend(pair, nearest.first(), b, nearest)) return;
  }
  descend(pair, a, b, nearest);
}

}  // namespace

ElementsDistance nearestElements(const fcl::CollisionGeometryd& geometry1, const Eigen::Isometry3d& pose1,
                                 const fcl::CollisionGeometryd& geometry2, const Eigen::Isometry3d& pose2,
                                 bool finite, const KnownTrees& trees, PairCache* cache) {
  const PosedPair pair(geometry1, pose1, geometry2, pose2, finite, trees);
  NearestElements nearest(pair, cache);
  if (!pair.valid || !(finite || pair.finite())) return {};
  search(pair, nearest);
  return nearest.foundNothing() ? nothingThere() : nearest.result();
}

}  // namespace fcl_stpbv::detail
