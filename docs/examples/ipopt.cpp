// Finds the allowed posture that is closest to a desired one, by IPOPT with exact second derivatives: the
// left hand lays a box onto a table. R starts small and grows (continuation, docs/optimise.md). Run it in
// data/hrp2_style.
#include <fcl/geometry/shape/box.h>

#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <cstdio>

#include "docs/examples/closest_posture.h"
#include "docs/examples/held_box.h"
#include "docs/examples/reported.h"

using namespace fcl_stpbv;
using Eigen::VectorXd;

namespace {

/// The box in the left hand, as the robot's only body.
std::shared_ptr<const RobotGeometry> heldBox(const BentArms& robot, double R) {
  auto geometry = std::make_shared<RobotGeometry>();
  geometry->bodies = {robot.box("LARM", 0.16, {0.14, 0.10, 0.06}, {0.01, R})};
  return geometry;
}

/// A table whose top is 9 cm below the box's centre.
Obstacle tableUnder(const Body& box, const BentArms& robot) {
  Kinematics::State state = robot.kinematics->makeState();
  robot.kinematics->forward(robot.start, state);
  const Eigen::Vector3d centre = state.link[static_cast<std::size_t>(box.link)] * box.pose.translation();
  return {"table", std::make_shared<fcl::Boxd>(0.6, 0.8, 0.3),
          Eigen::Isometry3d(Eigen::Translation3d(centre - Eigen::Vector3d(0, 0, 0.24)))};
}

int run() {
  const BentArms robot;
  ConstraintOptions options;
  options.obstacles = {tableUnder(heldBox(robot, 10)->bodies[0], robot)};
  VectorXd q = robot.start, wanted = q;
  robot.joint(wanted, "LARM", 0) = -0.4;  // the box is inside the table
  robot.joint(wanted, "LARM", 3) = -0.9;

  bool solved = true;
  // clang-format off
for (double R : {0.3, 1.0, 3.0, 10.0}) {             // m; each from the solution before
  CollisionConstraints rows(robot.kinematics, heldBox(robot, R), {{0, 0, true}}, options);
  Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt = new Ipopt::IpoptApplication();
  ipopt->Options()->SetIntegerValue("print_level", 0);
  ipopt->Options()->SetStringValue("sb", "yes");
  if (R > 0.3)                                       // stay at the rows, with the last barrier
    for (const char* option : {"mu_init", "bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac"})
      ipopt->Options()->SetNumericValue(option, 1e-6);
  ipopt->Initialize();
  Ipopt::SmartPtr<Ipopt::TNLP> closest = new ClosestPosture(rows, *robot.kinematics, wanted, q);
  solved = solved && ipopt->OptimizeTNLP(closest) == Ipopt::Solve_Succeeded;
    // clang-format on
    VectorXd d(1);
    rows.evaluate(q, d);
    std::printf("R = %4g m: %2d iterations, distance %.1e m, %.4f rad from the wanted posture\n", R,
                ipopt->Statistics()->IterationCount(), d[0], (q - wanted).norm());
    solved = solved && d[0] >= -1e-7;
  }
  return solved ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) { return reported(argc, argv, run); }
