// mesh_to_stpbv: STP-BVs from meshes, clouds of points and volumes in other formats.
#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/worker_pool.h"
#include "tools/conversion.h"
#include "tools/cores.h"
#include "tools/number_check.h"
#include "tools/output_plan.h"
#include "tools/parts_conversion.h"
#include "tools/program.h"
#include "tools/progress_bar.h"
#include "tools/radii_task.h"

namespace {

using namespace fcl_stpbv::tools;

constexpr int kMostParts = 64;  // enough for any link, and each pair of two such links is 4096 queries

enum Exit { kDone = 0, kSomeFailed = 1 };

constexpr const char* kProgram = "mesh_to_stpbv";
constexpr const char* kDescription =
    "Builds the sphere-torus-patch bounding volume (STP-BV) of each input: a smooth, strictly convex body "
    "around its points.";

constexpr const char* kFooter =
    R"(Inputs: STL, OBJ, DAE, PLY, glTF/GLB, OFF and what else assimp reads; polyhedra and point files of qhull's
(*-ch.txt, *.otp, *.qc); three coordinates a line (*.xyz, *.pts); volumes to change the format of (.stpbv,
sch-core's text). Lengths are in metres.

Examples:
  mesh_to_stpbv link.stl -o link.stpbv
  mesh_to_stpbv in_mm.stl --scale 0.001 -r 0.005 -R 5 -o part.stpbv --verify
  mesh_to_stpbv link.dae -o link.stpbv --preview link_stpbv.obj
  mesh_to_stpbv tool.stl -o tool.stpbv --advise clearance=0.004,speed=0.1
  # one volume per mesh, in the folder volumes
  mesh_to_stpbv meshes/*.dae -o volumes
  mesh_to_stpbv meshes/*.dae -o volumes --json -q > report.jsonl
  # torso_0.stpbv, torso_1.stpbv ...: eight parts at most
  mesh_to_stpbv torso.dae --parts 8 -o torso.stpbv
  # the same volume for sch-core
  mesh_to_stpbv link.stpbv --format sch -o link.txt

- as INPUT or OUT is standard input or output; where the volume goes to standard output the report goes to standard error.
An input from a pipe is recognised by its content.

Exit status: 0 all done; 1 some input failed, the others are written; 2 the command line is wrong and nothing is written,
or the report cannot be written.)";

struct Arguments {
  std::vector<std::string> inputs;
  std::string output, format = "stpbv", r, R;
  std::optional<std::string> advise;
  std::optional<int> parts;
  std::optional<double> excess, effort;
  ConversionOptions conversion;
  int jobs = allCores();
  bool json = false, force = false, quiet = false;
};

void describe(Program& app, Arguments& arguments) {
  ConversionOptions& conversion = arguments.conversion;
  app.option("INPUT", arguments.inputs, "Meshes, clouds of points or volumes").required().type("FILE");
  app.option("-o,--output", arguments.output, "File to write; for several inputs a folder, made if missing")
      .required()
      .type("OUT");
  const Option r =
      app.option("-r", arguments.r,
                 "Radius of the small spheres, the margin around the points, or 'auto': a "
                 "twentieth of the smallest width or a 250th of the radius, 1 cm at most [0.01 m]")
          .number(0, kLargest, true, "auto");
  const Option R =
      app.option("-R", arguments.R,
                 "Radius of the big spheres, or 'auto': so large that they add no more than r or "
                 "a 200th of the radius; without it auto where r is, else 10 [m]")
          .number(0, kLargestR, false, "auto");
  Option advise = app.option("--advise", arguments.advise,
                             "The r and R that lose the least space and add at most this acceleration to a "
                             "controller's rows: "
                             "clearance [0.005 m], acceleration [1 m/s^2], speed [0.3 m/s], turning [1 "
                             "rad/s], period [0.001 s], "
                             "distance [0 m], others [flat]")
                      .type("KEY=VALUE,...")
                      .excludes(r)
                      .excludes(R);
  app.option("--scale", conversion.scale, "Factor on the input's coordinates, 0.001 for millimetres")
      .number(0, kLargest, false)
      .shown();
  app.option("--format", arguments.format, "Format to write: this library's own, or sch-core's text [stpbv]")
      .oneOf({"stpbv", "sch"});
  app.option("--preview", conversion.preview, "Also write the surface as a mesh: .obj, .stl, .ply or .glb")
      .type("FILE");
  Option parts =
      app.option(
             "--parts", arguments.parts,
             "At most this many volumes that together cover a mesh that is not convex, each of a convex part")
          .whole(1, kMostParts);
  parts.excludes(advise);
  app.option("--excess", arguments.excess,
             "As few such volumes as keep the parts' hulls this close to the mesh; where none are found the "
             "report says so [m]")
      .number(0, kLargest, false)
      .excludes(advise);
  app.option("--effort", arguments.effort, "Search for the parts this many times as long as usual [1]")
      .number(0.01, 1000);
  app.flag("--verify", conversion.verify,
           "Check each volume before it is written; one that fails is not written");
  app.flag("--json", arguments.json,
           "Report on standard output as JSON, one object a line for each input done");
  app.option("-j,--jobs", arguments.jobs, "Inputs to do at once; the results do not depend on it")
      .whole(1, kMostJobs)
      .shown();
  app.flag("--force", arguments.force, "Replace files that exist");
  app.flag("-q,--quiet", arguments.quiet, "No report for people and no progress bar; errors are still told");
}

// The result of one input: lines for standard output and for standard error.
struct Outcome {
  bool good = false;
  std::string report, complaint;
};

template <class AnyReport>
std::string lineOf(const AnyReport& report, const Arguments& arguments) {
  if (arguments.json) return toJson(report) + "\n";
  return arguments.quiet ? "" : toText(report) + "\n";
}

Outcome runParts(const Job& job, const Arguments& arguments) {
  const PartsReport report = convertToParts(job.input, job.output, arguments.conversion, arguments.force);
  if (!report.verified)
    throw fcl_stpbv::Error(job.input +
                           ": not written, a volume fails its own verification: " + report.verification);
  write(report, arguments.conversion);
  const std::string next = nameOfPart(job.output, static_cast<int>(report.volumes.size()));
  std::error_code ignored;
  const bool stale = std::filesystem::exists(next, ignored);
  return {true, lineOf(report, arguments),
          stale ? next + ": is from an earlier run and not of this mesh's parts; remove it" : ""};
}

Outcome runOne(const Job& job, const Arguments& arguments) {
  if (arguments.conversion.parts) return runParts(job, arguments);
  Report report = convert(job.input, arguments.conversion);
  report.output = job.output;
  if (report.verified.value_or(true)) {
    write(report, arguments.conversion);
    return {true, lineOf(report, arguments), ""};
  }
  return {false, arguments.json ? lineOf(report, arguments) : "",
          job.input + ": not written, the volume fails its own verification: " + report.verification};
}

Outcome runJob(const Job& job, const Arguments& arguments) {
  try {
    return runOne(job, arguments);
  } catch (const std::bad_alloc&) {
    return {false, "", job.input + ": not enough memory; give a smaller input, or fewer --jobs"};
  } catch (const std::exception& error) {
    return {false, "", error.what()};
  }
}

// Does all jobs and reports their results in their order, whatever the number of threads. @return how many
// failed.
std::size_t runAll(const std::vector<Job>& jobs, const Arguments& arguments) {
  // If a volume goes to standard output, nothing else does.
  std::ostream& reports = isStandardOutput(arguments.output) ? std::cerr : std::cout;
  ProgressBar bar(jobs.size(), !arguments.quiet);
  std::vector<std::optional<Outcome>> outcomes(jobs.size());
  std::size_t done = 0, told = 0, failed = 0;
  std::mutex telling;
  const auto show = [&](const std::string& input) {
    // Without the folder, which would take the name's place.
    bar.show(done, std::filesystem::path(input).filename().string());
  };
  show(jobs.front().input);
  fcl_stpbv::detail::shareOut(jobs.size(), std::min(arguments.jobs, kMostJobs), [&](std::size_t i) {
    Outcome outcome = runJob(jobs[i], arguments);
    const std::lock_guard<std::mutex> lock(telling);
    ++done;
    outcomes[i] = std::move(outcome);
    for (; told < jobs.size() && outcomes[told]; ++told) {
      bar.clear();
      reports << outcomes[told]->report << std::flush;
      if (!outcomes[told]->complaint.empty()) tell(kProgram, outcomes[told]->complaint);
      if (!outcomes[told]->good) ++failed;
      *outcomes[told] = {};
    }
    if (told < jobs.size()) show(jobs[told].input);
  });
  bar.clear();
  return failed;
}

// The options about parts. No value if there are none.
std::optional<fcl_stpbv::PartsOptions> partsOf(const Arguments& arguments) {
  if (!arguments.parts && !arguments.excess) {
    if (arguments.effort) throw UsageError("--effort: goes with --parts or --excess");
    return {};
  }
  fcl_stpbv::PartsOptions options;
  options.most = arguments.parts.value_or(kMostParts);
  if (arguments.excess) options.excess = *arguments.excess;
  if (arguments.effort) options.effort = *arguments.effort;
  return options;
}

// The folders that must be created for `folder`, innermost first.
std::vector<std::filesystem::path> missingFolders(std::filesystem::path folder) {
  std::vector<std::filesystem::path> missing;
  std::error_code ignored;
  for (; !folder.empty() && !std::filesystem::exists(folder, ignored); folder = folder.parent_path())
    missing.push_back(folder);
  return missing;
}

int run(Arguments& arguments) {
  arguments.conversion.radii = AskedRadii(arguments.r, arguments.R);
  arguments.conversion.measure = arguments.json || !arguments.quiet;
  arguments.conversion.format = arguments.format == "sch" ? Format::sch : Format::stpbv;
  arguments.conversion.parts = partsOf(arguments);
  if (arguments.advise) arguments.conversion.advise = radiiTask(*arguments.advise);
  const Plan plan =
      fcl_stpbv::tools::plan(arguments.inputs, arguments.output, arguments.conversion, arguments.force);
  std::error_code error;
  const std::vector<std::filesystem::path> missing = missingFolders(plan.folder);
  if (!plan.folder.empty()) std::filesystem::create_directories(plan.folder, error);
  if (error) throw UsageError("-o " + plan.folder + ": this folder cannot be made: " + error.message());

  const std::size_t failed = runAll(plan.jobs, arguments);
  const bool all = failed == plan.jobs.size();
  if (all)
    for (const std::filesystem::path& folder : missing) std::filesystem::remove(folder, error);
  if (failed > 0 && plan.jobs.size() > 1)
    tell(kProgram, (all ? "all " : std::to_string(failed) + " of ") + std::to_string(plan.jobs.size()) +
                       " inputs failed, " + (all ? "nothing is written" : "the others are written"));
  return failed > 0 ? kSomeFailed : kDone;
}

}  // namespace

int main(int argc, char** argv) {
  Program program(kDescription, kProgram);
  program.footer(kFooter);
  Arguments arguments;
  describe(program, arguments);
  return program.run(argc, argv, [&] { return run(arguments); });
}
