// urdf_collision_report: which links of a robot come how close, and which pairs need no check.
#include <filesystem>
#include <functional>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/report/report_formats.h"
#include "tools/number_check.h"
#include "tools/output_plan.h"
#include "tools/program.h"
#include "tools/robot_options.h"
#include "tools/stages.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::report;
using namespace fcl_stpbv::tools;

enum Exit { kClear = 0, kCollision = 1, kPartly = 3 };

constexpr const char* kProgram = "urdf_collision_report";
constexpr const char* kDescription =
    "Distances between the links of a robot, each covered by its sphere-torus-patch bounding volume "
    "(STP-BV).";

constexpr const char* kFooter =
    R"(With --pose the pairs are reported in that posture, else each in the closest configuration that the samples
and the descents from them found. Pairs that the SRDF leaves out, or without one adjacent and rigidly joined links and
those found in collision everywhere, are not checked; their figures are reported all the same. Lengths are in metres.

Examples:
  urdf_collision_report robot.urdf --srdf robot.srdf --pose zero
  urdf_collision_report robot.urdf --package-path ~/ws/src --samples 10000
  urdf_collision_report robot.urdf --format srdf -o robot.srdf
  urdf_collision_report robot.urdf --srdf robot.srdf --format html -o out.html
  urdf_collision_report robot.urdf --srdf robot.srdf --trajectory path.csv

Exit status, whatever the format: 0 no checked pair in collision; 1 a collision found, or a trajectory not proven free, and the
report is written all the same; 2 the command line or an input is wrong, or no pair is checked; 3 no collision found, but --skip-invalid left shapes out.)";

struct Arguments {
  RobotArguments robot;
  SearchArguments search;
  std::string format = "text", output;
  std::size_t top = 20;
  bool quiet = false;
};

void describe(Program& app, Arguments& a) {
  ReportRequest& request = a.search.request;
  describeRobot(app, a.robot);
  describeSearch(app, a.search);
  app.option("--pose", request.pose, "A group_state of the SRDF, or a JSON file of joint values");
  app.option("--trajectory", request.trajectory,
             "CSV or JSON of way points: whether the straight motions between them are free, by proof; each "
             "checked pair is reported where it comes closest")
      .type("FILE");
  app.option(
         "--polyhedra", request.polyhedra,
         "Folder of polyhedra published for the meshes, MESH-ch.txt or MESH.otp: tells how far they differ")
      .type("FOLDER");
  app.option("--top", a.top, "Lines of each list in the text, and warnings shown").whole().shown();
  app.option("--format", a.format, "Format of the report")
      .oneOf({"text", "json", "csv", "srdf", "html"})
      .shown();
  app.option("-o,--output", a.output, "File to write instead of standard output").type("OUT");
  app.flag("-q,--quiet", a.quiet, "No progress bar and no warnings");
}

std::string written(const CollisionReport& report, const Arguments& a) {
  if (a.format == "json") return toJson(report);
  if (a.format == "csv") return toCsv(report);
  if (a.format == "srdf") return toSrdfText(report, a.search.disableDefault);
  if (a.format == "html") return toHtml(report);
  return toText(report, a.top);
}

int statusOf(const CollisionReport& report) {
  const bool undecided = report.trajectory && report.trajectory->verdict != MotionVerdict::free;
  if (report.colliding > 0 || undecided) return kCollision;
  return report.skipped.empty() ? kClear : kPartly;
}

// Why the exit status is not 0.
std::string reasonOf(const CollisionReport& report, int status) {
  if (status == kPartly) return "--skip-invalid left " + counted(report.skipped.size(), "shape") + " out";
  if (report.colliding == 0) return "the trajectory is not proven free: " + trajectoryVerdict(report);
  return counted(static_cast<std::size_t>(report.colliding), "checked pair") +
         (report.colliding == 1 ? " collides" : " collide");
}

// The text about an SRDF that is written, because the SRDF itself is not on the screen.
std::string toldOf(const CollisionReport& report, const Arguments& a, int status) {
  const bool isFile = !a.output.empty() && a.output != "-";
  return (isFile ? a.output + " is written: " : "") + srdfChange(report, a.search.disableDefault) +
         (status == kClear ? ""
                           : "; exit status " + std::to_string(status) + ", as " + reasonOf(report, status));
}

int run(Arguments& a) {
  const ReportRequest& asked = a.search.request;
  RobotFiles read = a.robot.files;
  // It may be the file that is updated: everything but its pairs stays.
  if (a.format == "srdf") read.srdf.clear();
  std::vector<std::string> others{asked.pose, asked.neutral, asked.trajectory};
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(asked.polyhedra, ignored))
    others.push_back(entry.path().string());
  checkOutput(a.output, read, others);
  Stages stages(!a.quiet);
  ReportRequest request = requestOf(a.robot, a.search, std::ref(stages));
  request.files.writesPairs = a.format == "srdf";
  if (!request.pose.empty() && !request.trajectory.empty())
    throw Error("--trajectory " + request.trajectory +
                ": cannot be given with --pose; leave one of them out");
  const CollisionReport report = makeReport(request);
  stages.clear();
  if (!a.quiet) tellAll(kProgram, report.skipped, report.warnings, a.top);
  const std::string text = written(report, a);
  requireNoInput("-o", a.output, report.meshFiles);  // also for the meshes of a robot from a pipe
  writeOutput(a.output, text);
  const int status = statusOf(report);
  if (a.format == "srdf" && !a.quiet) tell(kProgram, toldOf(report, a, status));
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  Program program(kDescription, kProgram);
  program.footer(kFooter);
  Arguments arguments;
  describe(program, arguments);
  return program.run(argc, argv, [&] { return run(arguments); });
}
