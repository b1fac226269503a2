// Continuous collision of one pair: the two moving geometries are the scene of the search in motion_search.h.
#include "fcl_stpbv/adapter/continuous_collide.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "fcl_stpbv/adapter/motion_search.h"
#include "fcl_stpbv/adapter/moving_bodies.h"
#include "fcl_stpbv/adapter/nearest_pair.h"
#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/convex/relative_pose.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using fcl::CollisionGeometryd;
using fcl::ContinuousCollisionRequestd;
using fcl::ContinuousCollisionResultd;
using fcl::Transform3d;

/// One moving geometry with a ball around it, and with its convex body if it is one.
class Moving {
 public:
  Moving(const CollisionGeometryd& given, const SteadyMotion& motion) : geometry(given), motion_(motion) {
    const PosedGeometry still(given, Isometry3d::Identity(), Isometry3d::Identity());
    known = still.known() && still.finite();
    if (known && still.merged()) refitted_.emplace(still.tree());
    unbounded = still.unbounded();
    convex = still.isBody();
    if (convex) body = still.body();
    if (!known || unbounded) return;
    Eigen::AlignedBox3d box;
    addCells(still, still.whole(), box);
    centre = box.center();
    radius = 0.5 * box.diagonal().norm();
    around(motion.begin * centre, radius);
    // The points go around the axis in circles, at a speed of at most `turning_`.
    acceleration_ = motion.angular.norm() * turning_;
  }

  void place(double t) {
    pose = motion_.at(t, &velocity_);
    body.pose = pose;
  }
  BodyVelocity velocity(const Vector3d& about) const {
    return {velocity_ + motion_.angular.cross(about - pose.translation()), motion_.angular, acceleration_,
            true};
  }
  /// Upper bound on how far any point of the geometry moves in a unit of time (m).
  double speed() const { return motion_.linear.norm() + turning_; }
  /// speed() as seen from the other body. A velocity that both have does not bring them nearer.
  double speedBeside(const Moving& other) const {
    return (motion_.linear - other.motion_.linear).norm() + turning_ + other.turning_;
  }
  bool turns() const { return !motion_.angular.isZero(0); }
  /// For an unbounded geometry: its speed matters only in the region that `other` can reach, relative to the
  /// moving axis.
  void reachTo(const Moving& other) {
    around(other.motion_.begin * other.centre, other.radius + other.speed() + motion_.linear.norm());
  }
  /// Bound on all lengths from which a pose and a velocity are computed (m): where the body is and how it
  /// moves. How far away the axis is does not matter.
  double coordinates() const {
    return motion_.begin.translation().lpNorm<1>() + centre.lpNorm<1>() + radius + speed() +
           motion_.turning.norm();
  }

  bool isEmptyTree() const {
    const ElementTree tree(geometry, /*known=*/true);
    return tree.any() && !tree.occupied(tree.root());
  }

  /// The tree with new boxes in place of those that FCL has merged; null if FCL has merged none.
  const ElementTree* refitted() const { return refitted_ ? &*refitted_ : nullptr; }

  const CollisionGeometryd& geometry;
  bool known, unbounded, convex;
  ConvexBody body;
  Isometry3d pose;
  Vector3d centre{0, 0, 0};  // of the ball, in the geometry's frame
  double radius = 0;

 private:
  // Bounds the speed around the axis of all points within `reach` of a point that rotates with the body. It
  // holds for the whole motion, because the axis has a constant direction and no point changes its distance
  // from the axis.
  void around(const Vector3d& place, double reach) {
    const Vector3d &w = motion_.angular,
                   there = motion_.turning + w.cross(place - motion_.begin.translation());
    turning_ = there.norm() + w.norm() * reach;
  }

  // Of an octree only the occupied cells count.
  void addCells(const PosedGeometry& still, const PosedGeometry::Part& part, Eigen::AlignedBox3d& box) const {
    if (part.leaf || !still.loose()) {
      const Vector3d half = part.box.axes.cwiseAbs() * part.box.half;
      box.extend(part.box.centre - half).extend(part.box.centre + half);
      return;
    }
    std::array<PosedGeometry::Part, 8> child;
    const std::size_t count = still.children(part, child);
    for (std::size_t i = 0; i < count; ++i) addCells(still, child[i], box);
  }

  SteadyMotion motion_;
  std::optional<ElementTree> refitted_;
  Vector3d velocity_{0, 0, 0};  // of the body's origin
  double turning_ = 0, acceleration_ = 0;
};

class MovingPair {
 public:
  MovingPair(const CollisionGeometryd& geometry1, const SteadyMotion& motion1,
             const CollisionGeometryd& geometry2, const SteadyMotion& motion2, double margin)
      : a_(geometry1, motion1), b_(geometry2, motion2), margin_(margin) {
    if (a_.unbounded) a_.reachTo(b_);
    if (b_.unbounded) b_.reachTo(a_);
    // Some dozens of products and sums lie between the poses and a bound.
    slack_ = 64 * std::numeric_limits<double>::epsilon() * (a_.coordinates() + b_.coordinates()) +
             2 * (a_.body.supportError() + b_.body.supportError());
  }

  void place(double t) {
    a_.place(t);
    b_.place(t);
  }

  /// Whether the geometries cannot meet, because one of them is a tree whose cells are all free.
  bool hasNothing() const { return a_.known && b_.known && (a_.isEmptyTree() || b_.isEmptyTree()); }

  bool look(int, double most, Cover& cover) {
    QueryContext context;
    context.cache = &cache_;
    context.finite = a_.known && b_.known;
    answer =
        detail::distance(a_.geometry, a_.pose, b_.geometry, b_.pose, context, {a_.refitted(), b_.refitted()});
    if (!(answer.distance > margin_)) return true;
    const double gap = answer.lower - margin_;
    // An unbounded geometry that rotates crosses every fixed plane.
    const bool turning = (a_.unbounded && a_.turns()) || (b_.unbounded && b_.turns());
    if (margin_ < 0 && !a_.convex && !b_.convex) {
      cover = {most, most};  // surfaces have no depth, so they never come within a negative margin
    } else if (a_.convex && b_.convex && !turning) {
      cover = byPlane(gap, most);
    } else {
      cover = speedCover(gap, a_.speedBeside(b_), 0.0, most, slack_);
      if (!turning && std::min(cover.before, cover.after) < most) cover = byElements(most, cover);
    }
    return false;
  }

  DistanceAnswer answer;

 private:
  Vector3d about() const { return 0.5 * (answer.points[0] + answer.points[1]); }

  Cover byPlane(double gap, double most) const {
    const auto support = [this](const Moving& m, std::size_t which) {
      return [&m, which, this](const Vector3d& d) { return m.body.reach(d, about(), answer.points[which]); };
    };
    return planeCover(answer.normal, gap, support(a_, 0), a_.velocity(about()), support(b_, 1),
                      b_.velocity(about()), most, slack_);
  }

  Cover byElements(double most, const Cover& known) const {
    const PosedPair pair(a_.geometry, a_.pose, b_.geometry, b_.pose, /*known=*/true,
                         {a_.refitted(), b_.refitted()});
    return elementCover({pair,
                         a_.pose,
                         answer.normal,
                         answer.points,
                         about(),
                         {a_.velocity(about()), b_.velocity(about())},
                         a_.speedBeside(b_),
                         0.0,  // the speed bound holds for the whole motion, so it does not grow
                         margin_,
                         slack_},
                        most, known);
  }

  Moving a_, b_;
  double margin_, slack_;
  PairCache cache_;
};

/// Makes the rotation exact up to rounding, because the bounds between two times rely on it.
bool makeSteady(SteadyMotion& motion) {
  return makeRigid(motion.begin) && motion.linear.allFinite() && motion.turning.allFinite() &&
         motion.angular.allFinite();
}

/// The answer if FCL's marks or a tree's cells call all of a geometry free. Its distance is that of
/// distance() for such a tree.
const MotionAnswer kMeetsNothing = [] {
  MotionAnswer free{MotionVerdict::free, 1, 1, {}, 1};
  free.answer.status = DistanceStatus::exact;
  free.answer.distance = free.answer.lower = std::numeric_limits<double>::max();
  return free;
}();

double inFclTerms(const MotionAnswer& found, const SteadyMotion& motion1, const SteadyMotion& motion2,
                  ContinuousCollisionResultd& result) {
  result.is_collide = found.verdict != MotionVerdict::free;
  // After `from` the bodies of an undecided motion may meet at any time.
  result.time_of_contact = found.verdict == MotionVerdict::undecided ? found.from : found.until;
  result.contact_tf1 = motion1.at(result.time_of_contact);
  result.contact_tf2 = motion2.at(result.time_of_contact);
  const bool answered =
      found.answer.status != DistanceStatus::invalid || found.verdict == MotionVerdict::free;
  return answered ? result.time_of_contact : -1;
}

/// firstContact() of two moving geometries, with FCL's request and result.
double collideOnTheirWays(const CollisionGeometryd& geometry1, const SteadyMotion& motion1,
                          const CollisionGeometryd& geometry2, const SteadyMotion& motion2,
                          const ContinuousCollisionRequestd& request, ContinuousCollisionResultd& result) {
  const bool canMeet = isOccupied(geometry1) && isOccupied(geometry2);
  const MotionAnswer found =
      canMeet ? firstContact(geometry1, motion1, geometry2, motion2, {0, request.toc_err}) : kMeetsNothing;
  return inFclTerms(found, motion1, motion2, result);
}

double unknown(ContinuousCollisionResultd& result) {
  result.is_collide = true;
  result.time_of_contact = 0;
  result.contact_tf1 = result.contact_tf2 = Isometry3d::Identity();
  return -1;
}

}  // namespace

MotionAnswer firstContact(const CollisionGeometryd& geometry1, const SteadyMotion& givenMotion1,
                          const CollisionGeometryd& geometry2, const SteadyMotion& givenMotion2,
                          const MotionRequest& request) {
  MotionAnswer result;
  SteadyMotion motion1 = givenMotion1, motion2 = givenMotion2;
  if (!makeSteady(motion1) || !makeSteady(motion2)) return result;
  MovingPair pair(geometry1, motion1, geometry2, motion2, request.margin);
  pair.place(0);
  Cover ignored;
  const bool begins = pair.look(0, 0, ignored);
  result.answer = pair.answer;
  result.queries = 1;
  if (pair.hasNothing()) return kMeetsNothing;
  if (pair.answer.status == DistanceStatus::invalid) return result;
  if (begins) {
    result.verdict = MotionVerdict::contact;
    return result;
  }
  const MotionBracket found = MotionSearch<MovingPair>(pair, request).run(1);
  pair.place(found.until);
  pair.look(0, 0, ignored);
  return {found.verdict, found.from, found.until, pair.answer, found.queries + 2};
}

double continuousCollide(const CollisionGeometryd* geometry1, const fcl::MotionBased* motion1,
                         const CollisionGeometryd* geometry2, const fcl::MotionBased* motion2,
                         const ContinuousCollisionRequestd& request, ContinuousCollisionResultd& result) {
  SteadyMotion first, second;
  if (!steadyMotion(*motion1, first) || !steadyMotion(*motion2, second)) return unknown(result);
  return collideOnTheirWays(*geometry1, first, *geometry2, second, request, result);
}

double continuousCollide(const CollisionGeometryd* geometry1, const Transform3d& begin1,
                         const Transform3d& end1, const CollisionGeometryd* geometry2,
                         const Transform3d& begin2, const Transform3d& end2,
                         const ContinuousCollisionRequestd& request, ContinuousCollisionResultd& result) {
  SteadyMotion first, second;
  if (!steadyMotion(begin1, end1, request.ccd_motion_type, first) ||
      !steadyMotion(begin2, end2, request.ccd_motion_type, second))
    return unknown(result);
  return collideOnTheirWays(*geometry1, first, *geometry2, second, request, result);
}

double continuousCollide(const fcl::CollisionObjectd* object1, const Transform3d& end1,
                         const fcl::CollisionObjectd* object2, const Transform3d& end2,
                         const ContinuousCollisionRequestd& request, ContinuousCollisionResultd& result) {
  return continuousCollide(object1->collisionGeometry().get(), object1->getTransform(), end1,
                           object2->collisionGeometry().get(), object2->getTransform(), end2, request,
                           result);
}

double collide(const fcl::ContinuousCollisionObjectd* object1, const fcl::ContinuousCollisionObjectd* object2,
               const ContinuousCollisionRequestd& request, ContinuousCollisionResultd& result) {
  return continuousCollide(object1->collisionGeometry().get(), object1->getMotion(),
                           object2->collisionGeometry().get(), object2->getMotion(), request, result);
}

}  // namespace fcl_stpbv
