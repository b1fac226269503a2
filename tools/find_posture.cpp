// find_posture: finds joint values for a task, free of collisions, or the constraints that contradict each
// other.
#include <algorithm>
#include <memory>
#include <tuple>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/posture/collision_rows.h"
#include "fcl_stpbv/report/named_posture.h"
#include "fcl_stpbv/report/posture_formats.h"
#include "fcl_stpbv/report/posture_parts.h"
#include "fcl_stpbv/report/report_warnings.h"
#include "tools/output_plan.h"
#include "tools/program.h"
#include "tools/robot_options.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::report;
using namespace fcl_stpbv::tools;

enum Exit { kFeasible = 0, kInfeasible = 1, kPartly = 3 };

constexpr const char* kProgram = "find_posture";
constexpr const char* kDescription =
    "A posture of a robot that does a task free of collisions, by constrained optimisation with the smooth "
    "distance "
    "of sphere-torus-patch bounding volumes (STP-BV).";

constexpr const char* kFooter =
    R"(TASK is a JSON file: where to start, what to place where, contacts for static stability, pairs to keep apart
(docs/posture.md). Lengths are in metres, angles in radians. The hand of an arm that is bolted down to a point, in any
direction:
  {"base": "fixed", "placements": [{"link": "hand", "target": {"position": [0.4, 0.2, 0.5]}, "free": ["rx", "ry", "rz"]}]}

Examples:
  find_posture robot.urdf task.json --srdf robot.srdf --obstacles fridge.urdf
  find_posture robot.urdf task.json --starts 20 --format json -o posture.json

Without an SRDF the robot's own pairs are found as urdf_collision_report does.

Exit status: 0 a posture was found; 1 none was found; 2 the command line or an input is wrong, or no pair is checked;
3 a posture was found, but --skip-invalid left shapes out.)";

struct Arguments {
  RobotArguments robot;
  std::string task, format = "text", output, parts;
  PostureOptions options;
  bool careless = false, quiet = false;
};

void describe(Program& app, Arguments& a) {
  describeRobot(app, a.robot);
  app.option("TASK", a.task, "The task's JSON file").required().type("FILE");
  app.option("--starts", a.options.starts, "Starts to try: the task's own, then random ones near it")
      .whole(1, 100000)
      .shown();
  app.option("--seed", a.options.seed, "Of the random starts").whole().shown();
  app.option("--format", a.format, "Format of the report").oneOf({"text", "json", "html"}).shown();
  app.option("-o,--output", a.output, "File to write instead of standard output").type("OUT");
  app.option(
      "--parts", a.parts,
      "Convex parts of concave links: none; auto, where no posture is found and parts move a pair out of the "
      "way; or a number, at most so many of every link; instead of the task's");
  app.flag("--ignore-collisions", a.careless,
           "Solve without the pairs; those in collision are reported all the same");
  app.flag("-q,--quiet", a.quiet, "No warnings");
}

// Warnings about the pairs that are nearer than the margin in a posture that was found without collision
// constraints.
std::vector<std::string> collisionsOf(const PostureReport& report) {
  std::vector<std::string> list;
  const double margin = report.task.collisionMargin;
  for (const Violation& pair :
       nearerThan(margin, report.pairs, report.scene, report.kinematics, report.posture.q))
    list.push_back("in collision, as --ignore-collisions lets it be: " + pair.name +
                   formatted(", %.4g m", margin - pair.amount));
  return list;
}

// @return the links' parts, if any are requested.
std::unique_ptr<PostureParts> load(const Arguments& a, PostureReport& report) {
  RobotFiles files = filesOf(a.robot);
  files.base = report.task.base;
  RobotLoader loader(files);
  loader.read();
  loader.build();
  requireNoInput("-o", a.output, loader.meshFiles());  // also for the meshes of a robot from a pipe
  PostureScene& scene = report.scene;
  scene.robot = loader.robot();
  scene.srdf = loader.srdf();
  scene.geometry = loader.geometry();
  scene.obstacles = loader.obstacles();
  if (!scene.srdf) scene.selfPairs = searchedPairs(scene.robot, scene.geometry);
  std::tie(report.task, scene) =
      withBaseAtOrigin(report.task, scene);  // the following code uses the base's frame
  report.warnings = loader.warnings();
  if (!report.task.saysBase)
    report.warnings.push_back(a.task +
                              ": it does not say how the robot's base moves, which is taken to be free: "
                              "\"base\": \"fixed\" bolts it down, \"floating\" says that it is free");
  report.skipped = loader.skipped();
  const bool split = report.task.partsAuto || report.task.parts > 1;
  if (!a.quiet) tellAll(kProgram, report.skipped, report.warnings);
  return split ? std::make_unique<PostureParts>(report.task, scene, loader.sceneGeometry(), files.geometry)
               : nullptr;
}

int run(Arguments& a) {
  checkOutput(a.output, a.robot.files, {a.task});
  PostureReport report;
  report.task = loadTask(a.task);
  if (!a.parts.empty()) std::tie(report.task.partsAuto, report.task.parts) = partsAsked(a.parts);
  const std::unique_ptr<PostureParts> parts = load(a, report);
  PostureSetup setup = setUp(report.task, report.scene);
  if (!a.careless)
    requirePairs(setup.pairs.size(), *report.scene.robot,
                 "the task and the robot's joints leave none; --ignore-collisions solves without");
  if (a.careless) setup.problem = setUpWithoutCollisions(report.task, report.scene).problem;
  report.kinematics = setup.problem->sharedKinematics();
  report.posture = parts && !a.careless ? parts->find(setup, a.options) : findPosture(setup, a.options);
  report.pairs = setup.pairs;
  const std::vector<NamedDistance> distances =
      distancesOf(report.pairs, report.scene, report.kinematics, report.posture.q);
  const auto closest = std::min_element(
      distances.begin(), distances.end(),
      [](const NamedDistance& p, const NamedDistance& q) { return p.distance < q.distance; });
  if (closest != distances.end()) report.closest = *closest;
  std::vector<std::string> more;
  report.ignoresPairs = a.careless;
  if (a.careless) more = collisionsOf(report);
  report.colliding = static_cast<int>(more.size());
  if (const std::string beyond = limitWarning(a.task + ": start", {setup.start}, *report.kinematics,
                                              "the search starts within the limits");
      !beyond.empty())
    more.push_back(beyond);
  if (const std::string open = openParts(*report.scene.geometry); !open.empty())
    more.push_back(report.scene.robot->path + ": " + open);
  if (const std::string allowed = overlapsAllowed(report.task.collisionMargin); !allowed.empty())
    more.push_back(a.task + ": " + allowed);
  report.warnings.insert(report.warnings.end(), more.begin(), more.end());
  if (!a.quiet) tellAll(kProgram, {}, more);
  if (!setup.pairs.empty() && !a.careless) {
    PostureSetup free = setUpWithoutCollisions(report.task, report.scene);
    report.withoutCollisions = findPosture(free, a.options);
  }
  const std::string text = a.format == "json"   ? toJson(report)
                           : a.format == "html" ? toHtml(report)
                                                : toText(report);
  writeOutput(a.output, text);
  if (!report.posture.feasible) return kInfeasible;
  return report.skipped.empty() ? kFeasible : kPartly;
}

}  // namespace

int main(int argc, char** argv) {
  Program program(kDescription, kProgram);
  program.footer(kFooter);
  Arguments arguments;
  describe(program, arguments);
  return program.run(argc, argv, [&] { return run(arguments); });
}
