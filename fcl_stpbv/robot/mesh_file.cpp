// Reading of meshes by assimp, in a child process with limits (child_process.h):
// 1. check the file's size and its contents, by its format (mesh_format.h);
// 2. read all meshes with the transforms of their nodes;
// 3. send vertices and triangles back to the parent as bytes.
#include "fcl_stpbv/robot/mesh_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/robot/child_process.h"
#include "fcl_stpbv/robot/file_ending.h"
#include "fcl_stpbv/robot/mesh_format.h"
#include "fcl_stpbv/robot/readable_files.h"
#include "fcl_stpbv/vector_hash.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

constexpr const char* kReadable =
    "STL, OBJ, DAE, PLY, glTF, GLB, OFF, or a polyhedron of qhull's (*-ch.txt, *.otp)";

Eigen::AlignedBox3d boxAround(const std::vector<Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(p);
  return box;
}

// A body that has collapsed would count as a point and be told to be clear.
void requireSize(const Eigen::AlignedBox3d& box, bool several, const std::string& path) {
  constexpr double kLeast = 1e-9;  // an atom is a tenth of it (m)
  if (several && box.sizes().maxCoeff() < kLeast)
    throw Error(path + ": is smaller than 1e-9 m along each axis; give it the right unit or scale");
}

// assimp holds coordinates in single precision: far from the origin they would be rounded to steps that are
// seen in the body's shape. `far` is the largest number on the way through the nodes' transforms, which may
// bring it back (m). One point may have been a small body.
void requireNear(const Eigen::AlignedBox3d& box, double far, bool several, const std::string& path) {
  constexpr double kStep = 1.0 / (1 << 23);  // of a coordinate
  constexpr double kSeen = 1e-3;             // of the body's size
  constexpr double kSmall = 0.1;             // m
  if (kStep * far > kSeen * (several ? box.sizes().maxCoeff() : kSmall))
    throw Error(
        path +
        ": lies thousands of its sizes away from its origin, or from that of a node, where coordinates are "
        "read in steps of over a thousandth of its size; move the mesh to its origin and give the way "
        "in the robot's file");
}

// What a transform makes of lengths along each axis, summed: a bound on all that is added up on the way.
Vector3d reachOf(const aiMatrix4x4& m, const Vector3d& from) {
  const auto row = [&](float x, float y, float z, float at) {
    const Vector3d linear(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z));
    return linear.cwiseAbs().dot(from) + std::abs(static_cast<double>(at));
  };
  return {row(m.a1, m.a2, m.a3, m.a4), row(m.b1, m.b2, m.b3, m.b4), row(m.c1, m.c2, m.c3, m.c4)};
}

// Gathers triangles, each distinct point once.
class Gatherer {
 public:
  Gatherer(const std::string& path, const Vector3d& scale) : path_(path), scale_(scale) {}

  /// `way`: a bound on the numbers that its transforms were multiplied from.
  void add(const aiMesh& mesh, const aiMatrix4x4& transform, const Vector3d& way) {
    std::vector<int> index;
    index.reserve(mesh.mNumVertices);
    far_ = far_.cwiseMax(way);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& own = mesh.mVertices[v];
      const Vector3d place(static_cast<double>(own.x), static_cast<double>(own.y),
                           static_cast<double>(own.z));
      far_ = far_.cwiseMax(reachOf(transform, place.cwiseAbs()));
      several_ = several_ || mesh.mVertices[v] != mesh.mVertices[0];
      const aiVector3D p = transform * mesh.mVertices[v];
      index.push_back(
          add(Vector3d(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z))));
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // lone points and lines
      std::array<int, 3> triangle{};
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices)
          throw Error(path_ + ": a face names a vertex that does not exist");
        triangle[k] = index[face.mIndices[k]];
      }
      mesh_.triangles.push_back(triangle);
    }
  }

  /// `far`: the largest number within the nodes' own transforms, before the scale.
  TriangleMesh take(double far) {
    if (mesh_.vertices.empty()) return {};
    const Eigen::AlignedBox3d box = boxAround(mesh_.vertices);
    requireSize(box, several_, path_);
    requireNear(box, far_.cwiseMax(far).cwiseProduct(scale_.cwiseAbs()).maxCoeff(), several_, path_);
    return std::move(mesh_);
  }

 private:
  int add(Vector3d point) {
    if (!point.allFinite()) {
      throw Error(path_ + ": a vertex has a coordinate that is not a finite number; export the mesh again");
    }
    if (!first_) first_ = point;
    several_ = several_ || point != *first_;
    // Adding zero makes -0 a 0, so that both have one hash.
    point = point.cwiseProduct(scale_) + Vector3d::Zero();
    const auto [place, isNew] = index_.try_emplace(point, static_cast<int>(mesh_.vertices.size()));
    if (isNew) mesh_.vertices.push_back(point);
    return place->second;
  }

  const std::string& path_;
  Vector3d scale_;
  TriangleMesh mesh_;
  std::optional<Vector3d> first_;
  Vector3d far_{0, 0, 0};  // the largest numbers on the way, before the scale
  bool several_ = false;   // distinct points before they are scaled, by a node or here
  std::unordered_map<Vector3d, int, VectorHash> index_;
};

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

// assimp's readers let faces without vertices and with wrong ones through, and its triangulation ends the
// process over them, so this stands between the two.
void checkFaces(const aiScene& scene, const std::string& path) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      const bool good =
          face.mNumIndices > 0 && std::all_of(face.mIndices, face.mIndices + face.mNumIndices,
                                              [&](unsigned v) { return v < mesh.mNumVertices; });
      if (!good)
        throw Error(path + ": face " + std::to_string(f) +
                    " has no vertices or names one that does not exist; the file is damaged");
    }
  }
}

// Twice the area of all faces, of each that of its outline seen along its normal (m^2): whatever way a face
// is split, its triangles have as much in all, or more where it is not flat.
double outlinedArea(const aiScene& scene) {
  double sum = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    const auto place = [&mesh](unsigned vertex) {
      const aiVector3D& p = mesh.mVertices[vertex];
      return Vector3d(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    };
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      const Vector3d first = place(face.mIndices[0]);
      Vector3d area(0, 0, 0);
      for (unsigned k = 2; k < face.mNumIndices; ++k)
        area += (place(face.mIndices[k - 1]) - first).cross(place(face.mIndices[k]) - first);
      sum += area.norm();
    }
  }
  return sum;
}

// `far` gets the largest number within the nodes' transforms, where the format tells (m).
const aiScene& read(Assimp::Importer& importer, ReadableFiles& files, const std::string& path, double& far) {
  const std::string text = readText(path), expected = expectedFormat(text, path);
  const auto check = [&](const std::string& format) {
    far = checkMeshFormat(text, format, path, [&files](const std::string& part) { return files.part(part); });
  };
  check(expected);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Without a mesh there is no body: assimp would draw the nodes as one.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene != nullptr) {
    if (const std::string format = formatOf(*scene, importer); format != expected) check(format);
    checkFaces(*scene, path);
    constexpr double kRounding = 1e-9;  // of sums of doubles, and far less than a face
    const double area = outlinedArea(*scene);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    // assimp leaves out what it cannot split of a polygon with corners on one line.
    if (scene != nullptr && outlinedArea(*scene) < (1 - kRounding) * area)
      throw Error(path +
                  ": a face of many corners cannot be split into triangles; export the mesh as triangles");
  }
  if (scene == nullptr || scene->mRootNode == nullptr) {
    constexpr std::size_t kLongest = 200;  // assimp may quote the file from there to its end
    std::string why = importer.GetErrorString();
    if (why.size() > kLongest) why = why.substr(0, kLongest) + " ...";
    throw Error(path + ": cannot be read as a mesh (" + why + "); give a whole file of " + kReadable);
  }
  return *scene;
}

// The text of a qhull file, or nothing where the file is a mesh for assimp. The names that robots give to
// such files say little, so a name without a known ending is decided by its content.
std::optional<std::string> qhullText(const std::string& path) {
  const std::string extension = lowerExtension(path);
  const bool named = extension == ".txt" || extension == ".otp";
  if (!named && !extension.empty()) return std::nullopt;
  std::string text = readText(path);
  if (!named && !looksLikeQhull(text)) return std::nullopt;
  return text;
}

}  // namespace

namespace {

/// assimp trusts what it reads: counts that fill the memory, loops, depths that overflow the stack.
TriangleMesh readMesh(const std::string& path, const Vector3d& scale, ChildLimits& limits) {
  Assimp::Importer importer;
  auto* const files = new ReadableFiles(path, limits);
  importer.SetIOHandler(files);  // which deletes it
  double far = 0;
  const aiScene& scene = read(importer, *files, path, far);
  Gatherer gatherer(path, scale);
  struct Open {
    const aiNode* node;
    aiMatrix4x4 above;
    Vector3d way;
  };
  std::vector<Open> open{{scene.mRootNode, aiMatrix4x4(), Vector3d::Zero()}};
  while (!open.empty()) {
    const Open at = open.back();
    open.pop_back();
    const aiMatrix4x4 &own = at.node->mTransformation, transform = at.above * own;
    const Vector3d way = at.way.cwiseMax(reachOf(at.above, reachOf(own, Vector3d::Zero())));
    for (unsigned m = 0; m < at.node->mNumMeshes; ++m)
      gatherer.add(*scene.mMeshes[at.node->mMeshes[m]], transform, way);
    for (unsigned c = at.node->mNumChildren; c-- > 0;)
      open.push_back({at.node->mChildren[c], transform, way});
  }
  TriangleMesh mesh = gatherer.take(far);
  if (mesh.vertices.empty()) throw Error(path + ": holds no vertices; give a file with at least one mesh");
  return mesh;
}

template <class T>
void append(std::string& bytes, const std::vector<T>& items) {
  const std::size_t count = items.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  if (count > 0) bytes.append(reinterpret_cast<const char*>(items.data()), count * sizeof(T));
}

// What append() wrote. The process that wrote it may have been damaged by its file: no count is believed.
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
    requireSize(boxAround(mesh.vertices), several, path);
    return mesh;
  }
  const std::string bytes = inChildProcess(path, [&](ChildLimits& limits) {
    const TriangleMesh read = readMesh(path, scale, limits);
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
