// urdf_collision_report: which links of a robot come how close, and which pairs need no check.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/report/report_formats.h"
#include "tools/cores.h"
#include "tools/number_check.h"
#include "tools/progress_bar.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::report;
using namespace fcl_stpbv::tools;

enum Exit { kClear = 0, kCollision = 1, kUsage = 2, kPartly = 3 };

constexpr const char* kDescription =
    "Distances between the links of a robot, each covered by its sphere-torus-patch bounding volume "
    "(STP-BV).";

constexpr const char* kFooter =
    R"(With --pose the pairs are reported in that posture, else each in the closest configuration that the samples
and the descents from them found. Pairs that the SRDF leaves out, or without one adjacent and rigidly joined links and
those found in collision everywhere, are not checked; their figures are reported all the same. Lengths are in metres.

Examples:
  urdf_collision_report robot.urdf --srdf robot.srdf --pose zero
  urdf_collision_report robot.urdf --package-path ~/ws/src --samples 10000 --format srdf -o robot.srdf
  urdf_collision_report robot.urdf --srdf robot.srdf --format html -o report.html

Exit status: 0 no checked pair in collision; 1 a collision found; 2 the command line or an input is wrong, or no
pair is checked; 3 no collision found, but --skip-invalid left shapes out.)";

struct Arguments {
  ReportRequest request;
  std::string format = "text", output, r = "auto", R, primitives = "smooth";
  std::vector<std::string> links, flat;
  std::size_t top = 20;
  bool disableDefault = false, noCache = false, quiet = false;
};

void describe(CLI::App& app, Arguments& a) {
  ReportRequest& request = a.request;
  request.search.threads = allCores();
  app.add_option("ROBOT", request.urdf, "The robot's URDF")->required()->type_name("FILE");
  app.add_option("--srdf", request.srdf, "SRDF with pairs to leave out and postures")->type_name("FILE");
  app.add_option("--package-path", request.geometry.packagePath,
                 "Folder that holds packages, for package:// names; may be given again")
      ->type_name("FOLDER")
      ->expected(1)
      ->take_all();
  app.add_option("--pose", request.pose, "A group_state of the SRDF, or a JSON file of joint values");
  app.add_option(
      "--neutral", request.neutral,
      "The neutral posture, as --pose; all joints at zero, or at the limit nearest to it, unless given");
  app.add_option("--samples", request.search.samples, "Random configurations")
      ->check(CLI::Range(1, 100000000))
      ->capture_default_str();
  app.add_option("--seed", request.search.seed, "Of the random configurations")
      ->check(wholeNumber())
      ->capture_default_str();
  app.add_option("--obstacles", request.obstacles, "URDF of a scene to keep clear of")->type_name("FILE");
  app.add_option("-r,--r", a.r,
                 "Radius of the small spheres, the margin, or 'auto': a twentieth of each link's smallest "
                 "width, 1 cm at most")
      ->type_name("LENGTH|auto")
      ->check(numberIn(0, kLargest) | CLI::IsMember({"auto"}))
      ->capture_default_str();
  app.add_option("-R,--R", a.R,
                 "Radius of the big spheres, or 'auto': so large that they add no more than r; without it "
                 "auto where r is, "
                 "else 10")
      ->type_name("LENGTH|auto")
      ->check(numberIn(0, kLargestR, false) | CLI::IsMember({"auto"}));
  app.add_option("--primitives", a.primitives,
                 "smooth: spheres, capsules, boxes and cylinders get smooth covers where a pair has no "
                 "smooth body; flat: none")
      ->check(CLI::IsMember({"smooth", "flat"}))
      ->capture_default_str();
  app.add_option(
         "--over-cover", request.geometry.overCoverBudget,
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
  app.add_option(
         "--polyhedra", request.polyhedra,
         "Folder of polyhedra published for the meshes, MESH-ch.txt or MESH.otp: tells how far they differ")
      ->type_name("FOLDER");
  app.add_flag("--visual", request.geometry.visual, "Use the visual shapes");
  app.add_option("--top", a.top, "Lines of each list in the text, and warnings shown")
      ->check(wholeNumber())
      ->capture_default_str();
  app.add_option("--margin", request.search.margin, "A distance not above it counts as a collision")
      ->check(numberIn(-kLargest, kLargest))
      ->capture_default_str();
  app.add_option("--prove", request.search.proofSeconds, "Seconds to spend on proofs that pairs never meet")
      ->check(numberIn(0, kLargest))
      ->capture_default_str();
  app.add_flag("--disable-default", a.disableDefault,
               "Let an SRDF leave out the pairs that collide in the neutral posture but are clear in others");
  app.add_option("--format", a.format, "text, json, csv, srdf or html")
      ->check(CLI::IsMember({"text", "json", "csv", "srdf", "html"}))
      ->capture_default_str();
  app.add_option("-o,--output", a.output, "File to write instead of standard output")->type_name("OUT");
  app.add_option("-j,--jobs", request.search.threads, "Threads; any number gives the same report")
      ->check(CLI::Range(1, kMostJobs))
      ->capture_default_str();
  app.add_flag("--skip-invalid", request.skipInvalid,
               "Go on without the shapes that are wrong; exit status 3, not 0");
  app.add_flag("--no-cache", a.noCache, "Build every volume, keep none in the cache folder");
  app.add_flag("-q,--quiet", a.quiet, "No progress bar and no warnings");
}

std::string written(const CollisionReport& report, const Arguments& a) {
  if (a.format == "json") return toJson(report);
  if (a.format == "csv") return toCsv(report);
  if (a.format == "srdf") return toSrdfText(report, a.request.srdf, a.disableDefault);
  if (a.format == "html") return toHtml(report);
  return toText(report, a.top);
}

void checkOutput(const Arguments& a) {
  if (a.output.empty() || a.output == "-") return;
  std::error_code ignored;
  const std::filesystem::path parent = std::filesystem::path(a.output).parent_path();
  if (std::filesystem::is_directory(a.output, ignored))
    throw Error("-o " + a.output + ": is a folder, expected a file");
  if (!parent.empty() && !std::filesystem::is_directory(parent, ignored))
    throw Error("-o " + a.output + ": the folder " + parent.string() + " does not exist; make it first");
}

// "NAME=r,R" or "NAME=r,R,OVER_COVER".
void readLink(const std::string& text, GeometryOptions& options) {
  const std::size_t equals = text.rfind('=');
  std::vector<double> values;
  for (const char* at = equals == std::string::npos ? nullptr : text.c_str() + equals; at && *at != '\0';) {
    char* end;
    values.push_back(std::strtod(at + 1, &end));
    at = end != at + 1 && (*end == ',' || *end == '\0') && std::isfinite(values.back()) ? end : nullptr;
    if (!at) values.clear();
  }
  if (values.size() < 2 || values.size() > 3)
    throw Error("--link " + text + ": expected NAME=r,R or NAME=r,R,OVER_COVER with lengths in metres");
  const std::string name = text.substr(0, equals);
  options.links[name] = {values[0], values[1]};
  if (values.size() == 3) options.budgets[name] = values[2];
}

// Lengths or "auto"; R follows r where it is not given.
void setRadii(const Arguments& a, GeometryOptions& geometry) {
  geometry.fitr = a.r == "auto";
  geometry.fitR = a.R.empty() ? geometry.fitr : a.R == "auto";
  if (!geometry.fitr) geometry.radii.r = std::stod(a.r);
  if (!geometry.fitR && !a.R.empty()) geometry.radii.R = std::stod(a.R);
}

// A bar for each of the stages; its steps are only known when it begins.
class Stages {
 public:
  explicit Stages(bool wanted) : wanted_(wanted) {}
  void operator()(std::size_t done, std::size_t all, const std::string& what) {
    if (!bar_ || all != all_) bar_.reset();
    all_ = all;
    if (!bar_) bar_ = std::make_unique<ProgressBar>(all, wanted_);
    bar_->show(done, what);
  }
  void clear() { bar_.reset(); }

 private:
  bool wanted_;
  std::size_t all_ = 0;
  std::unique_ptr<ProgressBar> bar_;
};

void warn(const std::vector<std::string>& warnings, std::size_t top) {
  for (std::size_t i = 0; i < std::min(top, warnings.size()); ++i)
    std::cerr << "urdf_collision_report: " << warnings[i] << "\n";
  if (warnings.size() > top)
    std::cerr << "urdf_collision_report: ... and " << warnings.size() - top
              << " more warnings (--top; the JSON has all)\n";
}

int run(Arguments& a) {
  checkOutput(a);
  setRadii(a, a.request.geometry);
  a.request.flatPrimitives = a.primitives == "flat";
  for (const std::string& link : a.links) readLink(link, a.request.geometry);
  for (const std::string& link : a.flat) {
    if (link == "obstacles")
      a.request.flatObstacles = true;
    else
      a.request.geometry.flatLinks.insert(link);
  }
  if (a.noCache) a.request.geometry.cacheFolder.clear();
  Stages stages(!a.quiet);
  a.request.geometry.progress = a.request.search.progress = std::ref(stages);
  const CollisionReport report = makeReport(a.request);
  stages.clear();
  if (!a.quiet) warn(report.warnings, a.top);
  const std::string text = written(report, a);
  writeOutput(a.output, text);
  if (report.colliding > 0) return kCollision;
  return report.skipped.empty() ? kClear : kPartly;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(kDescription, "urdf_collision_report");
  app.set_version_flag("--version", "urdf_collision_report " FCL_STPBV_VERSION);
  app.footer(kFooter);
  Arguments arguments;
  describe(app, arguments);
  try {
    app.parse(argc, argv);
    return run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kClear : kUsage;
  } catch (const std::bad_alloc&) {
    std::cerr << "urdf_collision_report: not enough memory; give a smaller robot" << std::endl;
    return kUsage;
  } catch (const std::exception& error) {
    std::cerr << "urdf_collision_report: " << error.what() << std::endl;
    return kUsage;
  }
}
