// Robots and scenes that posture tests share.
#pragma once

#include <string>

#include "fcl_stpbv/posture/task.h"
#include "test/reference/robots.h"

namespace fcl_stpbv::test {

/// The HRP-2-style robot, in front of the fridge or without it.
PostureScene hrp2Scene(bool fridge = true);
std::shared_ptr<const RobotModel> fridgeModel();
PostureTask pickCan();

}  // namespace fcl_stpbv::test
