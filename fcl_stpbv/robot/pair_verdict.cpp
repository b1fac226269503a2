// Decides whether one pair is clear:
// 1. Balls inside two bodies may prove a hit.
// 2. The separating plane of the last check is stored in both bodies' frames. After the bodies have turned,
//    the height of the second body over the plane has two bounds: its sphere's radius times the turn, and the
//    ball of radius R that contains an STP-BV and touches it at the plane (docs/robot.md).
// 3. Otherwise the search of distance/threshold.h, or that of adapter/proximity.cpp for bodies that are not
//    convex.

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/distance/threshold.h"
#include "fcl_stpbv/robot/checker_impl.h"

namespace fcl_stpbv {

using namespace detail;
using Eigen::Isometry3d;
using Eigen::Vector3d;

// After a larger turn the plane is of little use, and a search that starts from the centres takes fewer steps
// than one that starts from the plane.
bool CollisionChecker::Impl::isRecent(const KeptPair& pair) const {
  constexpr double kTurn2 = 0.01;  // (0.1 rad)^2
  return pair.kept && turnSince(pair.plane, state_.link[bodies_[pair.a].frame],
                                state_.link[bodies_[pair.b].frame]) < kTurn2;
}

double CollisionChecker::Impl::planeGap(KeptPair& pair) const {
  if (!pair.lifted) lift(pair);
  const PlacedBody &a = bodies_[pair.a], &b = bodies_[pair.b];
  return gapAlong(pair.plane, state_.link[a.frame], state_.link[b.frame], centres_[pair.a], centres_[pair.b],
                  b.radius, pair.halfR) -
         pair.rounding - slack_;
}

bool CollisionChecker::Impl::isClear(const NearPair& near) {
  KeptPair& pair = checked_[static_cast<std::size_t>(near.pair)];
  ++work_.near;
  const double within = bodies_[pair.a].inner + bodies_[pair.b].inner + margin_ - slack_ - pair.rounding;
  bool clear = false;
  if (!(within > 0 && near.apart2 < within * within)) {
    if (!isRecent(pair))
      pair.cache = {};
    else if (planeGap(pair) > margin_)
      return true;
    ++work_.searched;
    clear = searchSaysClear(pair);
  }
  if (clear) {
    keepPlane(pair);
  } else {
    pair.lastHit = work_.configurations;
    pair.kept = false;
    pair.cache = {};
  }
  return clear;
}

bool CollisionChecker::Impl::searchSaysClear(KeptPair& pair) {
  PlacedBody &a = bodies_[pair.a], &b = bodies_[pair.b];
  const ConvexBody &one = posed(a), &other = posed(b);
  const double margin = margin_ + slack_;
  if (one.volume && other.volume)
    return isFartherThan(margin, *one.volume, one.pose, *other.volume, other.pose, &pair.cache);
  if (a.convex && b.convex && !(one.unbounded() && other.unbounded()))
    return isFartherThan(margin, one, other, &pair.cache);
  return isFartherThan(margin, *a.geometry, one.pose, *b.geometry, other.pose, {&pair.cache, nullptr});
}

// Stores the plane along the normal that the pair's cache contains now.
void CollisionChecker::Impl::keepPlane(KeptPair& pair) const {
  const PlacedBody &a = bodies_[pair.a], &b = bodies_[pair.b];
  const double length = pair.cache.normal.norm();
  pair.kept = a.convex && b.convex && !a.body.unbounded() && !b.body.unbounded() && length > 0.5;
  pair.lifted = false;
  if (!pair.kept) return;
  const Vector3d n = pair.cache.normal / length;
  pair.plane.outward[0] = pack3(state_.link[a.frame].linear().transpose() * n);
  pair.plane.outward[1] = pack3(state_.link[b.frame].linear().transpose() * -n);
}

void CollisionChecker::Impl::lift(KeptPair& pair) const {
  pair.plane.height = 0;
  for (std::size_t side = 0; side < 2; ++side) {
    const PlacedBody& placed = bodies_[side == 0 ? pair.a : pair.b];
    ConvexBody body = placed.body;
    body.pose = placed.inFrame;
    const Vector3d outward = unpack(pair.plane.outward[side]);
    const int patch = pair.cache.patch[side];
    pair.plane.height += body.support(outward, patch) - outward.dot(placed.centre - body.pose.translation());
    if (side == 1 && body.volume)
      pair.plane.touching =
          pack3(body.pose * body.volume->surfacePoint(body.pose.linear().transpose() * outward, patch) -
                placed.centre);
  }
  pair.lifted = true;
}

double CollisionChecker::Impl::measured(KeptPair& pair) {
  PlacedBody &a = bodies_[pair.a], &b = bodies_[pair.b];
  const ConvexBody &one = posed(a), &other = posed(b);
  const bool convex = a.convex && b.convex && !(one.unbounded() && other.unbounded());
  Distance found;
  if (convex) {
    found = distance(one, other, &pair.cache);
  } else {
    const DistanceAnswer answer =
        distance(*a.geometry, one.pose, *b.geometry, other.pose,
                 {&pair.cache, nullptr, nullptr, StartFrom::centres, a.finite && b.finite});
    found.status = answer.status;
    found.distance = answer.distance;
  }
  if (found.status == DistanceStatus::invalid) return std::numeric_limits<double>::lowest();
  keepPlane(pair);
  return found.distance;
}

}  // namespace fcl_stpbv
