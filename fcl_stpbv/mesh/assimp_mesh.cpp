// Reads a mesh file by assimp:
// 1. check the file's contents, by its format (mesh_format.h), then its faces;
// 2. split faces into triangles, and check that none is lost;
// 3. gather all meshes with the transforms of their nodes.
#include "fcl_stpbv/mesh/assimp_mesh.h"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/Importer.hpp>
#include <new>
#include <optional>
#include <unordered_map>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_format.h"
#include "fcl_stpbv/mesh/readable_files.h"
#include "fcl_stpbv/vector_hash.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

constexpr const char* kReadable =
    "STL, OBJ, DAE, PLY, glTF, GLB, OFF, or a cloud of points (*-ch.txt, *.otp, *.qc, *.xyz, *.pts)";

Eigen::AlignedBox3d boxAround(const std::vector<Vector3d>& points) {
  Eigen::AlignedBox3d box;
  for (const Vector3d& p : points) box.extend(p);
  return box;
}

// assimp stores coordinates in single precision. Far from the origin, rounding would change the body's shape
// noticeably. `far` is the largest intermediate coordinate in the nodes' transforms, which may cancel (m). A
// single point may have been a small body before rounding.
void requireNear(const Eigen::AlignedBox3d& box, double far, bool several, const std::string& path) {
  constexpr double kStep = 1.0 / (1 << 23);  // relative rounding of a coordinate in single precision
  constexpr double kSeen = 1e-3;  // largest rounding that is accepted, as a share of the body's size
  constexpr double kSmall = 0.1;  // size assumed for a single point (m)
  if (kStep * far > kSeen * (several ? box.sizes().maxCoeff() : kSmall))
    throw Error(
        path +
        ": is too far from its origin, or from a node's: single precision would round it to steps of "
        "over 0.1 % of its size; move the mesh to its origin and give the offset in the robot's file");
}

Vector3d vectorOf(const aiVector3D& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

// Largest lengths along each axis after a transform, as sums of magnitudes. So they bound all intermediate
// sums.
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

  /// Adds a mesh. `way`: a bound on the numbers that `transform` was multiplied from.
  void add(const aiMesh& mesh, const aiMatrix4x4& transform, const Vector3d& way) {
    std::vector<int> index;
    index.reserve(mesh.mNumVertices);
    far_ = far_.cwiseMax(way);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D& own = mesh.mVertices[v];
      far_ = far_.cwiseMax(reachOf(transform, vectorOf(own).cwiseAbs()));
      several_ = several_ || own != mesh.mVertices[0];
      index.push_back(add(vectorOf(transform * own)));
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // single points and lines
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
    requireSize(mesh_.vertices, several_, path_);
    requireNear(boxAround(mesh_.vertices), far_.cwiseMax(far).cwiseProduct(scale_.cwiseAbs()).maxCoeff(),
                several_, path_);
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
  Vector3d far_{0, 0, 0};  // bound on intermediate coordinates, before the scale
  bool several_ = false;   // whether there are distinct points before any scaling, by a node or here
  std::unordered_map<Vector3d, int, VectorHash> index_;
};

// Must run between assimp's reader and its triangulation: the reader accepts faces without vertices or with
// wrong indices, and the triangulation crashes on them.
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

// Twice the sum of the projected areas of all faces along their normals (m^2). For any triangulation of a
// face, its triangles have the same total area, or more if the face is not flat.
double outlinedArea(const aiScene& scene) {
  double sum = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    const auto place = [&mesh](unsigned vertex) { return vectorOf(mesh.mVertices[vertex]); };
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

// `text` is the content of the file `path`, or of no file if it is `inMemory`. `far` receives the largest
// number within the nodes' transforms, if the format's check computes it (m).
const aiScene& read(Assimp::Importer& importer, ReadableFiles& files, const std::string& path,
                    const std::string& text, bool inMemory, double& far) {
  if (inMemory && text.empty()) throw Error(path + ": is empty; give a whole file of " + kReadable);
  // assimp's name for what is in memory, with the ending of its format
  const std::string ending = inMemory ? formatByContent(text) : "",
                    alias = AI_MEMORYIO_MAGIC_FILENAME + ending;
  const std::string expected = expectedFormat(text, inMemory ? alias : path);
  const auto check = [&](const std::string& format) {
    far = checkMeshFormat(text, format, path, [&files](const std::string& part) { return files.part(part); });
  };
  check(expected);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Without this setting, assimp would draw the nodes of a file without meshes as a body.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const char* const hint = ending.empty() ? "" : ending.c_str() + 1;  // without its dot
  const aiScene* scene =
      inMemory ? importer.ReadFileFromMemory(text.data(), text.size(), 0, hint) : importer.ReadFile(path, 0);
  if (scene != nullptr) {
    if (const std::string format = formatOf(*scene, importer); format != expected) check(format);
    checkFaces(*scene, path);
    constexpr double kRounding = 1e-9;  // for sums of doubles; far less than the area of a face
    const double area = outlinedArea(*scene);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
    // If a polygon has corners on one line, assimp leaves out what it cannot split.
    if (scene != nullptr && outlinedArea(*scene) < (1 - kRounding) * area)
      throw Error(path +
                  ": a face of many corners cannot be split into triangles; export the mesh as triangles");
  }
  if (scene == nullptr || scene->mRootNode == nullptr) {
    constexpr std::size_t kLongest = 200;  // characters; assimp may quote the file up to its end
    std::string why = importer.GetErrorString();
    if (why.find("bad_alloc") != std::string::npos) throw std::bad_alloc();  // assimp has caught it
    if (const std::size_t at = why.find(alias); inMemory && at != std::string::npos)
      why.replace(at, alias.size() + (ending.empty() ? 1 : 0), path);  // with the dot for an ending
    if (why.size() > kLongest) why = why.substr(0, kLongest) + " ...";
    throw Error(path + ": cannot be read as a mesh (" + why + "); give a whole file of " + kReadable);
  }
  return *scene;
}

}  // namespace

void requireSize(const std::vector<Vector3d>& points, bool several, const std::string& path) {
  constexpr double kLeast = 1e-9;  // 1 nm (m); an atom has about a tenth of that
  if (several && boxAround(points).sizes().maxCoeff() < kLeast)
    throw Error(path + ": is smaller than 1e-9 m along each axis; give it the right unit or scale");
}

TriangleMesh readByAssimp(const std::string& path, const std::string& text, bool inMemory,
                          const Vector3d& scale, ChildLimits& limits) {
  Assimp::Importer importer;
  // A mesh in memory refers to no files.
  auto* const files = new ReadableFiles(inMemory ? "" : path, text, limits);
  importer.SetIOHandler(files);  // the importer deletes `files`
  double far = 0;
  const aiScene& scene = read(importer, *files, path, text, inMemory, far);
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

}  // namespace fcl_stpbv::detail
