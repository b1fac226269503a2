// Two arms move the boxes in their hands past each other at 1 kHz, kept apart by a velocity damper: once with
// STP-BVs, once with the boxes themselves and the same margin, whose gradient jumps. Run it in
// data/hrp2_style. It writes controller.csv and controller.html into the given folder.
#include <fcl/geometry/shape/box.h>

#include "docs/examples/controller_page.h"
#include "docs/examples/held_box.h"
#include "docs/examples/reported.h"
#include "fcl_stpbv/robot/velocity_damper.h"

using namespace fcl_stpbv;
using Eigen::VectorXd;

namespace {

constexpr double kPeriod = 1e-3, kDuration = 6;  // s
constexpr double kr = 0.01, kR = 10;             // m

/// The desired motion of the arms without collisions: inwards and back, one hand up while the other goes
/// down.
VectorXd wanted(const BentArms& robot, double t) {
  VectorXd q = robot.start;
  for (const double side : {1.0, -1.0}) {
    const std::string arm = side > 0 ? "LARM" : "RARM";
    robot.joint(q, arm, 0) += side * 0.15 * std::sin(2 * t);
    robot.joint(q, arm, 1) -= side * 0.4 * (1 - std::cos(M_PI * t / 3)) / 2;
    robot.joint(q, arm, 2) -= side * 0.5 * (1 - std::cos(M_PI * t / 3)) / 2;
    robot.joint(q, arm, 4) += side * 0.04 * std::sin(3 * t);
    robot.joint(q, arm, 5) += 0.03 * std::sin(2.3 * t);
  }
  return q;
}

std::vector<Tick> run(const BentArms& robot, bool smooth) {
  const Eigen::Vector3d size(0.12, 0.10, 0.16);  // m
  auto geometry = std::make_shared<RobotGeometry>();
  for (const char* arm : {"LARM", "RARM"}) {
    geometry->bodies.push_back(robot.box(arm, 0.12, size, {kr, kR}));
    if (smooth) continue;
    geometry->bodies.back().volume = nullptr;
    geometry->bodies.back().geometry = std::make_shared<fcl::Boxd>(size);
  }
  CollisionConstraints constraints(robot.kinematics, geometry, {{0, 1, false}});
  const double margin = smooth ? 0 : 2 * kr;  // the volumes contain this margin
  // clang-format off
DamperOptions options;
options.all.influence += margin;                     // defaults: d_i 5 cm, d_s 1 cm, xi 0.5 m/s
options.all.security += margin;
VelocityDamper damper(constraints, options);
VectorXd q = robot.start, qd = VectorXd::Zero(q.size());
Eigen::MatrixXd A(1, q.size());
VectorXd b(1);
std::vector<Tick> ticks;
for (double t = 0; t < kDuration; t += kPeriod) {
  VectorXd next = 10 * (wanted(robot, t) - q);       // the task: proportional control
  damper.update(q, qd);
  if (damper.dense(A, b) == 1) {                     // one row: the quadratic program min |x - task|^2 is a projection
    const VectorXd row = A.row(0);
    next += row * std::max(0.0, b[0] - row.dot(next)) / row.squaredNorm();
  }
  ticks.push_back({damper.d()[0] - margin, (next - qd).lpNorm<Eigen::Infinity>() / kPeriod});
  qd = next;
  q += kPeriod * qd;
}
  // clang-format on
  return ticks;
}

}  // namespace

int main(int argc, char** argv) {
  const auto work = [&] {
    ControllerPage page(argc > 1 ? argv[1] : ".");
    const BentArms robot;
    return page.write(run(robot, true), run(robot, false), kPeriod) ? 0 : 1;
  };
  return reported(argc, argv, work, "[FOLDER]");
}
