// Which links are so near each other in the kinematic tree that their distance says nothing: rigidly joined
// ones, and those on either side of one joint that holds them.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

enum class Joining {
  separate,  ///< to be checked
  adjacent,  ///< on either side of one joint, or of one compound joint
  rigid,     ///< no joint can change where they are to each other
};

/// How pairs of links are joined (docs/robot.md, "Adjacent links").
///
/// Two links are rigid where only fixed joints lie between them. They are adjacent where one joint that turns
/// or slides lies between them, neither planar nor floating, or several turning joints whose origins coincide
/// (a compound joint, such as the three axes of a ball joint), and no link on the way, nor any fixed to it,
/// has a body, be it one that was left out.
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
