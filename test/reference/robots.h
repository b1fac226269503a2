// The robots that tests run on: the one in data/, and public ones beside the project where they are there.
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

/// hrp2_style, and JVRC-1 and Panda where ../shared holds them; says so where it does not.
std::vector<TestRobot> robots();

struct LoadedRobot {
  std::shared_ptr<const RobotModel> model;
  RobotGeometry geometry;
};

/// Without a cache, so that tests leave nothing behind.
LoadedRobot load(const TestRobot& robot, GeometryOptions options = {});

/// What CollisionConstraints needs: all pairs but those of the SRDF, or of adjacent links.
struct Problem {
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const RobotGeometry> geometry;
  std::vector<CheckedPair> pairs;
};
Problem problem(const TestRobot& robot, BaseMotion base = BaseMotion::fixed);

/// A body of one volume in its link's frame.
Body smoothBody(int link, const std::string& name, const StpBv::Ptr& volume,
                const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity());

/// One body of a robot and one obstacle, a single row.
std::unique_ptr<CollisionConstraints> singleRow(std::shared_ptr<const Kinematics> kinematics,
                                                const Body& body, const fcl::CollisionObjectd& obstacle,
                                                ConstraintOptions options = {});

/// Within the limits and 1 rad or m around zero.
Eigen::VectorXd randomConfiguration(const Kinematics& kinematics, Random& random);
Eigen::VectorXd randomDirection(Eigen::Index size, Random& random);

}  // namespace fcl_stpbv::test
