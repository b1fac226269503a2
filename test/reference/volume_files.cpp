// Volumes for tests of file formats, and those that SCH files can represent. Folders that are removed
// automatically. Sample files beside the project.
#include "test/reference/volume_files.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "test/reference/shapes.h"
#include "test/reference/source_folder.h"

namespace fcl_stpbv::test {
namespace fs = std::filesystem;

std::vector<NamedVolume> volumesForSch() {
  const StpBvOptions usual;
  return {{"box", StpBv::build(box(0.2, 0.3, 0.5), usual)},
          {"plate", StpBv::build(plate(0.3, 0.2), usual)},
          {"right triangle", StpBv::build({{0, 0, 0}, {0.3, 0, 0}, {0, 0.4, 0}}, usual)},
          {"square", StpBv::build({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, usual)},
          {"cylinder", StpBv::build(cylinder(0.1, 0.4), {0.002, 300})},
          {"sphere", StpBv::build(geodesicSphere(0.15, 2), usual)},
          {"cloud", StpBv::build(randomHull(300, {0.1, 0.2, 0.3}, 7), {0.02, 1})},
          {"no margin", StpBv::build(randomHull(50, {0.1, 0.2, 0.3}, 8), {0, 0.7})},
          {"far away", StpBv::build({{9, 9, 9}, {9.1, 9, 9}, {9, 9.1, 9}, {9, 9, 9.1}}, usual)}};
}

std::vector<NamedVolume> volumesOfEveryKind() {
  std::vector<NamedVolume> volumes = volumesForSch();
  const StpBvOptions usual;
  volumes.push_back({"one point", StpBv::build({{0.1, 0.2, 0.3}}, usual)});
  volumes.push_back({"spindle", StpBv::build({{0.1, 0.2, 0.3}, {-0.4, 0.1, 0.7}}, usual)});
  volumes.push_back({"obtuse triangle", StpBv::build({{0, 0, 0}, {1, 0, 0}, {0.5, 0.1, 0}}, usual)});
  volumes.push_back({"needle", StpBv::build(needle(1), usual)});
  return volumes;
}

std::string sharedFolder(const std::string& name) {
  const fs::path folder = fs::path(sourceFolder()).parent_path() / "shared" / name;
  return fs::is_directory(folder) ? folder.string() : "";
}

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "fcl_stpbv_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw Error(name + ": cannot be made");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::vector<std::string> TemporaryFolder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(path_)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string contentOf(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void put(const std::string& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

}  // namespace fcl_stpbv::test
