// See robot_options.h.
#include "tools/robot_options.h"

#include <filesystem>

#include "fcl_stpbv/error.h"
#include "tools/number_check.h"

namespace fcl_stpbv::tools {
namespace {

void describeFiles(CLI::App& app, RobotArguments& a) {
  report::RobotFiles& files = a.files;
  app.add_option("ROBOT", files.urdf, "The robot's URDF")->required()->type_name("FILE");
  app.add_option("--srdf", files.srdf, "SRDF with pairs to leave out and postures")->type_name("FILE");
  app.add_option("--obstacles", files.obstacles, "URDF of a scene to keep clear of")->type_name("FILE");
  app.add_option("--package-path", files.geometry.packagePath,
                 "Folder that holds packages, for package:// names; may be given again")
      ->type_name("FOLDER")
      ->expected(1)
      ->take_all();
  app.add_flag("--visual", files.geometry.visual, "Use the visual shapes");
  app.add_flag("--skip-invalid", files.skipInvalid,
               "Go on without the shapes that are wrong; exit status 3, not 0");
  app.add_flag("--no-cache", a.noCache, "Build every volume, keep none in the cache folder");
}

void describeBodies(CLI::App& app, RobotArguments& a) {
  app.add_option("-r,--r", a.r,
                 "Radius of the small spheres, the margin, or 'auto': a twentieth of each link's smallest "
                 "width, 1 cm at most")
      ->type_name("LENGTH|auto")
      ->check(numberIn(0, kLargest) | CLI::IsMember({"auto"}))
      ->capture_default_str();
  app.add_option("-R,--R", a.R,
                 "Radius of the big spheres, or 'auto': so large that they add no more than r; without it "
                 "auto where r is, else 10")
      ->type_name("LENGTH|auto")
      ->check(numberIn(0, kLargestR, false) | CLI::IsMember({"auto"}));
  app.add_option("--primitives", a.primitives,
                 "smooth: spheres, capsules, boxes and cylinders get smooth covers where a pair has no "
                 "smooth body; flat: none")
      ->check(CLI::IsMember({"smooth", "flat"}))
      ->capture_default_str();
  app.add_option(
         "--over-cover", a.files.geometry.overCoverBudget,
         "Most that a volume may exceed its mesh's hull by; spends it on fewer vertices, 0 for no limit")
      ->check(numberIn(0, kLargest))
      ->capture_default_str();
  app.add_option("--link", a.links, "Values of a single link; may be given again")
      ->type_name("NAME=r,R[,OVER_COVER]")
      ->expected(1)
      ->take_all();
  app.add_option(
         "--flat", a.flat,
         "Link whose meshes stay convex polyhedra, or 'obstacles' for those of the scene; may be given again")
      ->type_name("NAME")
      ->expected(1)
      ->take_all();
}

// One of the numbers of --link.
double lengthOf(const std::string& option, std::string text, const CLI::Validator& range) {
  const std::string wrong = range(text);
  if (!wrong.empty()) throw Error(option + ": " + wrong);
  return std::stod(text);
}

// "NAME=r,R" or "NAME=r,R,OVER_COVER". A name may hold '='; the last one counts.
void readLink(const std::string& text, GeometryOptions& options) {
  const std::string option = "--link " + text;
  const std::size_t equals = text.rfind('=');
  const auto values = CLI::detail::split(equals == std::string::npos ? "" : text.substr(equals + 1), ',');
  if (values.size() < 2 || values.size() > 3)
    throw Error(option + ": expected NAME=r,R or NAME=r,R,OVER_COVER with lengths in metres");
  const std::string name = text.substr(0, equals);
  const StpBvOptions radii{lengthOf(option, values[0], numberIn(0, kLargest)),
                           lengthOf(option, values[1], numberIn(0, kLargestR, false))};
  if (radii.R <= radii.r) throw Error(option + ": R must be larger than r");
  if (!options.links.emplace(name, radii).second)
    throw Error(option + ": the link has values already; give one --link for each");
  if (values.size() == 3) options.budgets[name] = lengthOf(option, values[2], numberIn(0, kLargest));
}

// Lengths or "auto"; R follows r where it is not given.
void setRadii(const RobotArguments& a, GeometryOptions& geometry) {
  geometry.fitr = a.r == "auto";
  geometry.fitR = a.R.empty() ? geometry.fitr : a.R == "auto";
  if (!geometry.fitr) geometry.radii.r = std::stod(a.r);
  if (!geometry.fitR && !a.R.empty()) geometry.radii.R = std::stod(a.R);
  if (!geometry.fitr && !geometry.fitR && geometry.radii.R <= geometry.radii.r)
    throw Error("-r " + a.r + (a.R.empty() ? "" : " -R " + a.R) +
                ": R must be larger than r; it is 10 unless given");
}

}  // namespace

void describeRobot(CLI::App& app, RobotArguments& arguments) {
  describeFiles(app, arguments);
  describeBodies(app, arguments);
}

report::RobotFiles filesOf(const RobotArguments& arguments) {
  report::RobotFiles files = arguments.files;
  setRadii(arguments, files.geometry);
  files.flatPrimitives = arguments.primitives == "flat";
  for (const std::string& link : arguments.links) readLink(link, files.geometry);
  for (const std::string& link : arguments.flat) {
    if (link == "obstacles")
      files.flatObstacles = true;
    else
      files.geometry.flatLinks.insert(link);
  }
  if (arguments.noCache) files.geometry.cacheFolder.clear();
  return files;
}

void checkOutput(const std::string& path) {
  if (path.empty() || path == "-") return;
  std::error_code ignored;
  const std::filesystem::path parent = std::filesystem::path(path).parent_path();
  if (std::filesystem::is_directory(path, ignored))
    throw Error("-o " + path + ": is a folder, expected a file");
  if (!parent.empty() && !std::filesystem::is_directory(parent, ignored))
    throw Error("-o " + path + ": the folder " + parent.string() + " does not exist; make it first");
}

}  // namespace fcl_stpbv::tools
