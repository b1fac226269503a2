// See robot_options.h.
#include "tools/robot_options.h"

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/robot/package_path.h"
#include "tools/asked_radii.h"
#include "tools/number_check.h"
#include "tools/output_plan.h"
#include "tools/radii_task.h"

namespace fcl_stpbv::tools {
namespace {

namespace fs = std::filesystem;

void describeFiles(Program& app, RobotArguments& a) {
  report::RobotFiles& files = a.files;
  app.option("ROBOT", files.urdf, "The robot's URDF").required().type("FILE");
  app.option("--srdf", files.srdf, "SRDF with pairs to leave out and postures").type("FILE");
  app.option("--obstacles", files.obstacles, "URDF of a scene to keep clear of").type("FILE");
  app.option("--package-path", files.geometry.packagePath,
             "Folder that holds packages, for package:// names; may be given again")
      .type("FOLDER")
      .repeated();
  app.flag("--visual", files.geometry.visual, "Use the visual shapes");
  app.flag("--skip-invalid", files.skipInvalid,
           "Go on without the shapes that are wrong; exit status 3, not 0");
  app.flag("--no-cache", a.noCache, "Build and search everything anew, keep nothing in the cache folder");
  app.option("-j,--jobs", a.jobs, "Threads; the result does not depend on their number")
      .whole(1, kMostJobs)
      .shown();
}

void describeBodies(Program& app, RobotArguments& a) {
  const Option r =
      app.option("-r,--r", a.r,
                 "Radius of the small spheres, the margin, or 'auto': a twentieth of each link's smallest "
                 "width or a 250th of its radius, 1 cm at most")
          .number(0, kLargest, true, "auto")
          .shown();
  const Option R =
      app.option("-R,--R", a.R,
                 "Radius of the big spheres, or 'auto': so large that they add no more than r or "
                 "a 200th of the link's radius; without it auto where r is, else 10")
          .number(0, kLargestR, false, "auto");
  Option advise =
      app.option("--advise", a.advise,
                 "Instead of -r and -R, choose both for each link's meshes from a controller's task: "
                 "clearance that the volume may take up [0.005 m], acceleration that its shape may "
                 "add to a collision row [1 m/s^2], speed [0.3 m/s] and turning [1 rad/s] of the "
                 "bodies at their witness points, control period [0.001 s], distance that is kept "
                 "[0 m], others flat or round [flat]")
          .type("KEY=VALUE,...")
          .excludes(r)
          .excludes(R);
  app.option("--primitives", a.primitives,
             "smooth: spheres, capsules, boxes and cylinders get smooth covers where a pair has no "
             "smooth body; flat: none")
      .oneOf({"smooth", "flat"})
      .shown();
  advise.excludes(
      app.option("--over-cover", a.files.geometry.overCoverBudget,
                 "Most that a volume may exceed its mesh's hull by; spends it on fewer vertices, 0 for no "
                 "limit")
          .number(0, kLargest)
          .shown());
  app.option("--link", a.links, "Values of a single link; may be given again")
      .type("NAME=r,R[,OVER_COVER]")
      .repeated();
  app.option(
         "--flat", a.flat,
         "Link whose meshes stay convex polyhedra, or 'obstacles' for those of the scene; may be given again")
      .type("NAME")
      .repeated();
}

// Reads one of the numbers of --link.
double lengthOf(const std::string& option, const std::string& text, double most, bool orZero) {
  const std::string wrong = wrongNumber(text, 0, most, orZero);
  if (!wrong.empty()) throw Error(option + ": " + wrong);
  return numberIn(text);
}

// Reads "NAME=r,R" or "NAME=r,R,OVER_COVER". The name may contain '='; the last one counts.
void readLink(const std::string& text, GeometryOptions& options) {
  const std::string option = "--link " + text;
  const std::size_t equals = text.rfind('=');
  const std::vector<std::string> values =
      splitAtCommas(equals == std::string::npos ? "" : text.substr(equals + 1));
  if (values.size() < 2 || values.size() > 3)
    throw Error(option + ": expected NAME=r,R or NAME=r,R,OVER_COVER with lengths in metres");
  const std::string name = text.substr(0, equals);
  const StpBvOptions radii{lengthOf(option, values[0], kLargest, true),
                           lengthOf(option, values[1], kLargestR, false)};
  if (radii.R <= radii.r) throw Error(option + ": R must be larger than r");
  if (!options.links.emplace(name, radii).second)
    throw Error(option + ": the link has values already; give one --link for each");
  if (values.size() == 3) options.budgets[name] = lengthOf(option, values[2], kLargest, true);
}

void setRadii(const RobotArguments& a, GeometryOptions& geometry) {
  const AskedRadii asked(a.r, a.R);
  geometry.fitSmallRadius = asked.fitSmallRadius;
  geometry.fitBigRadius = asked.fitBigRadius;
  geometry.radii = asked.lengths();
  if (!asked.fits() && geometry.radii.R <= geometry.radii.r)
    throw Error("-r " + a.r + (a.R.empty() ? "" : " -R " + a.R) +
                ": R must be larger than r; it is 10 unless given");
}

void readFlat(const std::string& name, report::RobotFiles& files) {
  if (name == "obstacles") {
    if (files.obstacles.empty())
      throw Error("--flat obstacles: there are no obstacles; give their URDF with --obstacles");
    files.flatObstacles = true;
    return;
  }
  if (files.geometry.links.count(name) > 0)
    throw Error("--flat " + name + ": --link gives the same link r and R, which flat meshes do not have; " +
                "leave one of the two out");
  files.geometry.flatLinks.insert(name);
}

// The mesh files of a robot. Errors in the robot are reported when it is loaded. A pipe is not read here,
// because it can be read only once.
std::vector<std::string> meshesOf(const std::string& urdf, const std::vector<std::string>& packagePath) {
  std::vector<std::string> files;
  std::error_code ignored;
  if (!fs::is_regular_file(urdf, ignored)) return files;
  LoadFaults faults;
  LoadFaults::gather(faults.errors, [&] {
    const RobotModel robot = loadUrdf(urdf, faults);
    const detail::PackagePath paths(urdf, packagePath);
    for (const LinkModel& link : robot.links)
      for (const auto* shapes : {&link.collision, &link.visual})
        for (const ShapeModel& shape : *shapes)
          if (shape.kind == ShapeModel::Kind::mesh)
            LoadFaults::gather(faults.shapes, [&] { files.push_back(paths.resolve(shape.mesh)); });
  });
  return files;
}

// The file that a warning begins with, "" if it begins with none.
std::string fileOf(const std::string& warning) {
  const std::string file = warning.substr(0, warning.find(": "));
  std::error_code ignored;
  return fs::exists(file, ignored) ? file : "";
}

}  // namespace

void describeRobot(Program& app, RobotArguments& arguments) {
  describeFiles(app, arguments);
  describeBodies(app, arguments);
}

void describeSearch(Program& app, SearchArguments& a) {
  PairListOptions& search = a.request.search;
  app.option(
      "--neutral", a.request.neutral,
      "The neutral posture, a group_state or a JSON file; all joints at zero, or at the limit nearest to "
      "it, unless given");
  app.option("--samples", search.samples, "Random configurations").whole(1, 100000000).shown();
  app.option("--seed", search.seed, "Of the random configurations").whole().shown();
  app.option(
         "--parts", a.parts,
         "Convex parts of concave links: none; auto, where a pair collides by its hulls alone; or a number, "
         "at most so many of every link")
      .shown();
  app.option("--margin", search.margin, "A distance not above it counts as a collision")
      .number(-kLargest, kLargest)
      .shown();
  app.option("--prove", search.proofSeconds, "Seconds to spend on proofs that pairs never collide")
      .number(0, kLargest)
      .shown();
  app.flag("--disable-default", a.disableDefault,
           "Let an SRDF leave out the pairs that collide in the neutral posture, or nearly always, but are "
           "clear elsewhere");
}

std::pair<bool, int> partsAsked(const std::string& parts) {
  constexpr int kMost = 64;  // more parts would make too many rows
  if (parts == "none" || parts == "auto") return {parts == "auto", 1};
  const bool digits =
      !parts.empty() && parts.size() < 3 && parts.find_first_not_of("0123456789") == std::string::npos;
  const int most = digits ? std::stoi(parts) : 0;
  if (most < 2 || most > kMost)
    throw Error("--parts " + parts + ": expected none, auto or a whole number from 2 to " +
                std::to_string(kMost));
  return {false, most};
}

report::ReportRequest requestOf(const RobotArguments& robot, const SearchArguments& search,
                                const Progress& progress) {
  report::ReportRequest request = search.request;
  request.files = filesOf(robot);
  request.search.threads = robot.jobs;
  request.files.geometry.progress = request.search.progress = progress;
  std::tie(request.partsAuto, request.partsAll) = partsAsked(search.parts);
  return request;
}

report::RobotFiles filesOf(const RobotArguments& arguments) {
  report::RobotFiles files = arguments.files;
  setRadii(arguments, files.geometry);
  if (!arguments.advise.empty()) files.geometry.advice = radiiTask(arguments.advise);
  files.flatPrimitives = arguments.primitives == "flat";
  for (const std::string& link : arguments.links) readLink(link, files.geometry);
  for (const std::string& name : arguments.flat) readFlat(name, files);
  for (const std::string& folder : files.geometry.packagePath) {
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored))
      throw Error("--package-path " + folder + ": is no folder; give one that holds packages");
  }
  if (arguments.noCache) files.geometry.cacheFolder.clear();
  files.geometry.threads = arguments.jobs;
  return files;
}

void tellAll(const std::string& program, const std::vector<std::string>& skipped,
             const std::vector<std::string>& warnings, std::size_t top) {
  for (const std::string& shape : skipped) tell(program, "left out and not checked: " + shape);
  const std::size_t more = warnings.size() - std::min(top, warnings.size());
  const auto end = warnings.end() - static_cast<std::ptrdiff_t>(more);
  for (auto first = warnings.begin(), next = first; first != end; first = next) {
    const std::string file = fileOf(*first);
    next = std::find_if(first + 1, end, [&](const auto& w) { return file.empty() || fileOf(w) != file; });
    std::string text = next == first + 1 ? *first : file + ":";
    for (auto w = first; next != first + 1 && w != next; ++w) text += "\n  " + w->substr(file.size() + 2);
    tell(program, text);
  }
  if (more > 0)
    tell(program, "... and " + detail::counted(more, "more warning") + " (--top; the JSON has all)");
}

void checkOutput(const std::string& path, const report::RobotFiles& robot,
                 const std::vector<std::string>& others) {
  if (path.empty() || path == "-") return;
  std::error_code ignored;
  detail::requireWritable(path, "-o " + path);
  if (!fs::is_regular_file(path, ignored)) return;
  requireNoInput("-o", path, others);
  requireNoInput("-o", path, {robot.urdf, robot.srdf, robot.obstacles});
  for (const std::string& urdf : {robot.urdf, robot.obstacles})
    requireNoInput("-o", path, meshesOf(urdf, robot.geometry.packagePath));
}

}  // namespace fcl_stpbv::tools
