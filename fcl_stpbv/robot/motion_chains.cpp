// Motion of the bodies along a straight line between two configurations:
// 1. Once for a robot: find the joints from the link where a pair's chains meet out to each of its bodies.
// 2. Once for a motion: compute the joints' speeds and the lengths beyond them. They give a bound on the
//    acceleration of every point of a body: the centripetal acceleration of each joint, and the Coriolis
//    acceleration from the joints nearer to the root.
// 3. For a time: compute poses and velocities of all links by the kinematics.
#include "fcl_stpbv/robot/motion_chains.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/bounding_ball.h"
#include "fcl_stpbv/robot/joint_path.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

}  // namespace

MotionChains::MotionChains(const Kinematics& kinematics, const RobotGeometry& geometry,
                           const std::vector<Obstacle>& obstacles, const std::vector<CheckedPair>& pairs)
    : kinematics_(kinematics), state_(kinematics.makeState()) {
  const RobotModel& robot = kinematics_.robot();
  parent_.assign(robot.links.size(), -1);
  own_.resize(robot.links.size());
  twist_.resize(robot.links.size());
  hop_.resize(robot.joints.size() + 1);
  motionOf_.assign(hop_.size(), -1);
  for (std::size_t l = 0; l < robot.links.size(); ++l)
    if (robot.links[l].parentJoint >= 0) parent_[l] = robot.joints[at(robot.links[l].parentJoint)].parent;
  const auto& motions = kinematics_.motions();
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const int joint = motions[m].joint;
    own_[joint < 0 ? 0 : at(robot.joints[at(joint)].child)].push_back(static_cast<int>(m));
    int& first = motionOf_[joint < 0 ? robot.joints.size() : at(joint)];
    if (first < 0) first = static_cast<int>(m);
  }
  addBodies(geometry, obstacles);
  for (const CheckedPair& pair : pairs) {
    requireBodies(pair, geometry, obstacles.size(), "MotionCheck");
    addPair(pair, static_cast<int>(geometry.bodies.size()));
  }
  std::vector<BodyReach> reaches;
  for (const Pair& pair : pairs_)
    for (const Side& side : pair.side) {
      const Placed& placed = body(side);
      reaches.push_back(reachOf(placed.link, placed.local, placed.centre, placed.radius));
    }
  rounding_ = PoseRounding(kinematics_, reaches);
}

void MotionChains::addBodies(const RobotGeometry& geometry, const std::vector<Obstacle>& obstacles) {
  const auto add = [&](int link, const fcl::CollisionGeometryd& shape, const Eigen::Isometry3d& pose,
                       const Vector3d& centre, double radius) {
    Placed placed{link, &shape, pose, centre, radius, hasFiniteCorners(shape), false, {}};
    placed.convex = isConvex(shape, placed.body);
    placed.body.pose = pose;
    placed.where = centre;
    bodies_.push_back(placed);
  };
  for (const Body& body : geometry.bodies) {
    const BoundingBall ball = boundingBall(body);
    add(body.link, *body.geometry, body.pose, ball.centre, ball.radius);
  }
  for (const Obstacle& obstacle : obstacles)
    add(-1, *obstacle.geometry(), obstacle.pose(), obstacle.centre(), obstacle.radius());
}

void MotionChains::addPair(const CheckedPair& pair, int bodies) {
  const int second = pair.other + (pair.obstacle ? bodies : 0);
  Pair added{};
  added.root = -1;
  if (!pair.obstacle) {
    const int link1 = bodies_[at(pair.body)].link, link2 = bodies_[at(second)].link;
    const JointPath path = jointPath(kinematics_.robot(), link1, link2);
    added.root = path.up > 0 ? kinematics_.robot().joints[at(path.joints[path.up - 1])].parent : link1;
  }
  added.side[0] = sideOf(pair.body, added.root);
  added.side[1] = sideOf(second, added.root);
  pairs_.push_back(added);
}

// The joints from `root` out to the body's link. If the root is the world, the base counts as one more joint.
MotionChains::Side MotionChains::sideOf(int body, int root) {
  Side side{body, static_cast<int>(hops_.size()), 0};
  for (int link = bodies_[at(body)].link; link >= 0 && link != root; link = parent_[at(link)]) {
    const int joint = kinematics_.robot().links[at(link)].parentJoint;
    hops_.push_back(joint >= 0 ? joint : static_cast<int>(hop_.size()) - 1);
  }
  std::reverse(hops_.begin() + side.firstHop, hops_.end());
  side.lastHop = static_cast<int>(hops_.size());
  return side;
}

bool MotionChains::set(const ConstVector& q0, const ConstVector& q1) {
  if (q0.size() != kinematics_.size() || q1.size() != q0.size() || !q0.allFinite() || !q1.allFinite())
    return false;
  q0_ = q0;
  way_ = q1 - q0;
  return true;
}

// Speeds and lengths of all joints for the motion, then the bounds of all pairs.
bool MotionChains::begin(const ConstVector& q0, const ConstVector& q1) {
  if (!set(q0, q1)) return false;
  const RobotModel& robot = kinematics_.robot();
  reach_ = 0;
  double slid = 0, turned = 0;  // sums of |q0| + |q1| over what slides (m) and what turns (rad)
  for (std::size_t j = 0; j < hop_.size(); ++j) {
    const bool base = j == robot.joints.size();
    Hop& hop = hop_[j] = {};
    hop.length = base ? 0 : robot.joints[j].origin.translation().norm();
    if (motionOf_[j] < 0) continue;
    const Kinematics::Motion& motion = kinematics_.motions()[at(motionOf_[j])];
    const Index k = motion.coordinate;
    std::size_t freedoms = 0;
    for (const Kinematics::Motion& other : kinematics_.motions()) freedoms += other.joint == motion.joint;
    const auto farthest = [&](Index count) {
      return std::max(q0.segment(k, count).norm(), q1.segment(k, count).norm());
    };
    const auto both = [&](Index from, Index count) {
      return q0.segment(from, count).norm() + q1.segment(from, count).norm();
    };
    if (freedoms == 1) {
      const bool slides = robot.joints[j].type == JointType::prismatic;
      (slides ? hop.slide : hop.spin) = std::abs(motion.multiplier * way_[k]);
      (slides ? slid : turned) += std::abs(motion.multiplier) * both(k, 1);
      const std::optional<Mimic>& mimic = robot.joints[j].mimic;
      if (slides)
        hop.length += std::abs(motion.multiplier) * farthest(1) + (mimic ? std::abs(mimic->offset) : 0);
    } else {
      const Index across = freedoms == 3 ? 2 : 3;
      hop.slide = way_.segment(k, across).norm();
      const Index round = static_cast<Index>(freedoms) - across;
      hop.spin = way_.segment(k + across, round).norm();
      slid += both(k, across);
      turned += both(k + across, round);
      // A rotation vector that moves evenly turns the body unevenly: |dw/dt|
      // <= |dr/dt|^2 / 2 (docs/motion.md).
      if (freedoms == 6) hop.turns = 1.5;
      hop.length += farthest(across);
    }
    reach_ = std::max(reach_, hop.length + hop.slide);
  }
  for (Pair& pair : pairs_)
    for (Side& side : pair.side) prepare(side);
  // q at a time is q0 + t (q1 - q0), with three roundings of at most |q0| + |q1|, and the time is rounded
  // too. Both bodies of a pair move by it.
  wayRounding_ = 4 * std::numeric_limits<double>::epsilon() * (slid + turned * longestLever());
  return true;
}

// No point of a body is farther from a joint that turns it.
double MotionChains::longestLever() const {
  double lever = 0;
  for (const Placed& placed : bodies_) {
    const double reach = placed.centre.norm() + placed.radius;
    if (std::isfinite(reach)) lever = std::max(lever, reach);
  }
  for (std::size_t j = 0; j + 1 < hop_.size(); ++j) lever += hop_[j].length;
  return lever;
}

// Goes from the outermost joint inwards. Each joint adds its own centripetal acceleration, and the Coriolis
// acceleration from the joints nearer to the root, which turn what it moves.
void MotionChains::prepare(Side& side) const {
  const Placed& body = bodies_[at(side.body)];
  side.acceleration = 0;
  side.steady = true;
  if (body.link < 0) return;
  if (body.convex && body.body.unbounded()) {  // if it turns, no bound holds for all its points
    for (int h = side.firstHop; h < side.lastHop; ++h)
      if (hop_[at(hops_[at(h)])].spin > 0) side.acceleration = kInfinity;
    return;
  }
  double inner = 0;
  for (int h = side.firstHop; h < side.lastHop; ++h) {
    const Hop& hop = hop_[at(hops_[at(h)])];
    side.steady &= !(hop.spin > 0) || (!(inner > 0) && hop.turns == 1);
    inner += hop.spin;
  }
  double lever = body.centre.norm() + body.radius;
  for (int h = side.lastHop; h-- > side.firstHop;) {
    const Hop& hop = hop_[at(hops_[at(h)])];
    inner = std::max(0.0, inner - hop.spin);
    side.acceleration += hop.turns * hop.spin * hop.spin * lever + 2 * (hop.slide + hop.spin * lever) * inner;
    lever += hop.length;
  }
}

void MotionChains::place(double t) {
  q_ = q0_ + t * way_;
  kinematics_.forward(q_, state_);
  for (std::size_t l = 0; l < twist_.size(); ++l) {
    twist_[l] = parent_[l] >= 0 ? twist_[at(parent_[l])] : Twist{};
    for (const int m : own_[l]) {
      const double speed = way_[kinematics_.motions()[at(m)].coordinate];
      twist_[l].linear += speed * state_.motion[at(m)].linear;
      twist_[l].angular += speed * state_.motion[at(m)].angular;
    }
  }
  double length = reach_, spin = 0;
  for (Placed& body : bodies_) {
    if (body.link >= 0) {
      const Eigen::Isometry3d& link = state_.link[at(body.link)];
      body.body.pose = link * body.local;
      body.where = link * body.centre;
      spin = std::max(spin, twist_[at(body.link)].angular.norm());
    }
    // A half space has no bounding ball. Its support is evaluated at the other body.
    const double reach = body.where.lpNorm<1>() + body.radius;
    length = std::max(length, std::isfinite(reach) ? reach : body.body.pose.translation().lpNorm<1>());
  }
  // Each product and sum on the way from the root to a bound is rounded by a few units in the last place of
  // the longest length. The links' poses, and the velocities that follow from them, have a bound of their
  // own.
  const double steps = static_cast<double>(hop_.size() + 16);
  const double sums = 16 * std::numeric_limits<double>::epsilon() * steps * length;
  slack_ = (sums + 2 * rounding_.most(q_)) * (1 + spin) + wayRounding_;
}

BodyVelocity MotionChains::velocityOf(const Pair& pair, int side, const Vector3d& about) const {
  const Side& of = pair.side[side];
  const int link = body(of).link;
  if (link < 0) return {};
  Twist twist = twist_[at(link)];
  if (pair.root >= 0) {
    twist.linear -= twist_[at(pair.root)].linear;
    twist.angular -= twist_[at(pair.root)].angular;
  }
  return {twist.linear + twist.angular.cross(about), twist.angular, of.acceleration, of.steady};
}

}  // namespace fcl_stpbv::detail
