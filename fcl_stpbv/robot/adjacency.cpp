// Adjacency of links. Links joined by fixed joints are one part.
//
// 1. In each part, find the link with a body that is nearest to each link, counted in fixed joints. If
//    several are equally near, there is none.
// 2. Two links are adjacent if one moving joint lies between them, or several that rotate about the same
//    origin with no body between them (a compound joint), and if both are the nearest links with a body at
//    its ends. A planar or floating joint makes them separate.
#include "fcl_stpbv/robot/adjacency.h"

#include <limits>

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

// A planar or floating joint does not keep its two links near each other.
bool leavesFree(const JointModel& joint) {
  return joint.type == JointType::planar || joint.type == JointType::floating;
}

/// The link with a body that is nearest to a link: how many fixed joints away, and which one. -1: none, or
/// several are equally near.
struct NearestBody {
  int away = std::numeric_limits<int>::max() / 2;
  int link = -1;

  void offer(const NearestBody& other) {
    if (other.away + 1 > away) return;
    link = other.away + 1 < away || link == other.link ? other.link : -1;
    away = other.away + 1;
  }
};

}  // namespace

Adjacency::Adjacency(const RobotModel& robot, const RobotGeometry& geometry)
    : robot_(robot),
      owner_(robot.links.size()),
      part_(robot.links.size()),
      pose_(robot.links.size(), Eigen::Isometry3d::Identity()),
      partBody_(robot.links.size()) {
  std::vector<NearestBody> nearest(robot.links.size());
  const auto fixedTo = [&](std::size_t l) {  // the parent, -1: none, or by a joint that moves
    const int j = robot.links[l].parentJoint;
    return j >= 0 && robot.joints[at(j)].type == JointType::fixed ? robot.joints[at(j)].parent : -1;
  };
  for (std::size_t l = 0; l < robot.links.size(); ++l) {  // parents first
    const int link = static_cast<int>(l), parent = fixedTo(l);
    const auto [first, last] = geometry.of(link);
    part_[l] = link;
    if (parent >= 0) {
      part_[l] = part_[at(parent)];
      pose_[l] = pose_[at(parent)] * robot.joints[at(robot.links[l].parentJoint)].origin;
    }
    if (!(first < last) && geometry.incomplete.count(link) == 0) continue;
    nearest[l] = {0, link};
    partBody_[at(part_[l])] = 1;
  }
  for (std::size_t l = robot.links.size(); l-- > 0;)  // in the subtree
    if (fixedTo(l) >= 0) nearest[at(fixedTo(l))].offer(nearest[l]);
  for (std::size_t l = 0; l < robot.links.size(); ++l) {  // beyond the parent
    if (fixedTo(l) >= 0) nearest[l].offer(nearest[at(fixedTo(l))]);
    owner_[l] = nearest[l].link;
  }
}

Joining Adjacency::of(int link1, int link2) const {
  if (part_[at(link1)] == part_[at(link2)]) return Joining::rigid;
  const JointPath path = jointPath(robot_, link1, link2);
  // The last joint that moves: its origin and the part it leads to.
  const JointModel* last = nullptr;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  int after = link1;
  for (std::size_t i = 0; i < path.joints.size(); ++i) {
    const JointModel& joint = robot_.joints[at(path.joints[i])];
    const bool up = i < path.up;
    if (leavesFree(joint)) return Joining::separate;
    if (joint.type == JointType::fixed) continue;
    const int before = up ? joint.child : joint.parent;
    if (!last && owner_[at(before)] != link1) return Joining::separate;
    if (last && !(turns(*last) && turns(joint) && !partBody_[at(part_[at(before)])] &&
                  (originOn(joint, !up) - origin).norm() <= kSameOrigin))
      return Joining::separate;
    last = &joint;
    origin = originOn(joint, up);
    after = up ? joint.parent : joint.child;
  }
  return owner_[at(after)] == link2 ? Joining::adjacent : Joining::separate;
}

// A joint's origin in the frame of the part of its parent link or of its child link. A turning joint does not
// move its origin relative to either part. So origins that coincide in one configuration coincide in all.
Eigen::Vector3d Adjacency::originOn(const JointModel& joint, bool parent) const {
  if (parent) return (pose_[at(joint.parent)] * joint.origin).translation();
  return pose_[at(joint.child)].translation();
}

}  // namespace fcl_stpbv::detail
