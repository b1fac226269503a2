// What a task asks of the links, for the page of a posture: where frames should be, and how far they are off.
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
  Eigen::Isometry3d target, frame;  ///< target pose of the frame, and its pose in the posture
  bool turns = false;               ///< whether its rotation counts, completely or about an axis
  /// Errors of position and rotation in the directions that are not free (m, rad).
  double off = 0, turned = 0;
};

/// A link that stands on the ground with these points (world).
struct ContactMark {
  std::string link;
  std::vector<Eigen::Vector3d> points;
};

struct TaskMarks {
  std::vector<TargetMark> targets;
  std::vector<ContactMark> contacts;
};

/// The marks of a task in the configuration `q`, with the task's base at the origin.
TaskMarks marksOf(const PostureTask& task, const Kinematics& kinematics, const Eigen::VectorXd& q);

}  // namespace fcl_stpbv::report
