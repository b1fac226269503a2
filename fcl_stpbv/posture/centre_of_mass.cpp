// The centre of mass of all links, and its Jacobian from the mass below each joint.
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/posture/task.h"

namespace fcl_stpbv {

using detail::at;
using detail::requireSize;
using Eigen::Vector3d;

CentreOfMass::CentreOfMass(const Kinematics& kinematics) {
  const RobotModel& robot = kinematics.robot();
  for (const LinkModel& link : robot.links) {
    if (!link.massFault.empty())
      throw Error(link.massFault + "; without its mass nothing can be said about the centre of mass");
    const int parent = link.parentJoint < 0 ? -1 : robot.joints[at(link.parentJoint)].parent;
    links_.push_back({parent, link.mass, link.centreOfMass});
    mass_ += link.mass;
  }
  if (!(mass_ > 0)) throw Error(robot.path + ": no link has a mass; give the links <inertial> elements");
  for (const Kinematics::Motion& motion : kinematics.motions())
    motions_.push_back({motion.joint < 0 ? 0 : robot.joints[at(motion.joint)].child, motion.coordinate});
  coordinates_ = kinematics.size();
  below_.resize(links_.size());
  momentBelow_.resize(links_.size());
}

Vector3d CentreOfMass::evaluate(const Kinematics::State& state, Eigen::Ref<Eigen::Matrix3Xd> jacobian) {
  requireSize("CentreOfMass", "state.link", static_cast<long>(state.link.size()),
              static_cast<long>(links_.size()));
  requireSize("CentreOfMass", "state.motion", static_cast<long>(state.motion.size()),
              static_cast<long>(motions_.size()));
  requireSize("CentreOfMass", "the Jacobian", jacobian.cols(), coordinates_);
  for (std::size_t i = 0; i < links_.size(); ++i) {
    below_[i] = links_[i].mass;
    momentBelow_[i] = links_[i].mass * (state.link[i] * links_[i].centre);
  }
  for (std::size_t i = links_.size(); i-- > 1;) {  // parents come before their children
    below_[at(links_[i].parent)] += below_[i];
    momentBelow_[at(links_[i].parent)] += momentBelow_[i];
  }
  jacobian.setZero();
  for (std::size_t m = 0; m < motions_.size(); ++m) {
    const Twist& twist = state.motion[m];
    const std::size_t link = at(motions_[m].link);
    jacobian.col(motions_[m].coordinate) +=
        (below_[link] * twist.linear + twist.angular.cross(momentBelow_[link])) / mass_;
  }
  return momentBelow_[0] / mass_;
}

}  // namespace fcl_stpbv
