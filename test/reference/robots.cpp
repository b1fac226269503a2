// Loads robots without a cache, with all pairs except those that the SRDF leaves out or those of adjacent
// links. Draws random configurations.
#include "test/reference/robots.h"

#include <algorithm>
#include <map>

namespace fcl_stpbv::test {

LoadedRobot load(const TestRobot& robot) {
  static std::map<std::string, LoadedRobot> known;  // by URDF
  const auto before = known.find(robot.urdf);
  if (before != known.end()) return before->second;
  GeometryOptions options;
  options.packagePath = robot.packagePath;
  options.cacheFolder.clear();
  auto model = std::make_shared<const RobotModel>(loadUrdf(robot.urdf));
  RobotGeometry geometry = loadGeometry(*model, options);
  return known[robot.urdf] = {model, std::move(geometry)};
}

LoadedRobot parsed(const std::string& urdf, GeometryOptions options) {
  options.cacheFolder.clear();
  auto model = std::make_shared<const RobotModel>(parseUrdf(urdf, "small.urdf"));
  RobotGeometry geometry = loadGeometry(*model, options);
  return {model, std::move(geometry)};
}

Problem problem(const TestRobot& robot, BaseMotion base) {
  LoadedRobot loaded = load(robot);
  Problem p;
  p.model = loaded.model;
  p.kinematics = std::make_shared<const Kinematics>(loaded.model, base);
  p.geometry = std::make_shared<const RobotGeometry>(std::move(loaded.geometry));
  if (robot.srdf.empty()) {
    p.pairs = selfPairs(*p.model, *p.geometry, nullptr);
  } else {
    const Srdf srdf = loadSrdf(robot.srdf, *p.model);
    p.pairs = selfPairs(*p.model, *p.geometry, &srdf);
  }
  return p;
}

Problem smoothProblem(const TestRobot& robot) {
  Problem p = problem(robot);
  requirePairs(p.pairs.size(), *p.model, "those of the SRDF and adjacent ones are left out");
  RobotGeometry covered = *p.geometry;
  coverPrimitives(p.pairs, covered);
  p.geometry = std::make_shared<const RobotGeometry>(std::move(covered));
  return p;
}

Body smoothBody(int link, const std::string& name, const StpBv::Ptr& volume, const Eigen::Isometry3d& pose) {
  Body body;
  body.link = link;
  body.name = name;
  body.pose = pose;
  body.volume = volume;
  body.geometry = std::make_shared<StpBvGeometry>(volume);
  body.centre = pose * volume->centre();
  body.radius = volume->enclosingRadius();
  return body;
}

std::unique_ptr<CollisionConstraints> singleRow(std::shared_ptr<const Kinematics> kinematics,
                                                const Body& body, const fcl::CollisionObjectd& obstacle,
                                                ConstraintOptions options) {
  auto geometry = std::make_shared<RobotGeometry>();
  geometry->bodies = {body};
  options.obstacles = {obstacleOf(obstacle, "obstacle")};
  return std::make_unique<CollisionConstraints>(std::move(kinematics), geometry,
                                                std::vector<CheckedPair>{{0, 0, true}}, std::move(options));
}

SmoothConstraint product() {
  SmoothConstraint constraint;
  constraint.name = "product";
  constraint.coordinates = {2, 5};
  constraint.value = [](const Eigen::Ref<const Eigen::VectorXd>& q, double* gradient) {
    if (gradient) {
      gradient[0] = q[5] * q[5];
      gradient[1] = 2 * q[2] * q[5];
    }
    return q[2] * q[5] * q[5];
  };
  return constraint;
}

Eigen::VectorXd randomConfiguration(const Kinematics& kinematics, Random& random) {
  Eigen::VectorXd q(kinematics.size());
  for (int i = 0; i < kinematics.size(); ++i)
    q[i] = random.uniform(std::max(kinematics.lower()[i], -1.0), std::min(kinematics.upper()[i], 1.0));
  return q;
}

Eigen::VectorXd randomDirection(Eigen::Index size, Random& random) {
  Eigen::VectorXd v(size);
  for (Eigen::Index i = 0; i < size; ++i) v[i] = random.normal();
  return v.normalized();
}

}  // namespace fcl_stpbv::test
