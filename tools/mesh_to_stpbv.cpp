// mesh_to_stpbv: STP-BVs from meshes, clouds of points and volumes in other formats.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "fcl_stpbv/error.h"
#include "tools/conversion.h"
#include "tools/output_plan.h"
#include "tools/parts_conversion.h"
#include "tools/progress_bar.h"

namespace {

using namespace fcl_stpbv::tools;

constexpr int kMostParts = 64;  // enough for any link, and each pair of two such links is 4096 queries

enum Exit { kDone = 0, kSomeFailed = 1, kUsage = 2 };

constexpr const char* kDescription =
    "Builds the sphere-torus-patch bounding volume (STP-BV) of each input: a smooth, strictly convex body "
    "around its points.";

constexpr const char* kFooter =
    R"(Inputs: STL, OBJ, DAE, PLY, glTF/GLB, OFF and what else assimp reads; polyhedra and point files of qhull's
(*-ch.txt, *.otp); volumes to change the format of (.stpbv, sch-core's text). Lengths are in metres.

Examples:
  mesh_to_stpbv link.stl -o link.stpbv
  mesh_to_stpbv part_in_mm.stl --scale 0.001 -r 0.005 -R 5 -o part.stpbv --verify
  mesh_to_stpbv meshes/*.dae -o volumes              one volume per mesh, in the folder volumes
  mesh_to_stpbv link.dae -o link.stpbv --preview link_stpbv.obj
  mesh_to_stpbv torso.dae --parts 8 -o torso.stpbv   torso_0.stpbv, torso_1.stpbv ...: eight parts at most
  mesh_to_stpbv link.stpbv --format sch -o link.txt  the same volume for sch-core
  mesh_to_stpbv meshes/*.dae -o volumes --json -q > report.jsonl

Exit status: 0 all done; 1 some input failed, the others are written; 2 the command line is wrong, nothing is written.)";

struct Arguments {
  std::vector<std::string> inputs;
  std::string output;
  ConversionOptions conversion;
  bool json = false, force = false, quiet = false;
};

void describe(CLI::App& app, Arguments& arguments) {
  ConversionOptions& conversion = arguments.conversion;
  app.add_option("INPUT", arguments.inputs, "Meshes, clouds of points or volumes")
      ->required()
      ->type_name("FILE");
  app.add_option("-o,--output", arguments.output,
                 "File to write; for several inputs a folder, made if missing")
      ->required()
      ->type_name("OUT");
  app.add_option("-r", conversion.r, "Radius of the small spheres, the margin around the points [0.01 m]");
  app.add_option("-R", conversion.R, "Radius of the big spheres [10 m]");
  app.add_option("--scale", conversion.scale, "Factor on the input's coordinates, 0.001 for millimetres")
      ->capture_default_str();
  app.add_option_function<std::string>(
         "--format",
         [&](const std::string& name) { conversion.format = name == "sch" ? Format::sch : Format::stpbv; },
         "Format to write: stpbv, this library's own, or sch, sch-core's text [stpbv]")
      ->check(CLI::IsMember({"stpbv", "sch"}))
      ->type_name("");
  app.add_option("--preview", conversion.preview,
                 "Also write the surface as a mesh: .obj, .stl, .ply or .glb")
      ->type_name("FILE");
  const auto parts = [&]() -> fcl_stpbv::PartsOptions& {
    if (!conversion.parts) conversion.parts.emplace().most = 0;
    return *conversion.parts;
  };
  app.add_option_function<int>(
         "--parts", [=](int most) { parts().most = most; },
         "At most this many volumes that together cover a mesh that is not convex, each of a convex part")
      ->check(CLI::Range(1, kMostParts))
      ->type_name("K");
  app.add_option_function<double>(
         "--excess", [=](double excess) { parts().excess = excess; },
         "As few such volumes as keep the parts' hulls this close to the mesh, about [m]")
      ->check(CLI::PositiveNumber)
      ->type_name("M");
  app.add_option_function<double>(
         "--effort", [=](double effort) { parts().effort = effort; },
         "Search for the parts this many times as long as usual [1]")
      ->check(CLI::Range(0.01, 1000.0))
      ->type_name("E");
  app.add_flag("--verify", conversion.verify,
               "Check each volume before it is written; one that fails is not written");
  app.add_flag("--json", arguments.json,
               "Report on standard output as JSON, one object a line for each input done");
  app.add_flag("--force", arguments.force, "Replace files that exist");
  app.add_flag("-q,--quiet", arguments.quiet,
               "No report for people and no progress bar; errors are still told");
}

void tell(const std::string& message) { std::cerr << "mesh_to_stpbv: " << message << std::endl; }

template <class AnyReport>
void show(const AnyReport& report, const Arguments& arguments, ProgressBar& bar) {
  bar.clear();
  if (arguments.json) {
    std::cout << toJson(report) << std::endl;
  } else if (!arguments.quiet) {
    std::cout << toText(report) << std::endl;
  }
}

bool runParts(const Job& job, const Arguments& arguments, ProgressBar& bar) {
  const PartsReport report = convertToParts(job.input, job.output, arguments.conversion, arguments.force);
  if (!report.verified)
    throw fcl_stpbv::Error(job.input +
                           ": not written, a volume fails its own verification: " + report.verification);
  write(report, arguments.conversion);
  show(report, arguments, bar);
  return true;
}

bool runJob(const Job& job, const Arguments& arguments, ProgressBar& bar) {
  try {
    if (arguments.conversion.parts) return runParts(job, arguments, bar);
    Report report = convert(job.input, arguments.conversion);
    report.output = job.output;
    const bool good = report.verified.value_or(true);
    if (good) write(report, arguments.conversion);
    bar.clear();
    if (arguments.json) {
      std::cout << toJson(report) << std::endl;
    } else if (!arguments.quiet && good) {
      std::cout << toText(report) << std::endl;
    }
    if (!good)
      tell(job.input + ": not written, the volume fails its own verification: " + report.verification);
    return good;
  } catch (const std::bad_alloc&) {
    bar.clear();
    tell(job.input + ": not enough memory; give a smaller input");
  } catch (const std::exception& error) {
    bar.clear();
    tell(error.what());
  }
  return false;
}

int run(const Arguments& arguments) {
  const Plan plan =
      fcl_stpbv::tools::plan(arguments.inputs, arguments.output, arguments.conversion, arguments.force);
  std::error_code error;
  if (!plan.folder.empty()) std::filesystem::create_directories(plan.folder, error);
  if (error) throw UsageError("-o " + plan.folder + ": this folder cannot be made: " + error.message());

  ProgressBar bar(plan.jobs.size(), !arguments.quiet);
  std::size_t done = 0, failed = 0;
  for (const Job& job : plan.jobs) {
    bar.show(done++, job.input);
    if (!runJob(job, arguments, bar)) ++failed;
  }
  bar.clear();
  if (failed > 0 && plan.jobs.size() > 1) {
    tell(std::to_string(failed) + " of " + std::to_string(plan.jobs.size()) +
         " inputs failed, the others are written");
  }
  return failed > 0 ? kSomeFailed : kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(kDescription, "mesh_to_stpbv");
  app.set_version_flag("--version", "mesh_to_stpbv " FCL_STPBV_VERSION);
  app.footer(kFooter);
  Arguments arguments;
  describe(app, arguments);
  try {
    app.parse(argc, argv);
    arguments.conversion.measure = arguments.json || !arguments.quiet;
    if (arguments.conversion.parts && arguments.conversion.parts->most == 0) {
      if (arguments.conversion.parts->excess == 0)
        throw UsageError("--effort: goes with --parts or --excess");
      arguments.conversion.parts->most = kMostParts;
    }
    return run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kUsage;
  } catch (const UsageError& error) {
    tell(error.what());
    return kUsage;
  } catch (const std::exception& error) {
    tell(error.what());
    return kSomeFailed;
  }
}
