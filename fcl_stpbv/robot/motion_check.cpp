// Conservative advancement (Mirtich and Canny 1995) over the straight line between two configurations, with
// a plane in place of a distance (docs/motion.md).
// 1. Once for a motion and a pair: a bound on the acceleration of every point of both bodies, seen from the
//    link where their chains meet, from the joints' speeds and the lengths behind them.
// 2. At each time looked at: the links' velocities from the kinematics, and from these how long before and
//    after this time a plane keeps the bodies apart (planeCover). First the plane between their bounding
//    balls; where that does not cover enough, the plane of the exact distance's normal. Bodies that are not
//    convex have no such plane: the bound on their speed takes its place.
// 3. adapter/motion_search.h chooses the times until the covers hold the whole motion, or a contact is
//    found. For the closest approach the margin is the smallest distance so far.
#include "fcl_stpbv/robot/motion_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fcl_stpbv/adapter/motion_search.h"
#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/robot/collision_checker.h"
#include "fcl_stpbv/robot/joint_path.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Index;
using Eigen::Vector3d;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Cover longer(const Cover& a, const Cover& b) {
  return {std::max(a.before, b.before), std::max(a.after, b.after)};
}

}  // namespace

/// The chains of all pairs, and room for one motion of theirs.
class MotionCheck::Impl {
 public:
  Impl(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
       std::vector<CheckedPair> pairs, std::vector<Obstacle> obstacles);

  const std::vector<CheckedPair>& pairs() const { return pairs_; }
  const Kinematics& kinematics() const { return *kinematics_; }
  bool isFree(const ConstVector& q, double margin);
  MotionBracket firstContact(const ConstVector& q0, const ConstVector& q1, const MotionRequest& request);
  bool closest(const ConstVector& q0, const ConstVector& q1, double precision, double offset,
               std::vector<Approach>& best);
  DistanceAnswer answer(int pair, const ConstVector& q);

 private:
  struct Hop {  // a joint on the way out from the plane's link, with what the motion at hand makes of it
    double slide = 0, spin = 0, turns = 1;  // speeds, and own acceleration in spin^2 times lever
    double length = 0;                      // from the joint before to its child's origin at most
  };
  struct Side {
    int body;               // among bodies_
    int firstHop, lastHop;  // joints of the chain, inner ones first
    double acceleration = 0;
  };
  struct Pair {
    Side side[2];
    int root;  // the link that the plane is fixed to, -1 for the world
    PairCache cache;
  };
  struct Placed {  // a body or an obstacle
    int link;      // -1 for an obstacle
    const fcl::CollisionGeometryd* geometry;
    Eigen::Isometry3d local;
    Eigen::Vector3d centre;  // of its ball, in the link's frame
    double radius;
    bool convex;
    ConvexBody body;
    Eigen::Vector3d where{0, 0, 0};  // the ball's centre, now
  };
  class Scene;
  class ApproachScene;

  void addBodies();
  void addPair(const CheckedPair& pair);
  Side sideOf(int body, int root);
  bool set(const ConstVector& q0, const ConstVector& q1);
  bool begin(const ConstVector& q0, const ConstVector& q1);
  void prepare(Side& side) const;
  void place(double t);
  Distance ask(Pair& pair);
  BodyVelocity velocityOf(const Side& side, int root, const Eigen::Vector3d& about) const;
  Cover ballCover(const Pair& pair, double margin, double most) const;
  Cover cover(const Pair& pair, const Distance& found, double margin, double most) const;

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  std::vector<Obstacle> obstacles_;
  std::vector<CheckedPair> pairs_;
  std::optional<CollisionChecker> checker_;  // of single configurations; none where there are no pairs
  std::vector<Placed> bodies_;
  std::vector<Pair> moving_;
  std::vector<int> hops_;              // joints of all chains
  std::vector<int> parent_;            // of each link
  std::vector<std::vector<int>> own_;  // motions that a link adds to its parent's
  std::vector<int> motionOf_;          // first motion of each joint, -1 for none; the base's is the last
  Kinematics::State state_;
  std::vector<Twist> twist_;  // of each link, per unit of time
  std::vector<Hop> hop_;      // of each joint, the base's last
  Eigen::VectorXd q0_, way_, q_;
  double slack_ = 0;
};

/// For the first contact: farther than a margin that does not change.
class MotionCheck::Impl::Scene {
 public:
  Scene(Impl& check, double margin) : check_(check), margin_(margin) {}
  void place(double t) { check_.place(t); }
  bool look(int index, double most, Cover& cover) {
    Pair& pair = check_.moving_[at(index)];
    cover = check_.ballCover(pair, margin_, most);
    if (cover.before >= most && cover.after >= most && most > 0) return false;
    const Distance found = check_.ask(pair);
    if (found.status != DistanceStatus::invalid && found.distance <= margin_) return true;
    cover = longer(cover, check_.cover(pair, found, margin_, most));
    return false;
  }

 private:
  Impl& check_;
  double margin_;
};

/// For the closest approach: farther than what is the least so far.
class MotionCheck::Impl::ApproachScene {
 public:
  ApproachScene(Impl& check, double precision, double offset, std::vector<Approach>& best)
      : check_(check), precision_(precision), offset_(offset), best_(best) {}
  void place(double t) {
    t_ = t;
    check_.place(t);
  }
  bool look(int index, double most, Cover& cover) {
    Pair& pair = check_.moving_[at(index)];
    Approach& best = best_[at(index)];
    cover = check_.ballCover(pair, best.distance - precision_, most);
    if (cover.before >= most && cover.after >= most) return false;
    const Distance found = check_.ask(pair);
    if (found.status == DistanceStatus::invalid) return false;
    if (found.distance < best.distance) best = {found.distance, offset_ + t_};
    // A depth that is not exact proves no more than its own lower bound.
    loose |= found.lower < found.distance - precision_;
    cover = longer(cover, check_.cover(pair, found, std::min(best.distance, found.lower) - precision_, most));
    return false;
  }

  bool loose = false;  // whether some bound was farther from the distance than the precision

 private:
  Impl& check_;
  double precision_, offset_, t_ = 0;
  std::vector<Approach>& best_;
};

MotionCheck::Impl::Impl(std::shared_ptr<const Kinematics> kinematics,
                        std::shared_ptr<const RobotGeometry> geometry, std::vector<CheckedPair> pairs,
                        std::vector<Obstacle> obstacles)
    : kinematics_(std::move(kinematics)),
      geometry_(std::move(geometry)),
      obstacles_(std::move(obstacles)),
      pairs_(std::move(pairs)),
      state_(kinematics_->makeState()) {
  const RobotModel& robot = kinematics_->robot();
  parent_.assign(robot.links.size(), -1);
  own_.resize(robot.links.size());
  twist_.resize(robot.links.size());
  hop_.resize(robot.joints.size() + 1);
  motionOf_.assign(hop_.size(), -1);
  for (std::size_t l = 0; l < robot.links.size(); ++l)
    if (robot.links[l].parentJoint >= 0) parent_[l] = robot.joints[at(robot.links[l].parentJoint)].parent;
  const auto& motions = kinematics_->motions();
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const int joint = motions[m].joint;
    own_[joint < 0 ? 0 : at(robot.joints[at(joint)].child)].push_back(static_cast<int>(m));
    int& first = motionOf_[joint < 0 ? robot.joints.size() : at(joint)];
    if (first < 0) first = static_cast<int>(m);
  }
  addBodies();
  for (const CheckedPair& pair : pairs_) addPair(pair);
  if (!pairs_.empty()) checker_.emplace(kinematics_, geometry_, pairs_, obstacles_);
}

void MotionCheck::Impl::addBodies() {
  const auto add = [&](int link, const fcl::CollisionGeometryd& geometry, const Eigen::Isometry3d& pose,
                       const Vector3d& centre, double radius) {
    Placed placed{link, &geometry, pose, centre, radius, false, {}};
    placed.convex = isConvex(geometry, placed.body);
    placed.body.pose = pose;
    placed.where = centre;
    bodies_.push_back(placed);
  };
  for (const Body& body : geometry_->bodies)
    add(body.link, *body.geometry, body.pose, body.centre, body.radius);
  for (const Obstacle& obstacle : obstacles_)
    add(-1, *obstacle.geometry, obstacle.pose, obstacle.centre, obstacle.radius);
}

void MotionCheck::Impl::addPair(const CheckedPair& pair) {
  requireBodies(pair, *geometry_, obstacles_.size(), "MotionCheck");
  const int second = pair.other + (pair.obstacle ? static_cast<int>(geometry_->bodies.size()) : 0);
  Pair added{};
  added.root = -1;
  if (!pair.obstacle) {
    const int link1 = bodies_[at(pair.body)].link, link2 = bodies_[at(second)].link;
    const JointPath path = jointPath(kinematics_->robot(), link1, link2);
    added.root = path.up > 0 ? kinematics_->robot().joints[at(path.joints[path.up - 1])].parent : link1;
  }
  added.side[0] = sideOf(pair.body, added.root);
  added.side[1] = sideOf(second, added.root);
  moving_.push_back(added);
}

// The joints from `root` out to the body's link; the base is one more where the root is the world.
MotionCheck::Impl::Side MotionCheck::Impl::sideOf(int body, int root) {
  Side side{body, static_cast<int>(hops_.size()), 0};
  for (int link = bodies_[at(body)].link; link >= 0 && link != root; link = parent_[at(link)]) {
    const int joint = kinematics_->robot().links[at(link)].parentJoint;
    hops_.push_back(joint >= 0 ? joint : static_cast<int>(hop_.size()) - 1);
  }
  std::reverse(hops_.begin() + side.firstHop, hops_.end());
  side.lastHop = static_cast<int>(hops_.size());
  return side;
}

bool MotionCheck::Impl::set(const ConstVector& q0, const ConstVector& q1) {
  if (q0.size() != kinematics_->size() || q1.size() != q0.size() || !q0.allFinite() || !q1.allFinite())
    return false;
  q0_ = q0;
  way_ = q1 - q0;
  return true;
}

// Speeds and lengths of all joints for the motion, then the bounds of all pairs.
bool MotionCheck::Impl::begin(const ConstVector& q0, const ConstVector& q1) {
  if (!set(q0, q1)) return false;
  const RobotModel& robot = kinematics_->robot();
  for (std::size_t j = 0; j < hop_.size(); ++j) {
    const bool base = j == robot.joints.size();
    Hop& hop = hop_[j] = {};
    hop.length = base ? 0 : robot.joints[j].origin.translation().norm();
    if (motionOf_[j] < 0) continue;
    const Kinematics::Motion& motion = kinematics_->motions()[at(motionOf_[j])];
    const Index k = motion.coordinate;
    std::size_t freedoms = 0;
    for (const Kinematics::Motion& other : kinematics_->motions()) freedoms += other.joint == motion.joint;
    const auto farthest = [&](Index count) {
      return std::max(q0.segment(k, count).norm(), q1.segment(k, count).norm());
    };
    if (freedoms == 1) {
      const bool slides = robot.joints[j].type == JointType::prismatic;
      (slides ? hop.slide : hop.spin) = std::abs(motion.multiplier * way_[k]);
      const std::optional<Mimic>& mimic = robot.joints[j].mimic;
      if (slides)
        hop.length += std::abs(motion.multiplier) * farthest(1) + (mimic ? std::abs(mimic->offset) : 0);
    } else {
      const Index across = freedoms == 3 ? 2 : 3;
      hop.slide = way_.segment(k, across).norm();
      hop.spin = way_.segment(k + across, static_cast<Index>(freedoms) - across).norm();
      // A rotation vector that moves evenly turns the body unevenly: |dw/dt| <= |dr/dt|^2 / 2
      // (docs/motion.md).
      if (freedoms == 6) hop.turns = 1.5;
      hop.length += farthest(across);
    }
  }
  for (Pair& pair : moving_)
    for (Side& side : pair.side) prepare(side);
  return true;
}

// From the outermost joint in: its own centripetal acceleration, and that of the joints further in, which
// carry what it moves around (Coriolis).
void MotionCheck::Impl::prepare(Side& side) const {
  const Placed& body = bodies_[at(side.body)];
  side.acceleration = 0;
  if (body.link < 0) return;
  double inner = 0;
  for (int h = side.firstHop; h < side.lastHop; ++h) inner += hop_[at(hops_[at(h)])].spin;
  double lever = body.centre.norm() + body.radius;
  for (int h = side.lastHop; h-- > side.firstHop;) {
    const Hop& hop = hop_[at(hops_[at(h)])];
    inner = std::max(0.0, inner - hop.spin);
    side.acceleration += hop.turns * hop.spin * hop.spin * lever + 2 * (hop.slide + hop.spin * lever) * inner;
    lever += hop.length;
  }
}

void MotionCheck::Impl::place(double t) {
  q_ = q0_ + t * way_;
  kinematics_->forward(q_, state_);
  for (std::size_t l = 0; l < twist_.size(); ++l) {
    twist_[l] = parent_[l] >= 0 ? twist_[at(parent_[l])] : Twist{};
    for (const int m : own_[l]) {
      const double speed = way_[kinematics_->motions()[at(m)].coordinate];
      twist_[l].linear += speed * state_.motion[at(m)].linear;
      twist_[l].angular += speed * state_.motion[at(m)].angular;
    }
  }
  double length = 0, spin = 0;
  for (Placed& body : bodies_) {
    if (body.link >= 0) {
      const Eigen::Isometry3d& link = state_.link[at(body.link)];
      body.body.pose = link * body.local;
      body.where = link * body.centre;
      spin = std::max(spin, twist_[at(body.link)].angular.norm());
    }
    length = std::max(length, body.where.lpNorm<1>() + body.radius);
  }
  // Each of the products and sums from the root out to a bound is off by a few units in the last place of the
  // longest length.
  const double steps = static_cast<double>(hop_.size() + 16);
  slack_ = 16 * std::numeric_limits<double>::epsilon() * steps * length * (1 + spin);
}

Distance MotionCheck::Impl::ask(Pair& pair) {
  const Placed &a = bodies_[at(pair.side[0].body)], &b = bodies_[at(pair.side[1].body)];
  if (a.convex && b.convex) return distance(a.body, b.body, &pair.cache);
  const DistanceAnswer answer =
      distance(*a.geometry, a.body.pose, *b.geometry, b.body.pose, {&pair.cache, nullptr});
  Distance found;
  found.status = answer.status;
  found.distance = answer.distance;
  found.lower = answer.lower;
  found.upper = answer.upper;
  found.normal = answer.normal;
  found.point = answer.points;
  return found;
}

BodyVelocity MotionCheck::Impl::velocityOf(const Side& side, int root, const Vector3d& about) const {
  const int link = bodies_[at(side.body)].link;
  if (link < 0) return {};
  Twist twist = twist_[at(link)];
  if (root >= 0) {
    twist.linear -= twist_[at(root)].linear;
    twist.angular -= twist_[at(root)].angular;
  }
  return {twist.linear + twist.angular.cross(about), twist.angular, side.acceleration};
}

Cover MotionCheck::Impl::ballCover(const Pair& pair, double margin, double most) const {
  const Placed &a = bodies_[at(pair.side[0].body)], &b = bodies_[at(pair.side[1].body)];
  const Vector3d d = b.where - a.where;
  const double length = d.norm(), gap = length - a.radius - b.radius - margin;
  if (!(gap > 0) || !std::isfinite(gap)) return {};
  const auto support = [&](const Placed& body) {
    return [&body, &a](const Vector3d& n) { return n.dot(body.where - a.where) + body.radius * n.norm(); };
  };
  return planeCover(d / length, gap, support(a), velocityOf(pair.side[0], pair.root, a.where), support(b),
                    velocityOf(pair.side[1], pair.root, a.where), most, slack_);
}

Cover MotionCheck::Impl::cover(const Pair& pair, const Distance& found, double margin, double most) const {
  const Placed &a = bodies_[at(pair.side[0].body)], &b = bodies_[at(pair.side[1].body)];
  const double gap = found.lower - margin;
  if (!(gap > 0)) return {};
  const Vector3d about = 0.5 * (found.point[0] + found.point[1]);
  const BodyVelocity va = velocityOf(pair.side[0], pair.root, about),
                     vb = velocityOf(pair.side[1], pair.root, about);
  if (!a.convex || !b.convex) {
    const auto speed = [](const Placed& body, const BodyVelocity& v, const Vector3d& point) {
      return v.linear.norm() + v.angular.norm() * ((body.where - point).norm() + body.radius);
    };
    return speedCover(gap, speed(a, va, about) + speed(b, vb, about), va.acceleration + vb.acceleration, most,
                      slack_);
  }
  const auto support = [&](const Placed& body, std::size_t which) {
    return [&body, &about, &found, which](const Vector3d& d) {
      if (body.body.unbounded()) return d.dot(found.point[which] - about);  // it stands still
      const double length = d.norm();
      return length * body.body.support(d / length, found.patch[which]) +
             d.dot(body.body.pose.translation() - about);
    };
  };
  return planeCover(found.normal, gap, support(a, 0), va, support(b, 1), vb, most, slack_);
}

bool MotionCheck::Impl::isFree(const ConstVector& q, double margin) {
  if (!set(q, q) || std::isnan(margin)) return false;
  if (!checker_) return true;
  if (margin != checker_->margin()) checker_->setMargin(margin);
  return !checker_->collides(q);
}

MotionBracket MotionCheck::Impl::firstContact(const ConstVector& q0, const ConstVector& q1,
                                              const MotionRequest& request) {
  if (!begin(q0, q1)) return {MotionVerdict::undecided, 0, 0, -1, 0};
  Scene scene(*this, request.margin);
  return MotionSearch<Scene>(scene, request).run(static_cast<int>(moving_.size()));
}

bool MotionCheck::Impl::closest(const ConstVector& q0, const ConstVector& q1, double precision, double offset,
                                std::vector<Approach>& best) {
  best.resize(moving_.size());
  if (!begin(q0, q1)) return false;
  ApproachScene scene(*this, precision, offset, best);
  MotionRequest request;
  request.tolerance = 1;
  const MotionBracket all = MotionSearch<ApproachScene>(scene, request).run(static_cast<int>(moving_.size()));
  return all.verdict == MotionVerdict::free && !scene.loose;
}

DistanceAnswer MotionCheck::Impl::answer(int pair, const ConstVector& q) {
  if (!set(q, q)) return {};
  place(0);
  const Placed &a = bodies_[at(moving_[at(pair)].side[0].body)],
               &b = bodies_[at(moving_[at(pair)].side[1].body)];
  return distance(*a.geometry, a.body.pose, *b.geometry, b.body.pose, {&moving_[at(pair)].cache, nullptr});
}

MotionCheck::MotionCheck(std::shared_ptr<const Kinematics> kinematics,
                         std::shared_ptr<const RobotGeometry> geometry, std::vector<CheckedPair> pairs,
                         std::vector<Obstacle> obstacles)
    : impl_(std::make_unique<Impl>(std::move(kinematics), std::move(geometry), std::move(pairs),
                                   std::move(obstacles))) {}
MotionCheck::MotionCheck(MotionCheck&&) noexcept = default;
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
