// How many coordinates a joint has.
#pragma once

#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// Of its own, were it to mimic no other: 0, 1, 3 or 6.
inline int freedoms(JointType type) {
  switch (type) {
    case JointType::fixed:
      return 0;
    case JointType::planar:
      return 3;
    case JointType::floating:
      return 6;
    default:
      return 1;
  }
}

}  // namespace fcl_stpbv::detail
