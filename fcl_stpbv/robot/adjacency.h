// Finds pairs of links that are so close in the kinematic tree that their distance is meaningless: rigidly
// joined links, and the two links of one joint.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

enum class Joining {
  separate,  ///< to be checked
  adjacent,  ///< connected by one joint, or by one compound joint
  rigid,     ///< no joint moves one relative to the other
};

/// How pairs of links are joined (docs/robot.md, "Adjacent links").
///
/// Two links are rigid if only fixed joints lie between them. They are adjacent if exactly one moving joint
/// lies between them (revolute, continuous or prismatic, but not planar or floating), or several rotating
/// joints with the same origin (a compound joint, such as the three axes of a ball joint). In addition, each
/// of the two must be the link with a body that is nearest to the joint, counted in fixed joints; no other
/// one may be as near. Inside a compound joint no link may have a body. A body that could not be read counts.
class Adjacency {
 public:
  Adjacency(const RobotModel& robot, const RobotGeometry& geometry);
  Joining of(int link1, int link2) const;

 private:
  Eigen::Vector3d originOn(const JointModel& joint, bool parent) const;

  const RobotModel& robot_;
  std::vector<int> owner_;  // of each link: the nearest one with a body in its part; -1: none or several
  std::vector<int> part_;   // the topmost of the links that are rigidly joined to it
  std::vector<Eigen::Isometry3d> pose_;  // in the frame of that link
  std::vector<char> partBody_;           // of a topmost link: whether one of its part has a body
};

}  // namespace fcl_stpbv::detail
