// A small robot with its bodies, for the searches.
#pragma once

#include <memory>
#include <utility>

#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "test/reference/robots.h"

namespace fcl_stpbv::test {

struct Arm {
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const RobotGeometry> geometry;
};

inline Arm armFrom(LoadedRobot loaded, BaseMotion base = BaseMotion::fixed) {
  return {std::make_shared<const Kinematics>(std::move(loaded.model), base),
          std::make_shared<const RobotGeometry>(std::move(loaded.geometry))};
}

}  // namespace fcl_stpbv::test
