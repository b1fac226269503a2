// A body's outline in the HTML page lies in the body, reaches its surface to the tolerance, and is closed.
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/sphere.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <random>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/report/outline.h"

namespace {

using Eigen::Vector3d;
using fcl_stpbv::TriangleMesh;
using fcl_stpbv::report::outline;

const double kTolerance = 1e-3;
const int kMost = 4000;  // never reached here

Vector3d normalOf(const TriangleMesh& mesh, const std::array<int, 3>& t) {
  const auto at = [&](int i) {
    return mesh.vertices[static_cast<std::size_t>(t[static_cast<std::size_t>(i)])];
  };
  return (at(1) - at(0)).cross(at(2) - at(0)).normalized();
}

// Every edge must be traversed once in each direction.
void checkClosed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> runs;
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) ++runs[{t[i], t[(i + 1) % 3]}];
  REQUIRE_FALSE(runs.empty());
  for (const auto& [edge, count] : runs) {
    CHECK(count == 1);
    CHECK(runs.count({edge.second, edge.first}) == 1);
  }
}

// `height` is the body's support function, and `depth` the depth of a point inside it (m), both by formula.
template <class Height, class Depth>
void checkOutline(const fcl::CollisionGeometryd& geometry, Height height, Depth depth) {
  const TriangleMesh mesh = outline(geometry, kTolerance, kMost);
  checkClosed(mesh);
  const double rounding = 1e-12;  // of lengths up to 1 m
  for (const Vector3d& v : mesh.vertices) CHECK(std::abs(depth(v)) < rounding);
  for (const auto& t : mesh.triangles) {
    const Vector3d n = normalOf(mesh, t);
    if (!n.allFinite()) continue;
    CHECK(height(n) - n.dot(mesh.vertices[static_cast<std::size_t>(t[0])]) < kTolerance + rounding);
  }
}

}  // namespace

TEST_CASE("the outline of a sphere keeps to the tolerance") {
  const double radius = 0.2;
  checkOutline(
      fcl::Sphered(radius), [&](const Vector3d&) { return radius; },
      [&](const Vector3d& v) { return radius - v.norm(); });
}

TEST_CASE("the outline of a capsule keeps to the tolerance") {
  const double radius = 0.05, half = 0.15;
  checkOutline(
      fcl::Capsuled(radius, 2 * half), [&](const Vector3d& n) { return radius + half * std::abs(n.z()); },
      [&](const Vector3d& v) {
        return radius - Vector3d(v.x(), v.y(), v.z() - std::clamp(v.z(), -half, half)).norm();
      });
}

TEST_CASE("the outline of a cylinder keeps to the tolerance") {
  const double radius = 0.05, half = 0.15;
  checkOutline(
      fcl::Cylinderd(radius, 2 * half),
      [&](const Vector3d& n) { return radius * std::hypot(n.x(), n.y()) + half * std::abs(n.z()); },
      [&](const Vector3d& v) { return std::min(radius - std::hypot(v.x(), v.y()), half - std::abs(v.z())); });
}

TEST_CASE("a box is drawn by its eight corners and twelve triangles") {
  const TriangleMesh mesh = outline(fcl::Boxd(0.1, 0.2, 0.3), kTolerance, kMost);
  checkClosed(mesh);
  CHECK(mesh.vertices.size() == 8);
  CHECK(mesh.triangles.size() == 12);
}

TEST_CASE("a volume is drawn as the smooth body, not as its polyhedron") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-0.2, 0.2);
  std::vector<Vector3d> cloud(60);
  for (Vector3d& p : cloud) p = Vector3d(coordinate(random), coordinate(random), coordinate(random));
  const double r = 0.01;
  const auto volume = fcl_stpbv::StpBv::build(cloud, {r, 10.0});
  const TriangleMesh mesh = outline(fcl_stpbv::StpBvGeometry(volume), kTolerance, kMost);
  checkClosed(mesh);
  for (const auto& t : mesh.triangles) {
    const Vector3d n = normalOf(mesh, t);
    double hull = -1;
    for (const Vector3d& p : cloud) hull = std::max(hull, n.dot(p));
    // The surface lies at least r outside the cloud.
    if (n.allFinite()) CHECK(n.dot(mesh.vertices[static_cast<std::size_t>(t[0])]) > hull + r - kTolerance);
  }
}

TEST_CASE("a bound on the corners is kept, and unbounded bodies are not drawn") {
  CHECK(outline(fcl::Sphered(1), 1e-9, 100).vertices.size() <= 100);
  CHECK(outline(fcl::Halfspaced(Vector3d(0, 0, 1), 0), kTolerance, kMost).triangles.empty());
}
