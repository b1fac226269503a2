// hrp2_style with bent arms and level boxes in its hands: what two examples start from. The robot is read in
// the current folder.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "docs/examples/named.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/srdf.h"

struct BentArms {
  std::shared_ptr<const fcl_stpbv::Kinematics> kinematics;
  Eigen::VectorXd start;  ///< half sitting, with the forearms forwards

  BentArms() {
    using namespace fcl_stpbv;
    const auto robot = std::make_shared<const RobotModel>(loadUrdf("hrp2_style.urdf"));
    kinematics = std::make_shared<const Kinematics>(robot);
    start = kinematics->configuration(loadSrdf("hrp2_style.srdf", *robot).state("half_sitting"));
    for (const double side : {1.0, -1.0}) {
      const std::string arm = side > 0 ? "LARM" : "RARM";
      joint(start, arm, 0) = -0.6;
      joint(start, arm, 1) = side * 0.25;
      joint(start, arm, 3) = -1.2;
    }
  }

  /// An arm's joint in q (rad).
  double& joint(Eigen::VectorXd& q, const std::string& arm, int number) const {
    return q[coordinateOf(*kinematics, arm + "_JOINT" + std::to_string(number))];
  }

  /// A box as an STP-BV under an arm's hand, level in the start posture. `below`: from the hand to the box's
  /// centre (m).
  fcl_stpbv::Body box(const std::string& arm, double below, const Eigen::Vector3d& size,
                      const fcl_stpbv::StpBvOptions& radii) const {
    using namespace fcl_stpbv;
    Kinematics::State state = kinematics->makeState();
    kinematics->forward(start, state);
    Body box;
    box.link = linkOf(kinematics->robot(), arm + "_LINK5");
    box.name = arm + "'s box";
    const Eigen::Isometry3d& hand = state.link[static_cast<std::size_t>(box.link)];
    box.pose = hand.inverse() * Eigen::Translation3d(hand * Eigen::Vector3d(0, 0, -below));
    std::vector<Eigen::Vector3d> corners;
    for (int i = 0; i < 8; ++i)
      corners.push_back(
          size.cwiseProduct(Eigen::Vector3d(i & 1 ? .5 : -.5, i & 2 ? .5 : -.5, i & 4 ? .5 : -.5)));
    box.volume = StpBv::build(corners, radii);
    box.geometry = std::make_shared<StpBvGeometry>(box.volume);
    box.centre = box.pose * box.volume->centre();
    box.radius = box.volume->enclosingRadius();
    return box;
  }
};
