// Conservative advancement (Mirtich and Canny 1995) on the straight line between two configurations, with
// separating planes in place of distances (docs/motion.md).
// 1. robot/motion_chains.h computes the bodies' velocities and bounds on their accelerations.
// 2. For each time examined, the velocities give the times before and after it for which a plane keeps the
//    bodies apart (planeCover). The first plane tried is the one between their bounding balls. If that does
//    not cover enough, the plane of the exact distance's normal is used. For meshes and trees, the bound on
//    the bodies' speed and a plane for each element (elementCover) take its place.
// 3. adapter/motion_search.h chooses the times, until the covers contain the whole motion or a contact is
//    found. For the closest approach the margin is the smallest distance so far.
#include "fcl_stpbv/robot/motion_check.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/adapter/motion_search.h"
#include "fcl_stpbv/adapter/moving_bodies.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/collision_checker.h"
#include "fcl_stpbv/robot/motion_chains.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

const std::vector<CheckedPair>& checked(const std::vector<CheckedPair>& pairs) {
  if (pairs.empty())
    throw Error("MotionCheck: no pairs are given, so that nothing could be said about motions");
  return pairs;
}

}  // namespace

/// The pairs' chains, what earlier queries found for each pair, and the covers.
class MotionCheck::Impl {
 public:
  Impl(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
       std::vector<CheckedPair> pairs, std::vector<Obstacle> obstacles)
      : kinematics_(std::move(kinematics)),
        geometry_(std::move(geometry)),
        obstacles_(std::move(obstacles)),
        pairs_(std::move(pairs)),
        chains_(*kinematics_, *geometry_, obstacles_, pairs_),
        caches_(pairs_.size()),
        checker_(kinematics_, geometry_, checked(pairs_), obstacles_) {}

  const std::vector<CheckedPair>& pairs() const { return pairs_; }
  const Kinematics& kinematics() const { return *kinematics_; }
  bool isFree(const ConstVector& q, double margin);
  MotionBracket firstContact(const ConstVector& q0, const ConstVector& q1, const MotionRequest& request);
  bool closest(const ConstVector& q0, const ConstVector& q1, double precision, double offset,
               std::vector<Approach>& best);
  DistanceAnswer answer(int pair, const ConstVector& q);

 private:
  using Placed = MotionChains::Placed;
  class Scene;
  class ApproachScene;

  const Placed& body(int pair, int side) const { return chains_.body(chains_.pair(pair).side[side]); }
  Distance ask(int pair);
  DistanceAnswer askFcl(int pair);
  Cover ballCover(int pair, double margin, double most) const;
  Cover cover(int pair, const Distance& found, double margin, double most) const;

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  std::vector<Obstacle> obstacles_;
  std::vector<CheckedPair> pairs_;
  MotionChains chains_;
  std::vector<PairCache> caches_;  // one for each pair
  CollisionChecker checker_;       // for single configurations
};

/// For the first contact: the distance must be above a margin that does not change.
class MotionCheck::Impl::Scene {
 public:
  Scene(Impl& check, double margin) : check_(check), margin_(margin) {}
  void place(double t) { check_.chains_.place(t); }
  bool look(int index, double most, Cover& cover) {
    cover = check_.ballCover(index, margin_, most);
    if (cover.before >= most && cover.after >= most && most > 0) return false;
    const Distance found = check_.ask(index);
    if (found.status != DistanceStatus::invalid && found.distance <= margin_) return true;
    cover = longer(cover, check_.cover(index, found, margin_, most));
    return false;
  }

 private:
  Impl& check_;
  double margin_;
};

/// For the closest approach: the distance must be above the least distance so far.
class MotionCheck::Impl::ApproachScene {
 public:
  ApproachScene(Impl& check, double precision, double offset, std::vector<Approach>& best)
      : check_(check), precision_(precision), offset_(offset), best_(best) {}
  void place(double t) {
    t_ = t;
    check_.chains_.place(t);
  }
  bool look(int index, double most, Cover& cover) {
    Approach& best = best_[at(index)];
    cover = check_.ballCover(index, best.distance - precision_, most);
    if (cover.before >= most && cover.after >= most) return false;
    const Distance found = check_.ask(index);
    if (found.distance < best.distance) best = {found.distance, offset_ + t_};
    if (found.status == DistanceStatus::invalid) return false;
    // If the depth is not exact, only its lower bound is proven.
    loose |= found.lower < found.distance - precision_;
    cover =
        longer(cover, check_.cover(index, found, std::min(best.distance, found.lower) - precision_, most));
    return false;
  }

  bool loose = false;  // whether some bound was farther from the distance than the precision

 private:
  Impl& check_;
  double precision_, offset_, t_ = 0;
  std::vector<Approach>& best_;
};

DistanceAnswer MotionCheck::Impl::askFcl(int pair) {
  const Placed &a = body(pair, 0), &b = body(pair, 1);
  return distance(*a.geometry, a.body.pose, *b.geometry, b.body.pose,
                  {&caches_[at(pair)], nullptr, nullptr, StartFrom::centres, a.finite && b.finite});
}

Distance MotionCheck::Impl::ask(int pair) {
  const Placed &a = body(pair, 0), &b = body(pair, 1);
  return a.convex && b.convex ? distance(a.body, b.body, &caches_[at(pair)]) : inCoreTerms(askFcl(pair));
}

Cover MotionCheck::Impl::ballCover(int pair, double margin, double most) const {
  const Placed &a = body(pair, 0), &b = body(pair, 1);
  const Vector3d d = b.where - a.where;
  const double length = d.norm(), gap = length - a.radius - b.radius - margin;
  if (!(gap > 0) || !std::isfinite(gap)) return {};
  const auto support = [&](const Placed& body) {
    return [&body, &a](const Vector3d& n) { return n.dot(body.where - a.where) + body.radius * n.norm(); };
  };
  return planeCover(d / length, gap, support(a), chains_.velocityOf(chains_.pair(pair), 0, a.where),
                    support(b), chains_.velocityOf(chains_.pair(pair), 1, a.where), most, chains_.slack());
}

Cover MotionCheck::Impl::cover(int pair, const Distance& found, double margin, double most) const {
  const Placed &a = body(pair, 0), &b = body(pair, 1);
  const double gap = found.lower - margin;
  if (!(gap > 0)) return {};
  const Vector3d about = 0.5 * (found.point[0] + found.point[1]);
  const BodyVelocity va = chains_.velocityOf(chains_.pair(pair), 0, about),
                     vb = chains_.velocityOf(chains_.pair(pair), 1, about);
  const double slack = chains_.slack() + 2 * (a.body.supportError() + b.body.supportError());
  if (!a.convex || !b.convex) {
    if (margin < 0 && !a.convex && !b.convex) return {most, most};  // surfaces have no depth
    const double acceleration = va.acceleration + vb.acceleration;
    if (!std::isfinite(acceleration)) return {};
    // A half space has no bounding ball. It does not turn here.
    const auto turning = [&](const Placed& body, const BodyVelocity& v) {
      const double turn = v.angular.norm();
      return turn > 0 ? turn * ((body.where - about).norm() + body.radius) : 0.0;
    };
    const double speed = (va.linear - vb.linear).norm() + turning(a, va) + turning(b, vb);
    const Cover known = speedCover(gap, speed, acceleration, most, slack);
    if (known.before >= most && known.after >= most) return known;
    const PosedPair posed(*a.geometry, a.body.pose, *b.geometry, b.body.pose, a.finite && b.finite);
    return elementCover(
        {posed, a.body.pose, found.normal, found.point, about, {va, vb}, speed, acceleration, margin, slack},
        most, known);
  }
  const auto support = [&](const Placed& body, std::size_t which) {
    return [&body, &about, &found, which](const Vector3d& d) {
      return body.body.reach(d, about, found.point[which], found.patch[which]);
    };
  };
  return planeCover(found.normal, gap, support(a, 0), va, support(b, 1), vb, most, slack);
}

bool MotionCheck::Impl::isFree(const ConstVector& q, double margin) {
  if (!chains_.set(q, q) || std::isnan(margin)) return false;
  if (margin != checker_.margin()) checker_.setMargin(margin);
  return !checker_.collides(q);
}

MotionBracket MotionCheck::Impl::firstContact(const ConstVector& q0, const ConstVector& q1,
                                              const MotionRequest& request) {
  if (!chains_.begin(q0, q1)) return {MotionVerdict::undecided, 0, 0, -1, 0};
  Scene scene(*this, request.margin);
  return MotionSearch<Scene>(scene, request).run(static_cast<int>(pairs_.size()));
}

bool MotionCheck::Impl::closest(const ConstVector& q0, const ConstVector& q1, double precision, double offset,
                                std::vector<Approach>& best) {
  best.resize(pairs_.size());
  if (!chains_.begin(q0, q1)) {
    std::fill(best.begin(), best.end(), Approach{-kInfinity, offset});
    return false;
  }
  ApproachScene scene(*this, precision, offset, best);
  MotionRequest request;
  request.tolerance = 1;
  const MotionBracket all = MotionSearch<ApproachScene>(scene, request).run(static_cast<int>(pairs_.size()));
  return all.verdict == MotionVerdict::free && !scene.loose;
}

DistanceAnswer MotionCheck::Impl::answer(int pair, const ConstVector& q) {
  if (pair < 0 || at(pair) >= pairs_.size())
    throw Error("MotionCheck: there is no pair " + std::to_string(pair));
  if (!chains_.set(q, q)) return {};
  chains_.place(0);
  return askFcl(pair);
}

MotionCheck::MotionCheck(std::shared_ptr<const Kinematics> kinematics,
                         std::shared_ptr<const RobotGeometry> geometry, std::vector<CheckedPair> pairs,
                         std::vector<Obstacle> obstacles)
    : impl_(std::make_unique<Impl>(std::move(kinematics), std::move(geometry), std::move(pairs),
                                   std::move(obstacles))) {}
MotionCheck::MotionCheck(MotionCheck&&) noexcept = default;
MotionCheck& MotionCheck::operator=(MotionCheck&&) noexcept = default;
MotionCheck::~MotionCheck() = default;

const std::vector<CheckedPair>& MotionCheck::pairs() const { return impl_->pairs(); }
const Kinematics& MotionCheck::kinematics() const { return impl_->kinematics(); }

bool MotionCheck::isFree(const ConstVector& q, double margin) { return impl_->isFree(q, margin); }

bool MotionCheck::isMotionFree(const ConstVector& q0, const ConstVector& q1, double margin) {
  return firstContact(q0, q1, {margin, 1}).verdict == MotionVerdict::free;
}

MotionBracket MotionCheck::firstContact(const ConstVector& q0, const ConstVector& q1,
                                        const MotionRequest& request) {
  return impl_->firstContact(q0, q1, request);
}

bool MotionCheck::closest(const ConstVector& q0, const ConstVector& q1, double precision, double offset,
                          std::vector<Approach>& best) {
  return impl_->closest(q0, q1, precision, offset, best);
}

DistanceAnswer MotionCheck::answer(int pair, const ConstVector& q) { return impl_->answer(pair, q); }

}  // namespace fcl_stpbv
