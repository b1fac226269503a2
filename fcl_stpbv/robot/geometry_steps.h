// Loading a robot's bodies in two steps.
#pragma once

#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/shape_source.h"

namespace fcl_stpbv::detail {

/// loadGeometry() in two steps, for callers that load several robots or that leave out faulty shapes. Faulty
/// shapes are left out, and their faults are added to `faults`; the caller decides whether they are an error.
ShapeSources readGeometry(const RobotModel& robot, const GeometryOptions& options, LoadFaults& faults);
RobotGeometry buildGeometry(const RobotModel& robot, const GeometryOptions& options,
                            const ShapeSources& sources, LoadFaults& faults);

}  // namespace fcl_stpbv::detail
