// 1. computes the key of the inputs: their SHA-256 and the options. If the folder has that key, there is
//    nothing to do;
// 2. makes the report, with the links split for all their pairs (collision_report.h);
// 3. computes the key again: no input may have changed meanwhile;
// 4. writes the files (part_files.h), all at once.
#include "fcl_stpbv/report/robot_conversion.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/mesh/passing_error.h"
#include "fcl_stpbv/report/digest.h"
#include "fcl_stpbv/report/kept_folder.h"
#include "fcl_stpbv/report/part_files.h"

namespace fcl_stpbv::report {
namespace {

using namespace detail;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

// The inputs are read more than once, so a pipe is refused. A folder is refused where it is read as a file; a
// state of the SRDF may have its name.
void requireNoPipe(const std::string& path) {
  std::error_code ignored;
  if (path == "-" ||
      (fs::exists(path, ignored) && !fs::is_regular_file(path, ignored) && !fs::is_directory(path, ignored)))
    throw Error(path + ": is no regular file, and it is read more than once; save it as one first");
}

ordered_json optionsOf(const RobotConversion& conversion) {
  const ReportRequest& report = conversion.report;
  const GeometryOptions& g = report.files.geometry;
  ordered_json json;
  json["parts"] = report.partsAuto ? ordered_json("auto") : ordered_json(report.partsAll);
  json["r"] = g.fitSmallRadius ? ordered_json("auto") : ordered_json(g.radii.r);
  json["R"] = g.fitBigRadius ? ordered_json("auto") : ordered_json(g.radii.R);
  if (g.advice)
    json["advise"] = {g.advice->clearance, g.advice->acceleration, g.advice->speed,    g.advice->turning,
                      g.advice->period,    g.advice->distance,     g.advice->bothRound};
  json["over_cover"] = g.overCoverBudget;
  for (const auto& [name, radii] : g.links) json["links"][name] = {radii.r, radii.R};
  for (const auto& [name, budget] : g.budgets) json["budgets"][name] = budget;
  json["flat"] = g.flatLinks;
  json["flat_obstacles"] = report.files.flatObstacles;
  json["flat_primitives"] = report.files.flatPrimitives;
  json["visual"] = g.visual;
  json["skip_invalid"] = report.files.skipInvalid;
  json["samples"] = report.search.samples;
  json["seed"] = report.search.seed;
  json["margin"] = report.search.margin;
  json["prove"] = report.search.proofSeconds;
  json["disable_default"] = conversion.disableDefault;
  json["mesh_prefix"] = conversion.meshPrefix;
  return json;
}

// All inputs that determine the output. `read` receives the names of the files that were read.
ordered_json inputsOf(const RobotConversion& conversion, std::vector<std::string>& read) {
  const RobotFiles& files = conversion.report.files;
  const std::string& neutral = conversion.report.neutral;
  for (const std::string& path : {files.urdf, files.srdf, files.obstacles, neutral}) requireNoPipe(path);
  RobotLoader loader(files);
  loader.read();
  loader.faults().refuse(files.skipInvalid);
  ordered_json inputs;
  const auto add = [&](const char* what, const std::string& path) {
    if (path.empty()) return;
    read.push_back(path);
    inputs[what] = {{"file", path}, {"sha256", sha256(readText(path))}};
  };
  inputs["version"] = FCL_STPBV_VERSION;
  inputs["writer"] = 7;  // changed when the same inputs give other files
  add("urdf", files.urdf);
  // The names of visual meshes and textures are written relative to the new folder, so the key changes if it
  // is moved.
  std::error_code ignored;
  const fs::path home = fs::absolute(files.urdf).parent_path();
  inputs["urdf"]["from_folder"] = fs::relative(home, fs::absolute(conversion.folder), ignored).string();
  add("srdf", files.srdf);
  add("obstacles", files.obstacles);
  if (fs::is_regular_file(neutral, ignored))
    add("neutral", neutral);
  else if (!neutral.empty())
    inputs["neutral"] = {{"state", neutral}};  // of the SRDF
  for (const ShapeSources* sources : {&loader.shapes(), &loader.sceneShapes()}) {
    for (const ShapeSource& source : sources->shapes) {
      if (source.file.empty()) continue;
      read.push_back(source.file);
      inputs["meshes"].push_back({source.file, source.key});
    }
  }
  inputs["left_out"] = loader.skipped();
  inputs["options"] = optionsOf(conversion);
  return inputs;
}

// The report reads the inputs again after their key was computed. If one was saved meanwhile, the folder
// would be up to date with a file that it was not made from.
void requireUnchanged(const ordered_json& before, const ordered_json& after, const CollisionReport& report) {
  for (const char* what : {"urdf", "srdf", "obstacles", "neutral"})
    if (before.contains(what) && before[what].contains("file") && before[what] != after[what])
      refuseChanged(before[what]["file"]);
  const ordered_json meshes = before.value("meshes", ordered_json::array());
  const ordered_json again = after.value("meshes", ordered_json::array());
  for (std::size_t i = 0; i < meshes.size(); ++i)
    if (i >= again.size() || meshes[i] != again[i]) refuseChanged(meshes[i][0]);
  for (const Body& body : report.geometry->bodies)
    if (!body.file.empty() &&
        std::count(meshes.begin(), meshes.end(), ordered_json{body.file, body.meshKey}) == 0)
      refuseChanged(body.file);
  if (before != after) refuseChanged(before["urdf"]["file"]);
}

}  // namespace

ConversionResult convertRobot(const RobotConversion& conversion) {
  const std::string& prefix = conversion.meshPrefix;
  if (!prefix.empty() && prefix.back() != '/')
    throw Error("--mesh-prefix " + prefix + ": expected a / at its end, as the meshes' names follow it");
  ConversionResult result;
  std::vector<std::string> read;
  const ordered_json inputs = inputsOf(conversion, read);
  const std::string key = sha256(inputs.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
  const std::string kept = keyOfFolder(conversion.folder, read, conversion.force);
  if (kept == key && !conversion.force) {
    result.upToDate = true;
    for (const auto& shape : inputs["left_out"]) result.skipped.push_back(shape);
    result.warnings = warningsOfFolder(conversion.folder);
    result.summary = conversion.folder + " is up to date";
    return result;
  }
  ReportRequest request = conversion.report;
  request.partsForAllPairs = true;
  request.mayCheckNothing = true;  // a gripper of one link has parts, too
  requireFolderPlace(conversion.folder);
  const CollisionReport report = makeReport(request);
  PartFiles output(conversion, report);
  const FolderFiles files = output.make(inputs, key);
  // The report took a while. Meanwhile no file of the user may have come into the folder.
  keyOfFolder(conversion.folder, read, conversion.force);
  requireUnchanged(inputs, inputsOf(conversion, read), report);
  atomicWriteFolder(conversion.folder, files);
  result.warnings = report.warnings;
  result.skipped = report.skipped;
  const auto& bodies = report.geometry->bodies;
  const bool split =
      std::any_of(bodies.begin(), bodies.end(), [](const Body& body) { return body.partOf >= 0; });
  const std::string parts =
      output.parts() == 0
          ? "no meshes"
          : counted(static_cast<std::size_t>(output.parts()), "convex part") +
                (split ? "" : ", no link was split") +
                formatted(", their volumes within %.3f mm of the meshes", output.excess() * 1e3);
  result.summary = formatted("%s: %s; %d of %zu pairs checked -> %s", report.robot->name.c_str(),
                             parts.c_str(), report.checked, report.pairs.size(), conversion.folder.c_str());
  return result;
}

}  // namespace fcl_stpbv::report
