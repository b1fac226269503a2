// What the tools on robots share on their command lines: the robot's files, how its bodies are made, and what
// is wrong with an output before anything is computed.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/report/robot_files.h"
#include "tools/program.h"

namespace fcl_stpbv::tools {

struct RobotArguments {
  report::RobotFiles files;
  std::string r = "auto", R, primitives = "smooth";
  std::vector<std::string> links, flat;
  bool noCache = false;
};

/// Adds ROBOT and the options; `arguments` is filled when the command line is parsed.
void describeRobot(Program& app, RobotArguments& arguments);

/// The files that the arguments ask for. @throws Error naming the option and what would work.
report::RobotFiles filesOf(const RobotArguments& arguments);

/// @throws Error where nothing can be written to `path`, the argument of -o.
void checkOutput(const std::string& path);

}  // namespace fcl_stpbv::tools
