// Reads a mesh file as vertices and triangles. qhull's files are read here. Other files are read by assimp in
// a child process with limits (child_process.h), which sends the mesh back as bytes.
#include "fcl_stpbv/robot/mesh_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/robot/assimp_mesh.h"
#include "fcl_stpbv/robot/child_process.h"
#include "fcl_stpbv/robot/file_ending.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

void checkReadable(const std::string& path, const Vector3d& scale) {
  if (!scale.allFinite() || (scale.array() == 0).any()) {
    throw Error(path +
                ": a scale of 0 or one that is not finite leaves no body; give a finite number other than 0");
  }
  if (path.empty()) throw Error("the name of a file to read is empty; give one");
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw Error(path + ": is a folder, expected a file");
  if (path != "-" && !std::filesystem::exists(path, ignored)) throw Error(path + ": no such file");
  if (!std::filesystem::is_regular_file(path, ignored))
    throw Error(path + ": is a pipe or a device, expected a file");
}

// The text of a qhull file, or no value if the file is a mesh for assimp. Such files often have names that do
// not tell the format, so a name without a known ending is decided by the file's content.
std::optional<std::string> qhullText(const std::string& path) {
  const std::string extension = lowerExtension(path);
  const bool named = extension == ".txt" || extension == ".otp";
  if (!named && !extension.empty()) return std::nullopt;
  std::string text = readText(path);
  if (!named && !looksLikeQhull(text)) return std::nullopt;
  return text;
}

template <class T>
void append(std::string& bytes, const std::vector<T>& items) {
  const std::size_t count = items.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  if (count > 0) bytes.append(reinterpret_cast<const char*>(items.data()), count * sizeof(T));
}

// Reads what append() wrote. The file may have corrupted the process that wrote it, so every count is
// checked.
template <class T>
std::vector<T> take(std::string_view& bytes, const std::string& path) {
  std::size_t count = 0;
  const bool counted = bytes.size() >= sizeof count;
  if (counted) std::memcpy(&count, bytes.data(), sizeof count);
  if (!counted || count > (bytes.size() - sizeof count) / sizeof(T))
    throw Error(path + ": its reader fell over; the file is damaged, export it again");
  std::vector<T> items(count);
  bytes.remove_prefix(sizeof count);
  if (count > 0) std::memcpy(static_cast<void*>(items.data()), bytes.data(), count * sizeof(T));
  bytes.remove_prefix(count * sizeof(T));
  return items;
}

}  // namespace

TriangleMesh loadMesh(const std::string& path, const Vector3d& scale) {
  checkReadable(path, scale);
  TriangleMesh mesh;
  if (const std::optional<std::string> text = qhullText(path)) {
    mesh.vertices = parseQhullPoints(*text, path);
    const bool several = std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                                     [&](const Vector3d& p) { return p != mesh.vertices[0]; });
    for (Vector3d& point : mesh.vertices) point = point.cwiseProduct(scale);
    requireSize(mesh.vertices, several, path);
    return mesh;
  }
  const std::string bytes = inChildProcess(path, [&](ChildLimits& limits) {
    const TriangleMesh read = readByAssimp(path, scale, limits);
    std::string all;
    append(all, read.vertices);
    append(all, read.triangles);
    return all;
  });
  std::string_view rest = bytes;
  mesh.vertices = take<Vector3d>(rest, path);
  mesh.triangles = take<std::array<int, 3>>(rest, path);
  const auto isCorner = [&](int i) { return i >= 0 && static_cast<std::size_t>(i) < mesh.vertices.size(); };
  for (const std::array<int, 3>& t : mesh.triangles)
    if (!std::all_of(t.begin(), t.end(), isCorner))
      throw Error(path + ": its reader fell over; the file is damaged, export it again");
  return mesh;
}

std::vector<Vector3d> loadPoints(const std::string& path, const Vector3d& scale) {
  return loadMesh(path, scale).vertices;
}

}  // namespace fcl_stpbv
