// Boxes and the L are prisms over polygons; torus and bowl are rings of vertices. finer() cuts at the middles
// of sides. A random point of a surface is in a triangle chosen by area, and uniform within it.
#include "test/reference/solids.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace fcl_stpbv::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

void addQuad(TriangleMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

// A prism over a polygon that need not be convex. The polygon is given by its triangles, with corners
// counter-clockwise seen from above.
TriangleMesh prism(const std::vector<Eigen::Vector2d>& ring, const std::vector<std::array<int, 3>>& floor,
                   double height) {
  TriangleMesh mesh;
  const int n = static_cast<int>(ring.size());
  for (const double z : {0.0, height})
    for (const Eigen::Vector2d& p : ring) mesh.vertices.push_back({p.x(), p.y(), z});
  for (const auto& t : floor) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (int i = 0; i < n; ++i) addQuad(mesh, i, (i + 1) % n, (i + 1) % n + n, i + n);
  return mesh;
}

}  // namespace

TriangleMesh boxMesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  const Eigen::Vector3d size = high - low;
  TriangleMesh mesh =
      prism({{0, 0}, {size.x(), 0}, {size.x(), size.y()}, {0, size.y()}}, {{0, 1, 2}, {0, 2, 3}}, size.z());
  for (Eigen::Vector3d& v : mesh.vertices) v += low;
  return mesh;
}

TriangleMesh lShape() {
  return prism({{0, 0}, {0.2, 0}, {0.2, 0.05}, {0.05, 0.05}, {0.05, 0.2}, {0, 0.2}},
               {{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}}, 0.05);
}

TriangleMesh torusMesh(double radius, double tube, int around, int across) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int k = 0; k < across; ++k) {
      const double u = 2 * kPi * i / around, v = 2 * kPi * k / across, rho = radius + tube * std::cos(v);
      mesh.vertices.push_back({rho * std::cos(u), rho * std::sin(u), tube * std::sin(v)});
    }
  }
  const auto place = [&](int i, int k) { return i % around * across + k % across; };
  for (int i = 0; i < around; ++i)
    for (int k = 0; k < across; ++k)
      addQuad(mesh, place(i, k), place(i + 1, k), place(i + 1, k + 1), place(i, k + 1));
  return mesh;
}

TriangleMesh bowl(double radius, int rings) {
  TriangleMesh mesh;
  const int around = 4 * rings;
  for (int i = 0; i <= rings; ++i) {
    const double polar = kPi / 2 * i / rings;
    for (int k = 0; k < around; ++k) {
      const double u = 2 * kPi * k / around;
      mesh.vertices.push_back(radius * Eigen::Vector3d(std::sin(polar) * std::cos(u),
                                                       std::sin(polar) * std::sin(u), -std::cos(polar)));
    }
  }
  const auto place = [&](int i, int k) { return i * around + k % around; };
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < around; ++k)
      addQuad(mesh, place(i, k), place(i, k + 1), place(i + 1, k + 1), place(i + 1, k));
  return mesh;
}

TriangleMesh together(const std::vector<TriangleMesh>& meshes) {
  TriangleMesh all;
  for (const TriangleMesh& mesh : meshes) {
    const int first = static_cast<int>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const auto& t : mesh.triangles) all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  return all;
}

TriangleMesh turned(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh finer(TriangleMesh mesh, int times) {
  for (; times > 0; --times) {
    TriangleMesh fine;
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3d &a = mesh.vertices[at(t[0])], &b = mesh.vertices[at(t[1])],
                            &c = mesh.vertices[at(t[2])];
      const int n = static_cast<int>(fine.vertices.size());
      for (const Eigen::Vector3d& p : {a, b, c, Eigen::Vector3d((a + b) / 2), Eigen::Vector3d((b + c) / 2),
                                       Eigen::Vector3d((c + a) / 2)})
        fine.vertices.push_back(p);
      for (const auto& [i, j, k] : {std::array{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}})
        fine.triangles.push_back({n + i, n + j, n + k});
    }
    mesh = std::move(fine);
  }
  return mesh;
}

TriangleMesh shaken(TriangleMesh mesh, double size, Random& random) {
  for (Eigen::Vector3d& v : mesh.vertices)
    for (double& x : v) x += random.uniform(-size, size);
  return mesh;
}

Eigen::Vector3d pointOn(const TriangleMesh& mesh, Random& random) {
  const auto corner = [&](int t, std::size_t k) { return mesh.vertices[at(mesh.triangles[at(t)][k])]; };
  const auto area = [&](int t) {
    return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm();
  };
  double all = 0;
  const int count = static_cast<int>(mesh.triangles.size());
  for (int t = 0; t < count; ++t) all += area(t);
  double left = random.uniform(0, all);
  int t = 0;
  while (t + 1 < count && left > area(t)) left -= area(t++);
  const double root = std::sqrt(random.uniform(0, 1)), b = random.uniform(0, 1);
  return (1 - root) * corner(t, 0) + root * (1 - b) * corner(t, 1) + root * b * corner(t, 2);
}

}  // namespace fcl_stpbv::test
