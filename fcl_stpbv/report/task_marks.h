// What a task asks of the links, for the page of a posture: where frames are to be, and what is off.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "fcl_stpbv/posture/task.h"

namespace fcl_stpbv::report {

/// A placement. Poses are in the world.
struct TargetMark {
  std::string name;
  Eigen::Isometry3d target, frame;  ///< where the frame is to be, and where the posture has it
  bool turns = false;               ///< whether its rotation counts, all of it or an axis
  /// In the directions that are not free (m, rad).
  double off = 0, turned = 0;
};

/// A link that stands on the ground, by these points (world).
struct ContactMark {
  std::string link;
  std::vector<Eigen::Vector3d> points;
};

struct TaskMarks {
  std::vector<TargetMark> targets;
  std::vector<ContactMark> contacts;
};

/// Of a task as its base stands at the origin, at q.
TaskMarks marksOf(const PostureTask& task, const Kinematics& kinematics, const Eigen::VectorXd& q);

}  // namespace fcl_stpbv::report
