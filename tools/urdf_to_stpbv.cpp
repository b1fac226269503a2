// urdf_to_stpbv: a robot's URDF into one whose collision meshes are convex parts, with volumes and pair list.
#include <iostream>

#include "fcl_stpbv/report/robot_conversion.h"
#include "tools/program.h"
#include "tools/robot_options.h"
#include "tools/stages.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::report;
using namespace fcl_stpbv::tools;

enum Exit { kDone = 0, kPartly = 3 };

constexpr const char* kProgram = "urdf_to_stpbv";
constexpr const char* kDescription =
    "A robot's URDF with convex parts as its collision meshes, their sphere-torus-patch bounding volumes "
    "(STP-BVs), and the pairs of links to check.";

constexpr const char* kFooter =
    R"(Into FOLDER go ROBOT.urdf, whose collision meshes are convex (meshes/*.obj), the parts' volumes (volumes/*.stpbv),
ROBOT.srdf with the pairs that need no check, and manifest.json with all bounds: how far each part and each volume is from
its mesh at most. Together the parts cover the meshes. Where nothing has changed since the last run nothing is done; where a
mesh has, the others come from the cache. The folder is written at once or not at all. Lengths are in metres.

Examples:
  urdf_to_stpbv robot.urdf -o robot_parts
  urdf_to_stpbv robot.urdf --package-path ~/ws/src -o robot_parts
  urdf_to_stpbv robot.urdf --srdf robot.srdf --parts auto -o robot_parts
  urdf_to_stpbv robot.urdf -o convex --mesh-prefix package://my_robot/convex/

Exit status: 0 the folder holds the robot; 2 the command line or an input is wrong, and the folder is as it was; 3 written,
but --skip-invalid left shapes out.)";

struct Arguments {
  RobotArguments robot;
  SearchArguments search;
  RobotConversion conversion;
  bool quiet = false;
};

void describe(Program& app, Arguments& a) {
  a.search.parts = "8";
  describeRobot(app, a.robot);
  describeSearch(app, a.search);
  app.option("-o,--output", a.conversion.folder, "Folder to write, made if missing")
      .required()
      .type("FOLDER");
  app.option(
         "--mesh-prefix", a.conversion.meshPrefix,
         "Prefix of the mesh names in the URDF, such as package://my_robot/; without it they are relative to "
         "the URDF")
      .type("PREFIX");
  app.flag("--force", a.conversion.force, "Do all again, and replace files of the folder that were changed");
  app.flag("-q,--quiet", a.quiet, "No progress bar, no warnings and no summary");
}

int run(Arguments& a) {
  Stages stages(!a.quiet);
  a.conversion.report = requestOf(a.robot, a.search, std::ref(stages));
  a.conversion.disableDefault = a.search.disableDefault;
  const ConversionResult result = convertRobot(a.conversion);
  stages.clear();
  if (!a.quiet) {
    tellAll(kProgram, result.skipped, result.warnings);
    std::cout << result.summary << std::endl;
  }
  return result.skipped.empty() ? kDone : kPartly;
}

}  // namespace

int main(int argc, char** argv) {
  Program program(kDescription, kProgram);
  program.footer(kFooter);
  Arguments arguments;
  describe(program, arguments);
  return program.run(argc, argv, [&] { return run(arguments); });
}
