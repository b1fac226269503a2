// Makes the pairs of bodies to check. Pairs of two links: all except those that the SRDF leaves out, or
// without an SRDF all except rigid and adjacent ones. Pairs with obstacles: all bodies of links that move.
#include "fcl_stpbv/robot/checked_pairs.h"

#include <set>

#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/adjacency.h"
#include "fcl_stpbv/robot/bounding_ball.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_check.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

int parentOf(const RobotModel& robot, int link) {
  const int joint = robot.links[static_cast<std::size_t>(link)].parentJoint;
  return joint < 0 ? -1 : robot.joints[static_cast<std::size_t>(joint)].parent;
}

}  // namespace

Obstacle::Obstacle(const std::string& name_, std::shared_ptr<const fcl::CollisionGeometryd> geometry,
                   const Eigen::Isometry3d& pose)
    : name(name_), geometry_(std::move(geometry)) {
  if (!geometry_) throw Error("obstacle '" + name + "': its geometry is null");
  place(pose);
}

void Obstacle::place(const Eigen::Isometry3d& pose) {
  pose_ = pose;
  const bool rigid = makeRigid(pose_);  // as distance() does: bounds take it as it is
  const BoundingBall ball = boundingBall(*geometry_);
  centre_ = pose_ * ball.centre;
  radius_ = rigid ? ball.radius : kInfinity;
}

Obstacle obstacleOf(const fcl::CollisionObjectd& object, const std::string& name) {
  return {name, object.collisionGeometry(), object.getTransform()};
}

std::string nameOf(const CheckedPair& pair, const RobotGeometry& geometry,
                   const std::vector<Obstacle>& obstacles) {
  requireBodies(pair, geometry, obstacles.size(), "nameOf");
  const auto other = static_cast<std::size_t>(pair.other);
  return geometry.bodies[static_cast<std::size_t>(pair.body)].name + " - " +
         (pair.obstacle ? obstacles[other].name : geometry.bodies[other].name);
}

void requireBodies(const CheckedPair& pair, const RobotGeometry& geometry, std::size_t obstacles,
                   const std::string& who) {
  const auto exists = [](int index, std::size_t count) {
    return index >= 0 && static_cast<std::size_t>(index) < count;
  };
  if (!exists(pair.body, geometry.bodies.size()) ||
      !exists(pair.other, pair.obstacle ? obstacles : geometry.bodies.size()))
    throw Error(who + ": a pair names a body or an obstacle that does not exist");
  if (!pair.obstacle && pair.body == pair.other)
    throw Error(who + ": a pair names a body twice; nothing keeps it from itself");
}

LinkPair linksOf(const CheckedPair& pair, const RobotGeometry& geometry) {
  const auto linkOf = [&](int body) { return geometry.bodies[static_cast<std::size_t>(body)].link; };
  return {linkOf(pair.body), pair.obstacle ? pair.other : linkOf(pair.other), pair.obstacle};
}

PairedBodies detail::pairedBodies(const std::vector<CheckedPair>& pairs, const RobotGeometry& geometry) {
  std::set<int> bodies, links, obstacles;
  const auto add = [&](int body) {
    bodies.insert(body);
    links.insert(geometry.bodies[static_cast<std::size_t>(body)].link);
  };
  for (const CheckedPair& pair : pairs) {
    add(pair.body);
    if (pair.obstacle)
      obstacles.insert(pair.other);
    else
      add(pair.other);
  }
  return {{bodies.begin(), bodies.end()}, {links.begin(), links.end()}, {obstacles.begin(), obstacles.end()}};
}

std::vector<Obstacle> obstaclesOf(std::shared_ptr<const RobotModel> scene, const RobotGeometry& geometry) {
  const Kinematics kinematics(std::move(scene));
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(kinematics.neutral(), state);
  std::vector<Obstacle> obstacles;
  for (const Body& body : geometry.bodies) {
    const Eigen::Isometry3d& link = state.link[static_cast<std::size_t>(body.link)];
    obstacles.emplace_back(body.name, body.geometry, link * body.pose);
    obstacles.back().primitive = body.primitive;
    obstacles.back().full = body.full;
    obstacles.back().volumeExcess = body.volumeExcess;
  }
  return obstacles;
}

std::vector<CheckedPair> selfPairs(const RobotModel& robot, const RobotGeometry& geometry, const Srdf* srdf) {
  std::vector<CheckedPair> pairs;
  const int count = static_cast<int>(geometry.bodies.size());
  const Adjacency adjacency(robot, geometry);
  const SkipReasons reasons(srdf);
  const auto linkOf = [&](int body) { return geometry.bodies[static_cast<std::size_t>(body)].link; };
  const auto nameOf = [&](int body) { return robot.links[static_cast<std::size_t>(linkOf(body))].name; };
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      if (linkOf(i) == linkOf(j)) continue;
      const bool inParts = geometry.byParts.count({linkOf(i), linkOf(j)}) > 0;
      if (!geometry.counts(i, inParts) || !geometry.counts(j, inParts)) continue;
      const bool skip = srdf ? !reasons.of(nameOf(i), nameOf(j)).empty()
                             : adjacency.of(linkOf(i), linkOf(j)) != Joining::separate;
      if (!skip) pairs.push_back({i, j, false});
    }
  }
  return pairs;
}

std::vector<CheckedPair> pairsOfLinks(const RobotGeometry& geometry, int link1, int link2) {
  std::vector<CheckedPair> pairs;
  const auto [first1, last1] = geometry.of(link1);
  const auto [first2, last2] = geometry.of(link2);
  const bool inParts = geometry.byParts.count({link1, link2}) > 0;
  for (int i = first1; i < last1; ++i)
    for (int j = first2; j < last2; ++j)
      if (geometry.counts(i, inParts) && geometry.counts(j, inParts)) pairs.push_back({i, j, false});
  return pairs;
}

std::vector<CheckedPair> pairsWithObstacle(const RobotGeometry& geometry, int link, int obstacle) {
  std::vector<CheckedPair> pairs;
  const auto [first, last] = geometry.of(link);
  const bool inParts = geometry.byParts.count({link, obstacle, true}) > 0;
  for (int i = first; i < last; ++i)
    if (geometry.counts(i, inParts)) pairs.push_back({i, obstacle, true});
  return pairs;
}

std::vector<CheckedPair> bodiesOf(const RobotGeometry& geometry, const LinkPair& pair) {
  return pair.obstacle ? pairsWithObstacle(geometry, pair.link1, pair.link2)
                       : pairsOfLinks(geometry, pair.link1, pair.link2);
}

void requirePairs(std::size_t checked, const RobotModel& robot, const std::string& why) {
  if (checked > 0) return;
  throw Error(
      robot.path + ": no pair of bodies is checked (" +
      (why.empty() ? "fewer than two links have a body" : why) +
      "), so that nothing can be said about collisions; give an SRDF that leaves pairs to be checked, or "
      "obstacles and a link that moves");
}

bool moves(const RobotModel& robot, int link, bool baseMoves) {
  detail::requireLink("moves", link, robot);
  for (int at = link; !baseMoves && at >= 0; at = parentOf(robot, at)) {
    const int joint = robot.links[static_cast<std::size_t>(at)].parentJoint;
    if (joint >= 0 && robot.joints[static_cast<std::size_t>(joint)].type != JointType::fixed) return true;
  }
  return baseMoves;
}

std::vector<CheckedPair> obstaclePairs(const RobotModel& robot, const RobotGeometry& geometry,
                                       std::size_t obstacles, bool baseMoves) {
  std::vector<CheckedPair> pairs;
  for (std::size_t i = 0; i < geometry.bodies.size(); ++i) {
    if (!moves(robot, geometry.bodies[i].link, baseMoves)) continue;
    for (int body = static_cast<int>(i), o = 0; o < static_cast<int>(obstacles); ++o)
      if (geometry.counts(body, geometry.byParts.count({geometry.bodies[i].link, o, true}) > 0))
        pairs.push_back({body, o, true});
  }
  return pairs;
}

}  // namespace fcl_stpbv
