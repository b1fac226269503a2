// Loading a robot's bodies in two steps.
#pragma once

#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/shape_source.h"

namespace fcl_stpbv::detail {

/// loadGeometry() in two steps, for callers with several robots to load or with shapes to leave out: what is
/// wrong is added to `faults` for the caller to refuse, and shapes that are wrong are left out.
ShapeSources readGeometry(const RobotModel& robot, const GeometryOptions& options, LoadFaults& faults);
RobotGeometry buildGeometry(const RobotModel& robot, const GeometryOptions& options,
                            const ShapeSources& sources, LoadFaults& faults);

}  // namespace fcl_stpbv::detail
