// A lower bound on the distance of a pair over a box of joint values (docs/proofs.md: levers and planes).
// 1. Take the distance at the box's middle, minus the sum over the coordinates of the Lipschitz constant
//    times half the box's width.
// 2. Where that does not decide, take planes between the bodies, and bound how far the bodies' points move
//    along their normals.
#include "fcl_stpbv/robot/box_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/joint_path.h"

namespace fcl_stpbv::detail {

using Eigen::Index;
using Eigen::Vector3d;

namespace {

constexpr double kEps = std::numeric_limits<double>::epsilon();
constexpr double kNotKnown = std::numeric_limits<double>::lowest();  // PairSearch's, of poses too far to tell

void requirePair(const ProofScene& scene, const LinkPair& pair) {
  const auto hasBody = [&](int link) {
    return std::any_of(scene.geometry->bodies.begin(), scene.geometry->bodies.end(),
                       [&](const Body& body) { return body.link == link; });
  };
  const bool obstacle = pair.link2 >= 0 && static_cast<std::size_t>(pair.link2) < scene.obstacles.size();
  if (!hasBody(pair.link1) || !(pair.obstacle ? obstacle : hasBody(pair.link2)))
    throw Error("a proof needs two links that have bodies, or a link and an obstacle");
}

void moveInto(const BodyPoints& body, const Eigen::Isometry3d& pose, BodyPoints& moved) {
  moved.points.resize(body.points.size());
  for (std::size_t i = 0; i < body.points.size(); ++i) moved.points[i] = pose * body.points[i];
  moved.centre = pose * body.centre;
  moved.radius = body.radius;
  moved.reach = body.reach;
}

// The coordinate of a joint, or of the one that it mimics.
int coordinateOf(const Kinematics& kinematics, const JointModel& joint) {
  const std::vector<JointModel>& joints = kinematics.robot().joints;
  return kinematics.coordinate(joint.mimic ? joints[at(joint.mimic->joint)].name : joint.name);
}

// Its place among the pair's coordinates; -1 if it is none of them.
int slotOf(const PairSearch& search, int coordinate) {
  const std::vector<int>& own = search.coordinates();
  const auto found = std::find(own.begin(), own.end(), coordinate);
  return found == own.end() ? -1 : static_cast<int>(found - own.begin());
}

}  // namespace

PairSearch searchOf(const ProofScene& scene, const LinkPair& pair) {
  requirePair(scene, pair);
  return {scene.kinematics, scene.geometry, pair, scene.obstacles};
}

BoxBound::BoxBound(const ProofScene& scene, const LinkPair& pair)
    : scene_(scene), pair_(pair), search_(searchOf(scene, pair)), q_(scene.kinematics->neutral()) {
  const RobotModel& robot = scene.kinematics->robot();
  const JointPath path = jointPath(robot, pair.link1, pair.obstacle ? 0 : pair.link2);
  for (std::size_t i = 0; i < path.joints.size(); ++i) {
    const JointModel& joint = robot.joints[at(path.joints[i])];
    if (joint.type == JointType::fixed || (joint.mimic && joint.mimic->multiplier == 0)) continue;
    BoxJoint box;
    box.slides = joint.type == JointType::prismatic;
    box.up = i < path.up;
    if (joint.mimic) box.rate = joint.mimic->multiplier;
    box.slot = slotOf(search_, coordinateOf(*scene.kinematics, joint));
    joints_.push_back(box);
    models_.push_back(&joint);
  }
  addHops(pair.link1);
  if (!pair.obstacle) addHops(pair.link2);
  addBalls();
  lipschitz_ = Eigen::Map<const Eigen::VectorXd>(search_.lipschitz().data(),
                                                 static_cast<Index>(search_.lipschitz().size()));
}

void BoxBound::addHops(int link) {
  const RobotModel& robot = scene_.kinematics->robot();
  for (const int j : jointPath(robot, link, 0).joints) {
    Hop hop{&robot.joints[at(j)]};
    if (hop.joint->type == JointType::prismatic) {
      hop.coordinate = coordinateOf(*scene_.kinematics, *hop.joint);
      hop.slot = slotOf(search_, hop.coordinate);
    }
    hops_.push_back(hop);
  }
}

// A half space or a plane has no ball, and needs none: only its own numbers are rounded.
void BoxBound::addBalls() {
  for (const CheckedPair& pair : search_.constraints().pairs())
    for (const int b : {pair.body, pair.obstacle ? pair.body : pair.other}) {
      const Body& body = scene_.geometry->bodies[at(b)];
      balls_.emplace_back(body.link, boundingBall(body));
    }
  if (!pair_.obstacle) return;
  const Obstacle& obstacle = scene_.obstacles[at(pair_.link2)];
  Shape shape;
  obstacleReach_ = shapeOf(*obstacle.geometry(), shape) && shape.unbounded()
                       ? obstacle.pose().translation().norm() + std::abs(shape.offset)
                       : reachOf(obstacle);
}

BoxBound::Verdict BoxBound::look(const JointBox& box) {
  ask(box);
  if (!(distance_ > kNotKnown)) return Verdict::unclear;
  if (distance_ <= scene_.margin) return Verdict::collision;
  return bound(scene_.margin) > scene_.margin ? Verdict::clear : Verdict::unclear;
}

double BoxBound::lowerBound(const JointBox& box) {
  ask(box);
  return bound(kInfinity);
}

// The distances in the box's middle.
void BoxBound::ask(const JointBox& box) {
  const Eigen::VectorXd middle = middleOf(box);
  // Rounded up: the differences are off by half a unit in the last place of the limits.
  half_ = (box.upper - middle).cwiseMax(middle - box.lower) * (1 + 4 * kEps);
  for (Index k = 0; k < middle.size(); ++k)
    q_[search_.coordinates()[static_cast<std::size_t>(k)]] = middle[k];
  cuts_ = (box.lower.array() < middle.array() && middle.array() < box.upper.array()).cast<double>();
  chooseCut(half_);
  search_.forget();
  distance_ = search_.distance(q_);
  place();
  leversHold_ = std::all_of(joints_.begin(), joints_.end(), [&](const BoxJoint& joint) {
    const int k = search_.coordinates()[at(joint.slot)];
    return !joint.slides || (box.lower[joint.slot] >= scene_.kinematics->lower()[k] &&
                             box.upper[joint.slot] <= scene_.kinematics->upper()[k]);
  });
}

// Lower bound on the distance all over the box: the cheap one, and where that is not above
// `enough` that of planes. Ends with the first pair of bodies that no bound takes above
// `enough`; cut() is the coordinate to cut then.
double BoxBound::bound(double enough) {
  const CollisionConstraints& rows = search_.constraints();
  const Eigen::VectorXd share = lipschitz_.cwiseProduct(half_);
  const double cheap = leversHold_ ? share.sum() : kInfinity;
  double lowest = kInfinity;
  for (int row = 0; row < rows.rows(); ++row) {
    const DistanceAnswer answer = rows.answer(row);
    double found = answer.lower - cheap - slack_;
    share_ = share;
    if (found <= enough)
      found = std::max(found, planeBound(rows.pairs()[at(row)], answer, enough + slack_) - slack_);
    lowest = std::min(lowest, found);
    if (found > enough || enough == kInfinity) continue;
    chooseCut(share_);
    break;
  }
  return lowest;
}

void BoxBound::chooseCut(const Eigen::VectorXd& share) {
  cut_ = -1;
  if (share.size() > 0 && !(share.cwiseProduct(cuts_).maxCoeff(&cut_) > 0)) cut_ = -1;
}

// Axes, origins and ranges of the joints in the middle of the box, and slack_: what rounding may have made of
// a bound. Let u be half the unit in the last place of 1, and L the longest way (longestWay()), so that no
// two points are farther apart than 2 L.
// 1. A pose is its parent's times the joint's. The joint's rotation is a sum of three matrices with the
//    factors 1, cos and sin: each entry is off by at most 8 u. Each entry of the product is off by 3 u more.
//    So a rotation is off by at most 33 u, which moves what lies beyond by at most 66 u L. A position is a
//    sum of four terms of at most L together: off by 7 u L. That is less than 40 * 2 u L a joint.
// 2. The angle of a joint that mimics another one is a product and a sum. So it is off by at most 2 u times
//    the sizes of both, which moves what lies beyond by at most 4 u L for each of their radians. The joint
//    may turn by up to 1e6 rad. (The way of a joint that slides is off by 2 u L at most, as L contains it.)
// 3. The bound's own sums have some m^3 terms for m joints between the two, each off by a few u L.
void BoxBound::place() {
  double angles = 0;
  const Kinematics::State& state = search_.constraints().state();
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Eigen::Isometry3d& child = state.link[at(models_[i]->child)];
    joints_[i].axis = child.linear() * models_[i]->axis;
    joints_[i].origin = child.translation();
    joints_[i].half = half_[joints_[i].slot] * std::abs(joints_[i].rate) * (1 + kEps);
    if (!models_[i]->mimic || joints_[i].slides) continue;
    const double middle = q_[search_.coordinates()[at(joints_[i].slot)]];
    angles += std::abs(joints_[i].rate * middle) + joints_[i].half + std::abs(models_[i]->mimic->offset);
  }
  const double m = static_cast<double>(joints_.size()),
               all = static_cast<double>(scene_.kinematics->robot().joints.size());
  slack_ = kEps * (40 * all + 16 * (m * m * m + 16) + 4 * angles) * longestWay();
}

// The largest size of the terms that make up a coordinate on the way from the root to the bodies (m): far
// links may lie before near ones, and a joint that slides may come back from far away, by its origin or by
// the offset of a mimic.
double BoxBound::longestWay() const {
  const Kinematics::State& state = search_.constraints().state();
  double longest = obstacleReach_;
  for (const Hop& hop : hops_) {
    double way =
        state.link[at(hop.joint->parent)].translation().norm() + hop.joint->origin.translation().norm();
    if (hop.coordinate >= 0) {
      const Mimic rule = hop.joint->mimic.value_or(Mimic{0, 1, 0});
      const double most = std::abs(q_[hop.coordinate]) + (hop.slot < 0 ? 0 : half_[hop.slot]);
      way += std::abs(rule.multiplier) * most + std::abs(rule.offset);
    }
    longest = std::max(longest, way);
  }
  for (const auto& [link, ball] : balls_)
    longest = std::max(longest, (state.link[at(link)] * ball.centre).norm() + ball.radius);
  return longest;
}

double BoxBound::planeBound(const CheckedPair& pair, const DistanceAnswer& answer, double enough) {
  const std::optional<BodyPoints>& first = scene_.bodies->robot[at(pair.body)];
  const std::optional<BodyPoints>& second =
      pair.obstacle ? scene_.bodies->obstacles[at(pair_.link2)] : scene_.bodies->robot[at(pair.other)];
  if (!first || !second) return -kInfinity;
  const double least = -mostDepth(*first, *second);
  if (least > enough || answer.normal.isZero()) return least;
  const Kinematics::State& state = search_.constraints().state();
  moveInto(*first, state.link[at(pair_.link1)], first_);
  moveInto(*second, pair.obstacle ? Eigen::Isometry3d::Identity() : state.link[at(pair_.link2)], second_);
  bound_.set(joints_, first_, second_);
  taken_.resize(half_.size());
  taken_.setZero();
  const double found = bound_.gap(answer.normal, answer.points, enough, taken_);
  if (taken_.size() > 0 && taken_.maxCoeff() > 0) share_ = taken_;
  return std::max(found, least);
}

}  // namespace fcl_stpbv::detail
