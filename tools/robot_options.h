// The command-line options that the tools on robots share: the robot's files, how its bodies are made, and
// checks of outputs before anything is computed.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/report/collision_report.h"
#include "fcl_stpbv/report/robot_files.h"
#include "tools/cores.h"
#include "tools/program.h"

namespace fcl_stpbv::tools {

struct RobotArguments {
  report::RobotFiles files;
  std::string r = "auto", R, advise, primitives = "smooth";
  std::vector<std::string> links, flat;
  bool noCache = false;
  int jobs = allCores();
};

/// Adds ROBOT and the options. `arguments` is filled when the command line is parsed.
void describeRobot(Program& app, RobotArguments& arguments);

/// How the pairs are searched, and which links are split. The options write only these members of `request`.
struct SearchArguments {
  report::ReportRequest request;
  std::string parts = "none";
  bool disableDefault = false;
};
void describeSearch(Program& app, SearchArguments& arguments);

/// The meaning of --parts: whether it is "auto", and the largest number of parts of each link, 1 for none.
/// @throws Error if it is neither "none" nor "auto" nor a number.
std::pair<bool, int> partsAsked(const std::string& parts);

/// Called with the number of steps done, the number of all steps, and a text.
using Progress = std::function<void(std::size_t, std::size_t, const std::string&)>;

/// The report that both arguments request. @throws Error naming the option and what would work.
report::ReportRequest requestOf(const RobotArguments& robot, const SearchArguments& search,
                                const Progress& progress);

/// The files that the arguments name. @throws Error naming the option and what would work.
report::RobotFiles filesOf(const RobotArguments& arguments);

/// Prints the shapes that were left out, and the first `top` warnings. Successive warnings about the same
/// file are printed below its name.
void tellAll(const std::string& program, const std::vector<std::string>& skipped,
             const std::vector<std::string>& warnings,
             std::size_t top = std::numeric_limits<std::size_t>::max());

/// @throws Error if nothing can be written to `path`, the argument of -o; UsageError if that would replace a
/// file that is read: one of the robot's, such as a mesh, or one of `others`.
void checkOutput(const std::string& path, const report::RobotFiles& robot,
                 const std::vector<std::string>& others);

}  // namespace fcl_stpbv::tools
