// Loads files for Python, and raises the warnings of loading as Python warnings.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "parts.h"

namespace fcl_stpbv {

/// Loads a robot's files one after the other, and collects their warnings.
struct Loading {
  std::vector<std::string> warnings;  ///< whole sentences about everything that was loaded

  RobotModel robot(const Path& urdf);
  RobotModel obstacles(const Path& urdf);
  Srdf srdf(const Path& path, const RobotModel& robot);
  RobotGeometry geometry(const RobotModel& robot, const GeometryOptions& options);

  /// Warns if covers of primitives have a larger R than `options` state.
  void warnOfR(const RobotModel& robot, const RobotGeometry& covered, const GeometryOptions& options);

  /// Warns if an SRDF leaves out no pair.
  void warnOfPairs(const RobotModel& robot, const RobotGeometry& geometry, const Srdf& srdf);
};

/// Warnings about bodies that modelFor() made, without those in `known`.
std::vector<std::string> warningsOfModel(const RobotModel& robot, const RobotGeometry& geometry,
                                         const std::vector<std::string>& known);

/// Raises each warning as a UserWarning of the calling Python code. @throws pybind11::error_already_set if
/// that code has turned warnings into errors.
void warn(const std::vector<std::string>& warnings);

/// A text that may contain file names, which need not be UTF-8. It is decoded in the same way as Python
/// decodes file names.
pybind11::str decoded(const std::string& text);
pybind11::list decoded(const std::vector<std::string>& texts);

}  // namespace fcl_stpbv
