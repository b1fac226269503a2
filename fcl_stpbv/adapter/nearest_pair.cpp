// Branch and bound down both hierarchies. Boxes are bounded along the best normal so far too, which all but
// ends the search once the nearest elements are known.
#include "fcl_stpbv/adapter/nearest_pair.h"

#include <algorithm>

#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/distance/shape_distance.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

class NearestElements {
 public:
  explicit NearestElements(const PosedPair& pair) : pair_(pair), surfaces_(pair.areSurfaces()) {}

  const ElementsDistance& result() const { return result_; }

  double bound(const PosedGeometry::Part& a, const PosedGeometry::Part& b) const {
    return gapOf(pair_, a, b, n_);
  }
  // The second nearest pair is wanted too, but where two surfaces meet.
  bool skip(double bound) const { return any() && bound >= result_.runnerUp; }

  bool leaves(const PosedGeometry::Part& leafA, const PosedGeometry::Part& leafB) {
    ConvexBody a, b;
    if (!pair_.first.body(leafA, a) || !pair_.second.body(leafB, b)) return false;  // a free cell
    if (skip(gapAlongBest(a, b))) return false;
    const Distance found = distance(a, b);
    if (found.status == DistanceStatus::invalid) {  // an element that is no body: nothing is known
      result_ = {};
      return true;
    }
    Distance& best = result_.found;
    bounds(found);
    if (any() && found.distance >= best.distance) {
      result_.runnerUp = std::min(result_.runnerUp, found.distance);
    } else {
      result_.runnerUp = best.status == DistanceStatus::invalid ? kInfinity : best.distance;
      best = found;
      result_.element = {leafA.node.id, leafB.node.id};
      n_ = pair_.toWorld.transpose() * found.normal;
    }
    best.status = exact_ ? DistanceStatus::exact : DistanceStatus::bounded;
    best.lower = lower_;
    best.upper = upper_;
    if (!surfaces_ || best.distance > 0) return false;
    meet(a, b);
    return true;
  }

 private:
  bool any() const { return result_.found.status != DistanceStatus::invalid; }

  // Bounds of the least of all: an answer that is not exact may be the lowest, whatever it says itself.
  void bounds(const Distance& found) {
    if (found.lower < lower_) exact_ = found.status == DistanceStatus::exact;
    lower_ = std::min(lower_, found.lower);
    upper_ = std::min(upper_, found.upper);
  }

  double gapAlongBest(const ConvexBody& a, const ConvexBody& b) const {
    if (!any() || a.unbounded() || b.unbounded()) return -kInfinity;
    const Vector3d &n = result_.found.normal, d = b.pose.translation() - a.pose.translation();
    return n.dot(d) - a.support(n) - b.support(-n) - a.rounding - b.rounding -
           kGapRounding * (d.lpNorm<1>() + a.extent() + b.extent());
  }

  // Surfaces overlap by nothing: 0, at a point of both elements.
  void meet(const ConvexBody& a, const ConvexBody& b) {
    Distance& found = result_.found;
    const double rounding =
        kGapRounding * (a.extent() + b.extent() + (b.pose.translation() - a.pose.translation()).lpNorm<1>());
    found.point[0] = found.point[1] = commonPoint(a.shape, a.pose, b.shape, b.pose);
    found.normal.setZero();
    found.status = DistanceStatus::exact;
    found.distance = 0;
    found.lower = -rounding;
    found.upper = rounding;
    result_.runnerUp = kInfinity;
  }

  const PosedPair& pair_;
  const bool surfaces_;
  ElementsDistance result_;
  double lower_ = kInfinity, upper_ = kInfinity;
  bool exact_ = false;   // whether the pair that the lower bound comes from is
  Vector3d n_{0, 0, 0};  // best normal, in the first geometry's frame
};

}  // namespace

ElementsDistance nearestElements(const fcl::CollisionGeometryd& geometry1, const Eigen::Isometry3d& pose1,
                                 const fcl::CollisionGeometryd& geometry2, const Eigen::Isometry3d& pose2,
                                 bool finite, const KnownTrees& trees) {
  const PosedPair pair(geometry1, pose1, geometry2, pose2, finite, trees);
  NearestElements nearest(pair);
  if (pair.valid && (finite || pair.finite()))
    descend(pair, pair.first.whole(), pair.second.whole(), nearest);
  return nearest.result();
}

}  // namespace fcl_stpbv::detail
