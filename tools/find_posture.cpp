// find_posture: joint values for a task, free of collisions, or which of its constraints cannot hold
// together.
#include <CLI/CLI.hpp>
#include <exception>
#include <filesystem>
#include <iostream>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/report/posture_formats.h"
#include "fcl_stpbv/report/robot_files.h"
#include "tools/number_check.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::report;
using namespace fcl_stpbv::tools;

enum Exit { kFeasible = 0, kInfeasible = 1, kUsage = 2, kPartly = 3 };

constexpr const char* kDescription =
    "A posture of a robot that does a task free of collisions, by constrained optimisation with the smooth "
    "distance "
    "of sphere-torus-patch bounding volumes (STP-BV).";

constexpr const char* kFooter =
    R"(TASK is a JSON file: where to start, what to place where, contacts for static stability, pairs to keep apart
(docs/posture.md). Lengths are in metres, angles in radians.

Examples:
  find_posture hrp2_style.urdf pick_can.json --srdf hrp2_style.srdf --obstacles fridge.urdf
  find_posture robot.urdf task.json --starts 20 --format json -o posture.json

Without an SRDF the robot's own pairs are found as urdf_collision_report does.

Exit status: 0 a posture was found; 1 none was found; 2 the command line or an input is wrong, or no pair is checked;
3 a posture was found, but --skip-invalid left shapes out.)";

struct Arguments {
  std::string urdf, task, srdf, obstacles, format = "text", output;
  GeometryOptions geometry;
  PostureOptions options;
  bool skipInvalid = false, careless = false, noCache = false, quiet = false;
};

void describe(CLI::App& app, Arguments& a) {
  app.add_option("ROBOT", a.urdf, "The robot's URDF")->required()->type_name("FILE");
  app.add_option("TASK", a.task, "The task's JSON file")->required()->type_name("FILE");
  app.add_option("--srdf", a.srdf, "SRDF with pairs to leave out and postures")->type_name("FILE");
  app.add_option("--obstacles", a.obstacles, "URDF of a scene to keep clear of")->type_name("FILE");
  app.add_option("--package-path", a.geometry.packagePath,
                 "Folder that holds packages, for package:// names; may be given again")
      ->type_name("FOLDER")
      ->expected(1)
      ->take_all();
  app.add_option("--starts", a.options.starts, "Starts to try: the task's own, then random ones near it")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  app.add_option("--seed", a.options.seed, "Of the random starts")
      ->check(wholeNumber())
      ->capture_default_str();
  app.add_option("-r", a.geometry.radii.r, "Radius of the small spheres, the margin")
      ->check(numberIn(0, kLargest))
      ->capture_default_str();
  app.add_option("-R", a.geometry.radii.R, "Radius of the big spheres")
      ->check(numberIn(0, kLargestR, false))
      ->capture_default_str();
  app.add_option("--format", a.format, "text, json or html")
      ->check(CLI::IsMember({"text", "json", "html"}))
      ->capture_default_str();
  app.add_option("-o,--output", a.output, "File to write instead of standard output")->type_name("OUT");
  app.add_flag("--ignore-collisions", a.careless, "Solve without the pairs, which are reported all the same");
  app.add_flag("--skip-invalid", a.skipInvalid,
               "Go on without the shapes that are wrong; exit status 3, not 0");
  app.add_flag("--no-cache", a.noCache, "Build every volume, keep none in the cache folder");
  app.add_flag("-q,--quiet", a.quiet, "No warnings");
}

void load(const Arguments& a, PostureReport& report) {
  RobotLoader loader({a.urdf, a.srdf, a.obstacles, a.geometry, a.geometry, a.skipInvalid});
  loader.read();
  loader.build();
  PostureScene& scene = report.scene;
  scene.robot = loader.robot();
  scene.srdf = loader.srdf();
  scene.geometry = loader.geometry();
  if (loader.scene()) scene.obstacles = obstaclesOf(loader.scene(), loader.sceneGeometry());
  if (!scene.srdf) scene.selfPairs = searchedPairs(scene.robot, scene.geometry);
  report.warnings = loader.warnings();
  report.skipped = loader.skipped();
  if (!a.quiet)
    for (const std::string& warning : report.warnings) std::cerr << "find_posture: " << warning << std::endl;
}

int run(Arguments& a) {
  if (!a.output.empty() && std::filesystem::is_directory(a.output))
    throw Error("-o " + a.output + ": is a folder, expected a file");
  if (a.noCache) a.geometry.cacheFolder.clear();
  PostureReport report;
  report.task = loadTask(a.task);
  load(a, report);
  PostureSetup setup = setUp(report.task, report.scene);
  if (!a.careless)
    requirePairs(setup.pairs.size(), *report.scene.robot,
                 "the task and the robot's joints leave none; --ignore-collisions solves without");
  if (a.careless) setup.problem = setUpWithoutCollisions(report.task, report.scene).problem;
  report.kinematics = std::make_shared<const Kinematics>(setup.problem->kinematics());
  report.pairs = setup.pairs;
  report.posture = findPosture(setup, a.options);
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
  CLI::App app(kDescription, "find_posture");
  app.set_version_flag("--version", "find_posture " FCL_STPBV_VERSION);
  app.footer(kFooter);
  Arguments arguments;
  describe(app, arguments);
  try {
    app.parse(argc, argv);
    return run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kFeasible : kUsage;
  } catch (const std::bad_alloc&) {
    std::cerr << "find_posture: not enough memory; give a smaller robot" << std::endl;
    return kUsage;
  } catch (const std::exception& error) {
    std::cerr << "find_posture: " << error.what() << std::endl;
    return kUsage;
  }
}
