// The robots for tests: the one in data/, and public ones in a folder beside the project if they are there.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/robot_model.h"
#include "test/reference/shapes.h"

namespace fcl_stpbv::test {

struct TestRobot {
  std::string name, urdf, srdf;  ///< srdf may be ""
  std::vector<std::string> packagePath;
};

/// hrp2_style, and JVRC-1 and Panda if ../shared contains them. Prints a message about those that are
/// missing.
std::vector<TestRobot> robots();

struct LoadedRobot {
  std::shared_ptr<const RobotModel> model;
  RobotGeometry geometry;
};

/// Loads a robot without a cache, so that tests leave no files behind. A program builds each robot's volumes
/// once: later calls share them. From one thread only.
LoadedRobot load(const TestRobot& robot);
/// The robot of a URDF's text, loaded without a cache, too.
LoadedRobot parsed(const std::string& urdf, GeometryOptions options = {});

/// The arguments of CollisionConstraints: all pairs except those that the SRDF leaves out, or those of
/// adjacent links.
struct Problem {
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const RobotGeometry> geometry;
  std::vector<CheckedPair> pairs;
};
Problem problem(const TestRobot& robot, BaseMotion base = BaseMotion::fixed);

/// problem() with smooth covers of the primitives where pairs need them (coverPrimitives()).
Problem smoothProblem(const TestRobot& robot);

/// A body of one volume in its link's frame.
Body smoothBody(int link, const std::string& name, const StpBv::Ptr& volume,
                const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity());

/// Constraints of one body of a robot and one obstacle: a single row.
std::unique_ptr<CollisionConstraints> singleRow(std::shared_ptr<const Kinematics> kinematics,
                                                const Body& body, const fcl::CollisionObjectd& obstacle,
                                                ConstraintOptions options = {});

/// q2 q5^2, as a row of one's own.
SmoothConstraint product();

/// Random, within the limits and within 1 rad or m of zero.
Eigen::VectorXd randomConfiguration(const Kinematics& kinematics, Random& random);
Eigen::VectorXd randomDirection(Eigen::Index size, Random& random);

}  // namespace fcl_stpbv::test
