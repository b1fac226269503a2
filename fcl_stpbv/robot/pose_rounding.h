// Upper bound on how far rounding moves the bodies of a robot from where exact arithmetic places them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::detail {

/// A body of a robot: its link (-1 for the world), and a length that no point of it exceeds (m): the distance
/// of its frame from the link's origin plus that of the point from its frame. Infinite for an unbounded body.
struct BodyReach {
  int link;
  double length;
};

/// The reach of a body at `pose` in its link, within a ball (centre in the link's frame).
inline BodyReach reachOf(int link, const Eigen::Isometry3d& pose, const Eigen::Vector3d& centre,
                         double radius) {
  return {link, pose.translation().norm() + (centre - pose.translation()).norm() + radius};
}

/// The bound for all bodies of a list (docs/robot.md, Rounding of the poses). What does not depend on q is
/// summed once, so a robot that has only hinges costs nothing at a q.
class PoseRounding {
 public:
  PoseRounding() = default;
  PoseRounding(const Kinematics& kinematics, const std::vector<BodyReach>& bodies);

  /// Upper bound on the rounding of any body's points at q (m).
  double most(const Eigen::Ref<const Eigen::VectorXd>& q) const;

 private:
  void addValues(const Kinematics& kinematics, const std::vector<double>& slide,
                 const std::vector<double>& beyond);

  /// A coordinate of a joint, with what its value is multiplied by and what is added, both as sizes.
  struct Value {
    int coordinate;
    double multiplier, offset;
    /// For a joint that slides: roundings (in eps) of each metre. For one whose angle is rounded: the largest
    /// distance of a body's point from the joint (m), without the ways that other joints slide.
    double weight;
  };

  double still_ = 0;           // the part that does not depend on q (m, in eps)
  std::vector<Value> slides_;  // joints that slide
  std::vector<Value> turns_;   // joints whose angle is computed from q
};

}  // namespace fcl_stpbv::detail
