// A small robot with its bodies, for the searches.
#pragma once

#include <memory>
#include <utility>

#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv::test {

struct Arm {
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const RobotGeometry> geometry;
};

inline Arm armFrom(std::shared_ptr<const RobotModel> model, RobotGeometry geometry,
                   BaseMotion base = BaseMotion::fixed) {
  return {std::make_shared<const Kinematics>(std::move(model), base),
          std::make_shared<const RobotGeometry>(std::move(geometry))};
}

}  // namespace fcl_stpbv::test
