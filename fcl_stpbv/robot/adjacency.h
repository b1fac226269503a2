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
/// joints with the same origin (a compound joint, such as the three axes of a ball joint). In addition, no
/// link between them, nor any link fixed to one of those, may have a body, not even one that could not be
/// read.
class Adjacency {
 public:
  Adjacency(const RobotModel& robot, const RobotGeometry& geometry);
  Joining of(int link1, int link2) const;

 private:
  Eigen::Vector3d originOn(const JointModel& joint, bool parent) const;

  const RobotModel& robot_;
  std::vector<char> body_;               // of each link: whether it has one, known or left out
  std::vector<int> part_;                // the topmost of the links that are rigidly joined to it
  std::vector<Eigen::Isometry3d> pose_;  // in the frame of that link
  std::vector<char> partBody_;           // of a topmost link: whether one of its part has a body
};

}  // namespace fcl_stpbv::detail
