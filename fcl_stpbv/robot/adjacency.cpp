// Adjacency of links. Links joined by fixed joints are one part. Two links are adjacent if at most one of the
// joints between them moves, or several that rotate about the same origin with no body between them (a
// compound joint). Any other body in between makes the two links separate, and so does a planar or floating
// joint.
#include "fcl_stpbv/robot/adjacency.h"

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/joint_path.h"

namespace fcl_stpbv::detail {
namespace {

// Joint origins nearer to each other than this count as one (m). URDFs are written with six decimals or
// fewer, so that origins meant to coincide may be some micrometres apart; axes that are offset on purpose are
// by tenths of millimetres at least.
constexpr double kSameOrigin = 1e-5;

bool turns(const JointModel& joint) {
  return joint.type == JointType::revolute || joint.type == JointType::continuous;
}

// Such a joint does not keep its two links near each other.
bool leavesFree(const JointModel& joint) {
  return joint.type == JointType::planar || joint.type == JointType::floating;
}

}  // namespace

Adjacency::Adjacency(const RobotModel& robot, const RobotGeometry& geometry)
    : robot_(robot),
      body_(robot.links.size()),
      part_(robot.links.size()),
      pose_(robot.links.size(), Eigen::Isometry3d::Identity()),
      partBody_(robot.links.size()) {
  for (std::size_t l = 0; l < robot.links.size(); ++l) {  // parents first
    const auto [first, last] = geometry.of(static_cast<int>(l));
    body_[l] = first < last || geometry.incomplete.count(static_cast<int>(l)) > 0;
    part_[l] = static_cast<int>(l);
    const int j = robot.links[l].parentJoint;
    if (j >= 0 && robot.joints[at(j)].type == JointType::fixed) {
      const std::size_t parent = at(robot.joints[at(j)].parent);
      part_[l] = part_[parent];
      pose_[l] = pose_[parent] * robot.joints[at(j)].origin;
    }
    if (body_[l]) partBody_[at(part_[l])] = 1;
  }
}

Joining Adjacency::of(int link1, int link2) const {
  if (part_[at(link1)] == part_[at(link2)]) return Joining::rigid;
  const JointPath path = jointPath(robot_, link1, link2);
  // Of the last joint that moves: its origin and the part it leads to.
  const JointModel* last = nullptr;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  int link = link1;
  for (std::size_t i = 0; i < path.joints.size(); ++i) {
    const JointModel& joint = robot_.joints[at(path.joints[i])];
    const bool up = i < path.up;
    if (leavesFree(joint)) return Joining::separate;
    if (joint.type != JointType::fixed) {
      if (last && !(turns(*last) && turns(joint) && !partBody_[at(part_[at(link)])] &&
                    (originOn(joint, !up) - origin).norm() <= kSameOrigin))
        return Joining::separate;
      last = &joint;
      origin = originOn(joint, up);
    }
    link = up ? joint.parent : joint.child;
    if (link != link2 && body_[at(link)]) return Joining::separate;
  }
  return Joining::adjacent;
}

// A joint's origin in the frame of the part of its parent link or of its child link. A turning joint leaves
// it where it is in both, so that origins that coincide in one configuration do so in all.
Eigen::Vector3d Adjacency::originOn(const JointModel& joint, bool parent) const {
  if (parent) return (pose_[at(joint.parent)] * joint.origin).translation();
  return pose_[at(joint.child)].translation();
}

}  // namespace fcl_stpbv::detail
