// See output_plan.h.
#include "tools/output_plan.h"

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/mesh/file_ending.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/mesh/uri_text.h"

namespace fcl_stpbv::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStandardOutput = "/dev/stdout";

// For names that do not exist or cannot be reached, the answer is no.
bool isFolder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}
bool isFile(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored) && !fs::is_directory(path, ignored);
}
bool isRegular(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}
bool sameFile(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  if (fs::equivalent(a, b, ignored)) return true;
  const auto place = [&](fs::path path) {
    constexpr int kMostLinks = 40;  // links of a chain, which may end at nothing or be a loop
    for (int links = 0; links < kMostLinks && fs::is_symlink(path, ignored); ++links)
      path = path.parent_path() / fs::read_symlink(path, ignored);
    return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
  };
  return !place(a).empty() && place(a) == place(b);  // empty if the place cannot be determined
}

// Whether the path is a descriptor. It is written directly (atomic_write.h), so no file behind it is
// replaced.
bool isDescriptor(const fs::path& path) {
  const fs::path folder = path.parent_path();
  return path == kStandardOutput || path == "/dev/stderr" || folder == "/dev/fd" || folder == "/proc/self/fd";
}

// The buffers of a glTF that are files of their own. Errors in the glTF are reported when it is loaded.
std::vector<std::string> buffersOf(const std::string& mesh) {
  std::vector<std::string> files;
  if (detail::lowerExtension(mesh) != ".gltf" || !isRegular(mesh)) return files;
  std::ifstream stream(mesh);
  const auto json = nlohmann::json::parse(stream, nullptr, false);
  if (!json.is_object() || !json.contains("buffers") || !json["buffers"].is_array()) return files;
  for (const auto& buffer : json["buffers"])
    if (buffer.is_object() && buffer.contains("uri") && buffer["uri"].is_string())
      for (const std::string& name : detail::namesOf(buffer["uri"].get<std::string>()))
        files.push_back((fs::path(mesh).parent_path() / name).string());
  return files;
}

// The files that reading the inputs opens. They are determined once, when they are first needed, because
// glTFs must be parsed for that.
class InputFiles {
 public:
  explicit InputFiles(const std::vector<std::string>& inputs) : inputs_(inputs) {}

  // Makes sure that writing `target` replaces none of these files.
  void spare(const std::string& option, const std::string& target) {
    if (!isRegular(target) || isDescriptor(target)) return;
    if (!files_) files_ = found();
    for (const std::string& file : *files_)
      if (sameFile(target, file))
        throw UsageError(target + ": is an input, and writing would replace it; give " + option +
                         " another name");
  }

 private:
  std::vector<std::string> found() const {
    std::vector<std::string> files;
    for (const std::string& input : inputs_) {
      files.push_back(input == "-" ? "/dev/stdin" : input);
      for (std::string& buffer : buffersOf(input)) files.push_back(std::move(buffer));
    }
    return files;
  }

  const std::vector<std::string>& inputs_;
  std::optional<std::vector<std::string>> files_;
};

void checkTarget(const std::string& option, const std::string& target, InputFiles& inputs, bool force) {
  if (isDescriptor(target)) return;
  if (isFolder(target)) throw UsageError(target + ": is a folder, expected the name of a file to write");
  inputs.spare(option, target);
  if (isRegular(target) && !force)
    throw UsageError(target + ": exists already; give --force to replace it, or another name");
  const fs::path parent = fs::path(target).parent_path();
  if (isFile(parent)) throw UsageError(parent.string() + ": is a file, expected a folder to write to");
}

void requireWritable(const std::string& target, const std::string& shown) {
  try {
    detail::requireWritable(target, shown);
  } catch (const Error& error) {
    throw UsageError(error.what());
  }
}

void checkValues(const ConversionOptions& options) {
  const StpBvOptions lengths = options.radii.lengths();
  if (!options.radii.fits() && lengths.R <= lengths.r)
    throw UsageError("-R: the big radius must be larger than the small radius r");
}

void checkPreview(const std::vector<std::string>& inputs, const std::string& preview) {
  if (preview.empty()) return;
  if (inputs.size() > 1) throw UsageError("--preview " + preview + ": is one file, give one input with it");
  if (!canSaveMesh(preview))
    throw UsageError("--preview " + preview + ": end the name in .obj, .stl, .ply or .glb");
}

// If the volume's name is a symbolic link, the volume is written to its target, which may be the preview.
void checkVolumeName(const std::string& name, const std::string& preview) {
  if (!preview.empty() && sameFile(preview, name))
    throw UsageError("--preview " + preview + ": is the volume " + name + " itself; give another name");
}

std::vector<Job> jobsInto(const std::string& folder, const std::vector<std::string>& inputs, Format format) {
  std::vector<Job> jobs;
  std::map<std::string, std::string> taken;  // the output, and the input that it belongs to
  for (const std::string& input : inputs) {
    const std::string name = fs::path(input).stem().string() + (format == Format::sch ? ".txt" : ".stpbv");
    const std::string target = (fs::path(folder) / name).string();
    const auto [other, isNew] = taken.emplace(target, input);
    if (!isNew) {
      throw UsageError(other->second + " and " + input + ": would both be written to " + target +
                       "; convert them into different folders");
    }
    jobs.push_back({input, target});
  }
  return jobs;
}

}  // namespace

void requireNoInput(const std::string& option, const std::string& target,
                    const std::vector<std::string>& inputs) {
  InputFiles(inputs).spare(option, target);
}

void checkTarget(const std::string& option, const std::string& target, const std::vector<std::string>& inputs,
                 bool force) {
  InputFiles files(inputs);
  checkTarget(option, target, files, force);
}

std::string nameOfPart(const std::string& output, int part) {
  const fs::path path(output);
  return (path.parent_path() /
          (path.stem().string() + "_" + std::to_string(part) + path.extension().string()))
      .string();
}

bool isStandardOutput(const std::string& output) {
  return output == "-" || output == kStandardOutput || output == "/dev/fd/1" || output == "/proc/self/fd/1";
}

Plan plan(const std::vector<std::string>& inputs, const std::string& output, const ConversionOptions& options,
          bool force) {
  if (inputs.empty()) throw UsageError("INPUT: give at least one file");
  if (output.empty())
    throw UsageError("-o: give the name of a file to write, or of a folder for several inputs");
  checkValues(options);
  checkPreview(inputs, options.preview);

  Plan plan;
  if (isStandardOutput(output)) {
    if (inputs.size() > 1 || options.parts)
      throw UsageError("-o " + output + ": takes one volume; name a folder or a file for several");
    plan.jobs = {{inputs[0], kStandardOutput}};
  } else if (inputs.size() > 1 || isFolder(output) || output.back() == '/') {
    if (isFile(output)) {
      throw UsageError("-o " + output + ": is a file, but " + std::to_string(inputs.size()) +
                       " inputs need a folder; name a folder");
    }
    plan.folder = output;
    plan.jobs = jobsInto(output, inputs, options.format);
  } else {
    if (canSaveMesh(output))
      throw UsageError("-o " + output +
                       ": a volume is no mesh; end the name in .stpbv, and for its surface give --preview " +
                       output);
    if (options.format == Format::sch && detail::lowerExtension(output) == ".stpbv")
      throw UsageError("-o " + output +
                       ": is a name of this library's own format, and no program could load --format sch "
                       "from it; end it in .txt");
    plan.jobs = {{inputs[0], output}};
  }
  InputFiles files(inputs);
  for (const Job& job : plan.jobs) {
    if (!options.parts) {
      checkTarget("-o", job.output, files, force);
      checkVolumeName(job.output, options.preview);
    }
    for (int part = 0; options.parts && part < options.parts->most; ++part) {
      files.spare("-o", nameOfPart(job.output, part));
      checkVolumeName(nameOfPart(job.output, part), options.preview);
    }
  }

  // The first file that is written for a job.
  const auto first = [&](const Job& job) { return options.parts ? nameOfPart(job.output, 0) : job.output; };
  std::vector<std::string> named;
  if (plan.folder.empty()) named.push_back(first(plan.jobs[0]));
  if (!options.preview.empty()) {
    checkTarget("--preview", options.preview, files, force);
    named.push_back(options.preview);
  }
  for (const std::string& name : named) {
    requireWritable(name, name);
  }
  if (isFolder(plan.folder))
    for (const Job& job : plan.jobs) requireWritable(first(job), first(job));
  return plan;
}

}  // namespace fcl_stpbv::tools
