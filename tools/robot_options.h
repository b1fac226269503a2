// What the tools on robots share on their command lines: the robot's files, how its bodies are made, and what
// is wrong with an output before anything is computed.
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

/// Adds ROBOT and the options; `arguments` is filled when the command line is parsed.
void describeRobot(Program& app, RobotArguments& arguments);

/// How the pairs are searched, and which links are split; of `request` the options write only that.
struct SearchArguments {
  report::ReportRequest request;
  std::string parts = "none";
  bool disableDefault = false;
};
void describeSearch(Program& app, SearchArguments& arguments);

/// What --parts asks for: auto, and the most parts of every link, 1 for none.
/// @throws Error where it is none of "none", "auto" and a number.
std::pair<bool, int> partsAsked(const std::string& parts);

/// Called with the steps done, all steps and what is being done.
using Progress = std::function<void(std::size_t, std::size_t, const std::string&)>;

/// The report that both ask for. @throws Error naming the option and what would work.
report::ReportRequest requestOf(const RobotArguments& robot, const SearchArguments& search,
                                const Progress& progress);

/// The files that the arguments ask for. @throws Error naming the option and what would work.
report::RobotFiles filesOf(const RobotArguments& arguments);

/// Tells of the shapes that were left out, and of the warnings the first `top`. Those of one file in a row
/// stand below its name.
void tellAll(const std::string& program, const std::vector<std::string>& skipped,
             const std::vector<std::string>& warnings,
             std::size_t top = std::numeric_limits<std::size_t>::max());

/// @throws Error where nothing can be written to `path`, the argument of -o, and UsageError where that would
/// replace a file that is read: the robot's, a mesh among them, or one of `others`.
void checkOutput(const std::string& path, const report::RobotFiles& robot,
                 const std::vector<std::string>& others);

}  // namespace fcl_stpbv::tools
