// 1. Draw a pair of links, or a link and an obstacle, and a box of joint values.
// 2. The library bounds the distance over the box.
// 3. Compute the distance at the box's middle, at corners and in between. A distance below the bound is a
// violation.
#include "test/robot/bound_trials.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/sphere.h>

#include <cmath>
#include <utility>

#include "fcl_stpbv/robot/adjacency.h"
#include "fcl_stpbv/robot/pair_search.h"
#include "test/reference/robots.h"
#include "test/robot/urdf_texts.h"

namespace fcl_stpbv::test {
namespace {

using namespace detail;

std::string moving(const std::string& name, const std::string& type, const std::string& parent,
                   const std::string& child, const std::string& origin, const std::string& axis,
                   const std::string& more = "") {
  return joint(name, type, parent, child,
               "<origin xyz=\"" + origin + "\" rpy=\"0.3 -0.2 0.5\"/><axis xyz=\"" + axis + "\"/>" + more);
}

}  // namespace

ProofScene proofSceneOf(const std::string& urdf, std::vector<Obstacle> obstacles) {
  LoadedRobot loaded = parsed(urdf);
  return proofScene(std::make_shared<const Kinematics>(loaded.model),
                    std::make_shared<const RobotGeometry>(std::move(loaded.geometry)), std::move(obstacles),
                    0);
}

ProofScene primitiveScene() {
  const std::string text = robot(
      link("base", "<box size=\"0.3 0.2 0.1\"/>") +
      link("rail", "<cylinder radius=\"0.06\" length=\"0.4\"/>") +
      link("arm", "<capsule radius=\"0.05\" length=\"0.4\"/>") + link("fore", "<box size=\"0.1 0.1 0.4\"/>") +
      link("palm", "<sphere radius=\"0.07\"/>") + link("left", "<box size=\"0.02 0.02 0.1\"/>") +
      link("right", "<box size=\"0.02 0.02 0.1\"/>") +
      moving("turn", "revolute", "base", "rail", "0.2 0 0.3", "0 0 1") +
      moving("slide", "prismatic", "rail", "arm", "0 0.3 0.2", "1 0 0") +
      moving("elbow", "revolute", "arm", "fore", "0.1 0 0.4", "0 1 0.2") +
      moving("wrist", "revolute", "fore", "palm", "0 0 0.4", "1 0 0",
             "<mimic joint=\"elbow\" multiplier=\"-0.8\" offset=\"0.1\"/>") +
      moving("grip1", "prismatic", "palm", "left", "0 0.1 0.1", "0 1 0") +
      moving("grip2", "prismatic", "palm", "right", "0 -0.1 0.1", "0 -1 0", "<mimic joint=\"grip1\"/>"));
  const auto obstacle = [](auto geometry, double x, double y, double z) {
    fcl::CollisionObjectd object(geometry);
    object.setTranslation(Eigen::Vector3d(x, y, z));
    return obstacleOf(object, "obstacle");
  };
  return proofSceneOf(
      text, {obstacle(std::make_shared<fcl::Sphered>(0.2), 1, 0.5, 0.5),
             obstacle(std::make_shared<fcl::Boxd>(0.3, 0.4, 0.5), -0.5, 0.8, 0.2),
             obstacle(std::make_shared<StpBvGeometry>(StpBv::build(geodesicSphere(0.2, 2))), 0.2, -1, 0.9)});
}

std::vector<LinkPair> movingPairs(const ProofScene& scene) {
  const RobotModel& robot = scene.kinematics->robot();
  const Adjacency adjacency(robot, *scene.geometry);
  const auto hasBody = [&](int link) {
    return scene.geometry->of(link).first < scene.geometry->of(link).second;
  };
  std::vector<LinkPair> pairs;
  const int links = static_cast<int>(robot.links.size());
  for (int i = 0; i < links; ++i) {
    if (!hasBody(i)) continue;
    for (int j = i + 1; j < links; ++j)
      if (hasBody(j) && adjacency.of(i, j) != Joining::rigid) pairs.push_back({i, j});
    for (int o = 0; o < static_cast<int>(scene.obstacles.size()); ++o)
      if (moves(robot, i)) pairs.push_back({i, o, true});
  }
  return pairs;
}

BoundTrials tryBounds(const ProofScene& scene, const std::vector<LinkPair>& pairs, int boxes,
                      Random& random) {
  constexpr int kSamples = 8;
  BoundTrials trials;
  const Kinematics& kinematics = *scene.kinematics;
  for (int b = 0; b < boxes; ++b) {
    const LinkPair& pair = pairs[static_cast<std::size_t>(random.below(static_cast<int>(pairs.size())))];
    PairSearch search(scene.kinematics, scene.geometry, pair, scene.obstacles);
    const std::vector<int>& coordinates = search.coordinates();
    const auto size = static_cast<Eigen::Index>(coordinates.size());
    JointBox box{Eigen::VectorXd(size), Eigen::VectorXd(size)};
    const double scale = std::pow(10, random.uniform(-3, 0));  // scale of the ranges
    for (Eigen::Index k = 0; k < size; ++k) {
      const int c = coordinates[static_cast<std::size_t>(k)];
      const double low = kinematics.lower()[c], range = kinematics.upper()[c] - low;
      const double width = range * scale * random.uniform(0, 1);
      box.lower[k] = low + random.uniform(0, range - width);
      box.upper[k] = box.lower[k] + width;
    }
    const double bound = distanceBound(scene, pair, box);
    Eigen::VectorXd q = kinematics.neutral();
    for (int s = 0; s < kSamples; ++s) {
      for (Eigen::Index k = 0; k < size; ++k) {
        // First the middle, then half of the samples at corners.
        const double part = s == 0 ? 0.5 : s % 2 ? random.below(2) : random.uniform(0, 1);
        q[coordinates[static_cast<std::size_t>(k)]] = box.lower[k] + part * (box.upper[k] - box.lower[k]);
      }
      const double d = search.distance(q);
      ++trials.samples;
      trials.violations += d < bound;
      trials.tightest = std::min(trials.tightest, d - bound);
      if (s == 0) trials.useful += d > 0 && bound > d / 2;
    }
  }
  trials.useful /= boxes;
  return trials;
}

}  // namespace fcl_stpbv::test
