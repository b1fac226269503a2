// Where a task starts and what its cost is, by the names in its file.
#pragma once

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/posture/task.h"

namespace fcl_stpbv::detail {

/// The cost of a task. @throws Error naming the task's key.
PostureCost costOf(const PostureTask& task, const Kinematics& kinematics, const Eigen::VectorXd& start);

/// What `make` returns; its errors get the place in the task before them.
template <class Make>
auto within(const std::string& where, Make make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(where + ": " + error.what());
  }
}

}  // namespace fcl_stpbv::detail
