// The start and the cost of a task, from the names in its file.
#pragma once

#include "fcl_stpbv/error_place.h"
#include "fcl_stpbv/posture/task.h"

namespace fcl_stpbv::detail {

/// The cost of a task. @throws Error naming the task's key.
PostureCost costOf(const PostureTask& task, const Kinematics& kinematics, const Eigen::VectorXd& start);

}  // namespace fcl_stpbv::detail
