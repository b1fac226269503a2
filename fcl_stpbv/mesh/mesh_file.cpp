// Reads a mesh file as vertices and triangles. Clouds of points are read here. Other files are read by assimp
// in a child process with limits (child_process.h), which sends the mesh back as bytes.
#include "fcl_stpbv/mesh/mesh_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <new>
#include <string_view>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/mesh/assimp_mesh.h"
#include "fcl_stpbv/mesh/child_process.h"
#include "fcl_stpbv/mesh/file_ending.h"
#include "fcl_stpbv/mesh/mesh_content.h"
#include "fcl_stpbv/mesh/point_lines.h"
#include "fcl_stpbv/words.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

void checkScale(const std::string& path, const Vector3d& scale) {
  if (!scale.allFinite() || (scale.array() == 0).any()) {
    throw Error(path +
                ": a scale of 0 or one that is not finite leaves no body; give a finite number other than 0");
  }
}

void checkReadable(const std::string& path, const Vector3d& scale) {
  checkScale(path, scale);
  if (path.empty()) throw Error("the name of a file to read is empty; give one");
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw Error(path + ": is a folder, expected a file");
  if (path != "-" && !std::filesystem::exists(path, ignored)) throw Error(path + ": " + whyNoFile(path));
  if (!std::filesystem::is_regular_file(path, ignored))
    throw Error(path + ": is a pipe or a device, expected a file");
}

// The endings of texts with one point a line, and of qhull's.
constexpr Words kLines{".xyz", ".pts"};
constexpr Words kQhull{".txt", ".otp", ".qc", ".cloud"};

bool isCloud(std::string_view text) { return looksLikeQhull(text) || looksLikePointLines(text); }

// The points of a cloud; `ending` is the name's.
TriangleMesh cloudOf(std::string_view text, const std::string& ending, const std::string& path,
                     const Vector3d& scale) {
  const bool lines = holds(kLines, ending) || (!looksLikeQhull(text) && looksLikePointLines(text));
  TriangleMesh mesh;
  mesh.vertices = lines ? parsePointLines(text, path) : parseQhullPoints(text, path);
  const bool several = std::any_of(mesh.vertices.begin(), mesh.vertices.end(),
                                   [&](const Vector3d& p) { return p != mesh.vertices[0]; });
  for (Vector3d& point : mesh.vertices) point = point.cwiseProduct(scale);
  requireSize(mesh.vertices, several, path);
  return mesh;
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

TriangleMesh byAssimp(const std::string& path, const std::string& text, bool inMemory,
                      const Vector3d& scale) {
  TriangleMesh mesh;
  const std::string bytes = inChildProcess(path, [&](ChildLimits& limits) {
    const TriangleMesh read = readByAssimp(path, text, inMemory, scale, limits);
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

}  // namespace

std::string detail::meshText(const std::string& path, const Vector3d& scale) {
  checkReadable(path, scale);
  try {
    return readText(path);
  } catch (const std::bad_alloc&) {
    refuseWithoutMemory(path);
  }
}

TriangleMesh detail::meshOf(const std::string& text, const std::string& path, const Vector3d& scale) {
  const std::string ending = lowerExtension(path);
  const bool cloud = holds(kQhull, ending) || holds(kLines, ending) || (ending.empty() && isCloud(text));
  return cloud ? cloudOf(text, ending, path, scale) : byAssimp(path, text, ending.empty(), scale);
}

TriangleMesh loadMesh(const std::string& path, const Vector3d& scale) {
  return meshOf(meshText(path, scale), path, scale);
}

TriangleMesh parseMesh(const std::string& content, const std::string& name, const Vector3d& scale) {
  checkScale(name, scale);
  return isCloud(content) ? cloudOf(content, "", name, scale) : byAssimp(name, content, true, scale);
}

std::vector<Vector3d> loadPoints(const std::string& path, const Vector3d& scale) {
  return loadMesh(path, scale).vertices;
}

}  // namespace fcl_stpbv
