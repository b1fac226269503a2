// Files that Python names, loaded, and what the loading warns of, told through Python's own warnings.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "parts.h"

namespace fcl_stpbv {

/// Loads a robot's files, one after the other, and keeps what each warns of.
struct Loading {
  std::vector<std::string> warnings;  ///< whole sentences, of all that was loaded

  RobotModel robot(const Path& urdf);
  RobotModel obstacles(const Path& urdf);
  Srdf srdf(const Path& path, const RobotModel& robot);
  RobotGeometry geometry(const RobotModel& robot, const GeometryOptions& options);

  /// Where covers of primitives have a larger R than `options` ask for.
  void warnOfR(const RobotModel& robot, const RobotGeometry& covered, const GeometryOptions& options);

  /// Of an SRDF that leaves out no pair.
  void warnOfPairs(const RobotModel& robot, const RobotGeometry& geometry, const Srdf& srdf);
};

/// What bodies that are made for needs warn of beside what `known` has told.
std::vector<std::string> warningsOfModel(const RobotModel& robot, const RobotGeometry& geometry,
                                         const std::vector<std::string>& known);

/// Each as a UserWarning of the Python code that called. @throws pybind11::error_already_set where it has
/// made warnings errors.
void warn(const std::vector<std::string>& warnings);

/// Texts that may name files as the bytes that they are, which need not be UTF-8: decoded as Python decodes
/// names of files.
pybind11::str decoded(const std::string& text);
pybind11::list decoded(const std::vector<std::string>& texts);

}  // namespace fcl_stpbv
