// The work of urdf_to_stpbv: converts a robot to a folder with its convex parts, their volumes and the
// certified bounds.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/report/collision_report.h"

namespace fcl_stpbv::report {

struct RobotConversion {
  ReportRequest report;  ///< the robot, its parts, and how pairs are searched; no posture, no trajectory
  std::string folder;    ///< folder to make or to bring up to date
  /// Prefix of the parts' mesh names in the URDF, such as "package://my_robot/"; with "" the names are
  /// relative to the URDF.
  std::string meshPrefix;
  bool disableDefault = false;  ///< see toSrdfText()
  bool force = false;           ///< also if nothing has changed, and if the folder's files were edited
};

struct ConversionResult {
  bool upToDate = false;  ///< the folder had all this already: nothing was computed or written
  std::vector<std::string> warnings, skipped;  ///< see CollisionReport
  std::string summary;                         ///< one line for people
};

/// Writes, all at once or nothing:
/// - ROBOT.urdf: each collision mesh replaced by the hulls of its parts, meshes/LINK_0.obj and so on;
/// - volumes/LINK_0.stpbv and so on, one for each part;
/// - ROBOT.srdf: the pair list of the robot with these parts, as the report writes it;
/// - manifest.json: every bound, the sources and their SHA-256 (docs/parts.md).
/// @throws Error naming the file or argument; the folder is then unchanged.
ConversionResult convertRobot(const RobotConversion& conversion);

}  // namespace fcl_stpbv::report
