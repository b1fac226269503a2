// A robot's bodies as FCL objects in one posture, moved by the kinematics, and the check which pairs count.
#include "tools/posed_robot.h"

#include <algorithm>

namespace fcl_stpbv::tools {

PosedRobot::PosedRobot(const Kinematics& kinematics, const RobotGeometry& geometry, const Srdf& srdf)
    : kinematics_(kinematics), geometry_(geometry), state_(kinematics.makeState()) {
  const std::vector<LinkModel>& links = kinematics.robot().links;
  const SkipReasons reasons(&srdf);
  const auto linkOf = [&](std::size_t body) { return static_cast<std::size_t>(geometry.bodies[body].link); };
  for (std::size_t i = 0; i < geometry.bodies.size(); ++i) {
    objects_.push_back(std::make_unique<fcl::CollisionObjectd>(geometry.bodies[i].geometry));
    objects_.back()->setUserData(const_cast<Body*>(&geometry.bodies[i]));
    for (std::size_t j = 0; j < i; ++j) {
      if (linkOf(i) == linkOf(j) || !reasons.of(links[linkOf(j)].name, links[linkOf(i)].name).empty())
        continue;
      pairs_.emplace_back(static_cast<int>(j), static_cast<int>(i));
    }
  }
  checked_.insert(pairs_.begin(), pairs_.end());
  moveTo(kinematics.neutral());
  for (const auto& object : objects_) manager_.registerObject(object.get());
  manager_.setup();
}

void PosedRobot::moveTo(const Eigen::VectorXd& q) {
  kinematics_.forward(q, state_);
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const Body& body = geometry_.bodies[i];
    objects_[i]->setTransform(state_.link[static_cast<std::size_t>(body.link)] * body.pose);
    objects_[i]->computeAABB();  // setTransform keeps the old box
  }
  manager_.update();
}

int PosedRobot::index(const fcl::CollisionObjectd* object) const {
  return static_cast<int>(static_cast<const Body*>(object->getUserData()) - geometry_.bodies.data());
}

bool PosedRobot::checked(const fcl::CollisionObjectd* a, const fcl::CollisionObjectd* b) const {
  const auto [i, j] = std::minmax({index(a), index(b)});
  return checked_.count({i, j}) > 0;
}

bool selfDistanceCallback(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* check, double& dist) {
  SelfCheck& self = *static_cast<SelfCheck*>(check);
  return self.robot->checked(a, b) && distanceCallback(a, b, &self.data, dist);
}

}  // namespace fcl_stpbv::tools
