// Upper bound on the support function of a body that joints push: the largest sum of height and push over all
// its points. Points that cannot be the largest are skipped.
#include <algorithm>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/push_bound.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

// Upper bound on how far the joints push any point of the body along the normal, from the chord of each turn.
double PushBound::mostPush(const BodySide& side) const {
  const std::size_t m = side.joints.size();
  double sum = 0, moved = 0, fromOuter = -1;
  for (std::size_t i = m; i-- > 0;) {
    const OutwardJoint& o = side.joints[i];
    if (o.joint.slides) {
      moved += o.joint.half;
      sum += o.joint.half;
      continue;
    }
    const Vector3d r = side.body->centre - o.joint.origin;
    if (fromOuter < 0) fromOuter = r.norm() + side.body->reach;
    const double reach =
        std::min(o.joint.axis.cross(r).norm() + side.body->reach + moved, fromOuter + way_[i]);
    sum += o.chord * tilt_[i] * reach;
    moved += o.chord * reach;
  }
  return sum;
}

// Upper bound on the change of the normal relative to the body by the turns: the sum of their chords.
double PushBound::mostTurned(const BodySide& side) const {
  double turned = 0;
  for (std::size_t i = 0; i < side.joints.size(); ++i)
    if (!side.joints[i].joint.slides) turned += side.joints[i].chord * std::min(1.0, tilt_[i] + turned);
  return turned;
}

// The point that gets farthest along n, in first order.
std::size_t PushBound::foremost(const Vector3d& n, const BodySide& side) const {
  const std::vector<Vector3d>& points = side.body->points;
  std::size_t found = 0;
  double best = -kInfinity;
  for (std::size_t v = 0; v < points.size(); ++v) {
    double reached = n.dot(points[v]);
    for (std::size_t i = 0; i < side.joints.size(); ++i)
      if (!side.joints[i].joint.slides)
        reached += side.joints[i].sine * std::abs(turned_[i].dot(points[v] - side.joints[i].joint.origin));
    if (reached <= best) continue;
    best = reached;
    found = v;
  }
  return found;
}

// The bound for a point is at most that of another point, plus the distance of the two along n and its change
// by the turns.
double PushBound::support(const Vector3d& n, const BodySide& side, Eigen::VectorXd& shares) {
  prepare(n, side);
  const std::vector<Vector3d>& points = side.body->points;
  const double most = mostPush(side), turned = mostTurned(side);
  const std::size_t first = foremost(n, side);
  const double reachedFirst = n.dot(points[first]) + push(n, side, points[first]);
  double best = reachedFirst;
  bestShare_ = share_;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const Vector3d way = points[v] - points[first];
    const double height = n.dot(points[v]);
    if (v == first || std::min(height + most, reachedFirst + n.dot(way) + turned * way.norm()) <= best)
      continue;
    const double reached = height + push(n, side, points[v]);
    if (reached <= best) continue;
    best = reached;
    bestShare_ = share_;
  }
  for (std::size_t i = 0; i < side.joints.size(); ++i) shares[side.joints[i].joint.slot] += bestShare_[i];
  return best + side.body->radius;
}

}  // namespace fcl_stpbv::detail
