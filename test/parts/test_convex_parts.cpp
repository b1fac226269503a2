// Parts cover the mesh from which they are made, are close to it, and are not more than requested.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/volume/measure.h"
#include "test/reference/mesh_reference.h"
#include "test/reference/solids.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;

namespace {

PartsOptions quick(int most) {
  PartsOptions options;
  options.most = most;
  options.effort = 0.1;
  return options;
}

// A ball with spikes. Cuts through its middle meet where there are no triangles.
TriangleMesh spikyBall() {
  TriangleMesh mesh = finer(boxMesh({-0.06, -0.06, -0.06}, {0.06, 0.06, 0.06}), 3);
  for (Eigen::Vector3d& v : mesh.vertices) {
    const double wave = std::sin(50 * v.x()) * std::sin(50 * v.y() + 1) * std::sin(50 * v.z() + 2);
    v *= 1 + 0.6 * wave;
  }
  return mesh;
}

// A tall pyramid on each face of a tetrahedron: none of the mesh's triangles belongs to the tetrahedron.
TriangleMesh caltrop(double size) {
  TriangleMesh mesh;
  mesh.vertices = {{size, size, size}, {size, -size, -size}, {-size, size, -size}, {-size, -size, size}};
  for (int face = 0; face < 4; ++face) {
    const int apex = 4 + face;
    mesh.vertices.push_back(-4 * mesh.vertices[static_cast<std::size_t>(face)]);
    for (int k = 1; k < 4; ++k)  // the edges of the face across from that vertex
      mesh.triangles.push_back({(face + k) % 4, (face + 1 + k % 3) % 4, apex});
  }
  return mesh;
}

// Radii and heights rotated about z. The profile starts and ends on the axis.
TriangleMesh turnedProfile(const std::vector<std::pair<double, double>>& profile, int around) {
  TriangleMesh mesh;
  const int rings = static_cast<int>(profile.size());
  for (int i = 0; i < around; ++i)
    for (const auto& [radius, height] : profile) {
      const double turn = 2 * M_PI * i / around;
      mesh.vertices.push_back({radius * std::cos(turn), radius * std::sin(turn), height});
    }
  for (int i = 0; i < around; ++i)
    for (int k = 0; k + 1 < rings; ++k) {
      const int a = i * rings + k, b = (i + 1) % around * rings + k;
      if (k > 0) mesh.triangles.push_back({a, b, a + 1});
      if (k + 2 < rings) mesh.triangles.push_back({b, b + 1, a + 1});
    }
  return mesh;
}

// Two discs and a bar between them.
TriangleMesh dumbbell(int around) {
  return turnedProfile(
      {{0, 0}, {0.05, 0}, {0.05, 0.03}, {0.02, 0.03}, {0.02, 0.1}, {0.05, 0.1}, {0.05, 0.13}, {0, 0.13}},
      around);
}

std::vector<StpBv::Ptr> volumesOf(const ConvexParts& parts) {
  std::vector<StpBv::Ptr> volumes;
  for (const ConvexPart& part : parts.parts) volumes.push_back(StpBv::build(part.points, {1e-6, 10}));
  return volumes;
}

bool covered(const std::vector<StpBv::Ptr>& volumes, const Eigen::Vector3d& p) {
  return std::any_of(volumes.begin(), volumes.end(),
                     [&](const auto& volume) { return contains(*volume, p); });
}

}  // namespace

TEST_CASE("parts cover every triangle, and what closed pieces enclose") {
  Random random(19);
  const std::vector<std::pair<std::string, TriangleMesh>> meshes{
      {"an L", lShape()},
      {"a ring", torusMesh(0.12, 0.03, 20, 8)},
      {"a ball with spikes", spikyBall()},
      {"a bowl", bowl(0.1, 6)},
      {"a bowl and two boxes that cross",
       together({bowl(0.1, 5), boxMesh({0, 0, 0}, {0.1, 0.1, 0.1}),
                 turned(boxMesh({0.05, 0.05, 0.02}, {0.2, 0.08, 0.08}))})}};
  for (const auto& [name, mesh] : meshes) {
    INFO(name);
    const ConvexParts parts = convexParts(mesh, quick(6));
    CHECK(parts.parts.size() <= 6);
    const std::vector<StpBv::Ptr> volumes = volumesOf(parts);
    int open = 0, inside = 0, openInside = 0;
    for (int i = 0; i < 1000; ++i) open += !covered(volumes, pointOn(mesh, random));
    CHECK(open == 0);
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d p = 0.5 * (pointOn(mesh, random) + pointOn(mesh, random));
      if (parts.closedPieces < parts.pieces || std::abs(std::round(referenceWinding(mesh, p))) < 0.5)
        continue;
      ++inside;
      openInside += !covered(volumes, p);
    }
    if (parts.closedPieces == parts.pieces) CHECK(inside > 200);
    CHECK(openInside == 0);
  }
}

TEST_CASE("no point of a part's hull is farther from the mesh than its bound says") {
  Random random(23);
  for (const TriangleMesh& mesh : {torusMesh(0.12, 0.03, 20, 8), bowl(0.1, 6)}) {
    const ConvexParts parts = convexParts(mesh, quick(4));
    double seen = 0, seenOpen = 0;
    for (const ConvexPart& part : parts.parts) {
      for (const Triangle& t : hullTriangles(part.points)) {
        const double b = random.uniform(0, 1), c = random.uniform(0, 1 - b);
        const Eigen::Vector3d p = (1 - b - c) * t[0] + b * t[1] + c * t[2];
        seen = std::max(seen, referenceSolidDistance(mesh, p));
        seenOpen = std::max(seenOpen, referenceDistance(mesh, p));
      }
    }
    CHECK(seen <= parts.excess);
    CHECK(seenOpen <= parts.openExcess);
    CHECK(parts.openExcess >= parts.excess - 1e-4);
  }
}

TEST_CASE("an L is two boxes, and two separate boxes are two parts") {
  const ConvexParts l = convexParts(lShape(), quick(8));
  CHECK(l.parts.size() == 2);
  CHECK(l.excess < 2e-4);  // accuracy of the bound
  const ConvexParts boxes = convexParts(
      together({boxMesh({0, 0, 0}, {0.1, 0.1, 0.1}), boxMesh({0.3, 0, 0}, {0.4, 0.1, 0.1})}), quick(8));
  CHECK(boxes.parts.size() == 2);
  CHECK(boxes.excess < 2e-4);
  CHECK(convexParts(boxMesh({0, 0, 0}, {0.1, 0.2, 0.3}), quick(8)).parts.size() == 1);
}

TEST_CASE("an inside that no face of the mesh belongs to is covered too") {
  const TriangleMesh mesh = caltrop(0.02);
  const ConvexParts parts = convexParts(mesh, quick(8));
  CHECK(parts.closedPieces == 1);
  CHECK(parts.parts.size() > 3);
  const std::vector<StpBv::Ptr> volumes = volumesOf(parts);
  Random random(37);
  int open = 0;
  for (int i = 0; i < 1000; ++i) {  // random points of the tetrahedron
    Eigen::Vector4d weights;
    for (double& weight : weights) weight = random.uniform(0, 1);
    weights /= weights.sum();
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) p += weights[k] * mesh.vertices[static_cast<std::size_t>(k)];
    open += !covered(volumes, p);
  }
  CHECK(open == 0);
}

TEST_CASE("joined faces grow until they hold an inside that none of them reaches") {
  // A square tub over a hollow. Its floor is thick, and no hull of faces that are near each other has a point
  // in the middle of the floor.
  const TriangleMesh tub =
      turnedProfile({{0, 0.01}, {0.06, 0.01}, {0.1, 0}, {0.1, 0.3}, {0.08, 0.3}, {0.08, 0.04}, {0, 0.04}}, 4);
  PartsOptions options;
  options.most = 16;
  const ConvexParts parts = convexParts(tub, options);
  CHECK(parts.closedPieces == 1);
  CHECK(parts.parts.size() <= 10);
  CHECK(parts.excess < 2e-4);  // accuracy of the bound; by cuts it was 2 mm
  const std::vector<StpBv::Ptr> volumes = volumesOf(parts);
  Random random(41);
  int inside = 0, open = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d p(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(0, 0.05));
    if (std::abs(referenceWinding(tub, p)) < 0.5) continue;
    ++inside;
    open += !covered(volumes, p);
  }
  CHECK(inside > 5000);
  CHECK(open == 0);
}

TEST_CASE("more parts than eight are made from eight, and not farther from the mesh") {
  // A search that begins with many parts cuts them before any of them is near the mesh.
  for (const TriangleMesh& mesh : {torusMesh(0.12, 0.03, 24, 10), spikyBall()}) {
    double least = std::numeric_limits<double>::infinity();
    for (const int most : {8, 16, 32}) {
      const ConvexParts parts = convexParts(mesh, quick(most));
      CHECK(parts.parts.size() <= static_cast<std::size_t>(most));
      CHECK(parts.excess <= 1.01 * least);  // the search ignores smaller differences
      least = parts.excess;
    }
  }
}

TEST_CASE("a turned body is found in the cylinders that it is made of") {
  const ConvexParts parts = convexParts(dumbbell(20), quick(8));
  CHECK(parts.closedPieces == 1);
  CHECK(parts.parts.size() == 3);
  CHECK(parts.excess < 2e-4);  // accuracy of the bound
}

TEST_CASE("more parts are closer, and an excess asked for takes no more parts than it needs") {
  const TriangleMesh ring = torusMesh(0.12, 0.03, 24, 10);
  // One cut does not bring a ring's hull closer to the mesh; that needs a few cuts at once.
  const double one = convexParts(ring, quick(1)).excess, eight = convexParts(ring, quick(8)).excess;
  CHECK(eight < 0.8 * one);
  PartsOptions within = quick(16);
  within.excess = 0.02;
  const ConvexParts parts = convexParts(ring, within);
  CHECK(parts.excess <= 0.02);
  CHECK(parts.parts.size() > 2);
  CHECK(parts.parts.size() <= 12);  // eight are enough; the quick search does not find them
}

TEST_CASE("an excess that few parts reach is reached, not missed by a little") {
  // Three times, the search took parts that were 4 % too far from the mesh for near enough.
  const TriangleMesh cup =
      turnedProfile({{0, 0}, {0.04, 0}, {0.04, 0.1}, {0.035, 0.1}, {0.035, 0.005}, {0, 0.005}}, 19);
  PartsOptions options;
  options.most = 64;
  options.excess = 0.01;
  const ConvexParts parts = convexParts(cup, options);
  CHECK(parts.excess <= 0.01);
  CHECK(parts.parts.size() <= 9);
}

TEST_CASE("a mesh too fine for the search is covered all the same") {
  Random random(29);
  const TriangleMesh fine = finer(torusMesh(0.12, 0.03, 24, 12), 2);
  REQUIRE(fine.triangles.size() > 9000);
  const ConvexParts parts = convexParts(fine, quick(4));
  const std::vector<StpBv::Ptr> volumes = volumesOf(parts);
  int open = 0;
  for (int i = 0; i < 300; ++i) open += !covered(volumes, pointOn(fine, random));
  CHECK(open == 0);
}

TEST_CASE("parts of a rough mesh, of which the search saw a coarser one, cover it and its inside") {
  // Some parts contain only triangles of the coarse mesh.
  constexpr int kRings = 42;
  std::vector<std::pair<double, double>> profile;
  for (int i = 0; i <= kRings; ++i) {
    const double turn = M_PI * i / kRings, out = 1 + 0.3 * std::sin(3 * turn);
    profile.emplace_back(i % kRings == 0 ? 0.0 : out * std::sin(turn), -out * std::cos(turn));
  }
  TriangleMesh mesh = turnedProfile(profile, kRings);
  Random random(1);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Eigen::Vector3d& v = mesh.vertices[i];
    if (i % (kRings + 1) % kRings != 0) v *= 1 - 0.02 * random.uniform(0, 1);
    v = v.cwiseProduct(Eigen::Vector3d(1, 0.2, 0.5));
  }
  PartsOptions options = quick(64);
  options.effort = 0.02;
  const ConvexParts parts = convexParts(mesh, options);
  CHECK(parts.closedPieces == parts.pieces);
  CHECK(std::none_of(parts.parts.begin(), parts.parts.end(),
                     [](const ConvexPart& part) { return part.points.empty(); }));
  const std::vector<StpBv::Ptr> volumes = volumesOf(parts);
  int open = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d p = pointOn(mesh, random), q = 0.5 * (p + pointOn(mesh, random));
    open += !covered(volumes, p);
    open += !covered(volumes, q) && std::abs(referenceWinding(mesh, q)) > 0.5;
  }
  CHECK(open == 0);
}

TEST_CASE("one triangle, slivers and lines are covered; no triangle at all is refused") {
  const TriangleMesh one{{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, {{0, 1, 2}}};
  CHECK(convexParts(one).parts.size() == 1);
  CHECK(convexParts({{{0, 0, 0}, {0.1, 0, 0}}, {{0, 1, 1}}}).parts.size() == 1);
  CHECK(convexParts({{{0.1, 0, 0}}, {{0, 0, 0}}}).parts.size() == 1);
  TriangleMesh slivers;
  Random random(31);
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Vector3d a(random.uniform(0, 0.1), random.uniform(0, 0.1), random.uniform(0, 0.1)),
        b = a + 0.01 * random.direction();
    slivers.vertices.insert(slivers.vertices.end(), {a, b, 0.5 * (a + b)});
    slivers.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  const std::vector<StpBv::Ptr> volumes = volumesOf(convexParts(slivers, quick(4)));
  CHECK(std::all_of(slivers.vertices.begin(), slivers.vertices.end(),
                    [&](const auto& v) { return covered(volumes, v); }));
  CHECK_THROWS_WITH(convexParts({{{0, 0, 0}}, {}}), Contains("no triangles"));
  CHECK_THROWS_WITH(convexParts(one, quick(0)), Contains("most: got 0, expected a number from 1"));
}

TEST_CASE("lines and points in the plane of a cut stay on one side of it") {
  const Eigen::Vector3d far(0.12, 0.05, 0.02);
  TriangleMesh mesh = lShape();  // with an inner face at y = 0.05 and one at x = 0.05
  const int first = static_cast<int>(mesh.vertices.size());
  for (const double x : {0.1, 0.12, 0.4}) mesh.vertices.push_back({x, far.y(), far.z()});
  for (const double y : {0.11, 0.12, 0.5}) mesh.vertices.push_back({0.05, y, 0.01});
  TriangleMesh points = mesh;
  for (const int k : {first, first + 3}) {
    mesh.triangles.push_back({k, k + 1, k + 2});
    mesh.triangles.push_back({k + 2, k + 1, k});
  }
  for (int k = first; k < first + 30; ++k) {
    if (k >= static_cast<int>(points.vertices.size()))
      points.vertices.push_back({0.06 + 0.01 * (k - first), far.y(), far.z()});
    points.triangles.push_back({k, k, k});
  }
  for (const TriangleMesh& one : {mesh, points})
    for (const int most : {1, 2, 3, 8}) {
      CAPTURE(one.triangles.size(), most);
      const std::vector<StpBv::Ptr> volumes = volumesOf(convexParts(one, quick(most)));
      for (const Eigen::Vector3d& v : one.vertices) CHECK(covered(volumes, v));
    }
}

TEST_CASE("bodies with faces that are not convex are found in the boxes that they are made of") {
  // A U, two of whose faces are U-shaped, and a ring of twelve wedges, whose upper face is a ring.
  TriangleMesh u = lShape();
  TriangleMesh other = u;
  for (Eigen::Vector3d& v : other.vertices) v.x() = -v.x();
  const ConvexParts both = convexParts(together({u, turned(other)}), quick(8));
  CHECK(both.parts.size() <= 4);
  CHECK(both.excess < 1e-5);
  const ConvexParts wedges = convexParts(torusMesh(0.12, 0.03, 12, 6), quick(12));
  CHECK(wedges.parts.size() == 12);
  CHECK(wedges.excess < 1e-5);
}

TEST_CASE("triangles that hang together nowhere, or all about one edge, take no longer than a link's") {
  Random random(41);
  TriangleMesh soup;
  for (int i = 0; i < 300; ++i) {
    for (int k = 0; k < 3; ++k)
      soup.vertices.push_back({random.uniform(0, 0.1), random.uniform(0, 0.1), random.uniform(0, 0.1)});
    soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  TriangleMesh fan{{{0, 0, 0}, {0, 0, 0.1}}, {}};
  for (int i = 0; i < 3000; ++i) {
    fan.vertices.push_back({0.1 * std::cos(0.002 * i), 0.1 * std::sin(0.002 * i), 0.05});
    fan.triangles.push_back({0, 1, 2 + i});
  }
  for (const TriangleMesh& mesh : {soup, fan}) {
    const std::vector<StpBv::Ptr> volumes = volumesOf(convexParts(mesh, quick(4)));
    int open = 0;
    for (int i = 0; i < 300; ++i) open += !covered(volumes, pointOn(mesh, random));
    CHECK(open == 0);
  }
}

TEST_CASE("shells in shells, copies and crossings, at any size, are covered by few parts") {
  const TriangleMesh box = boxMesh({0, 0, 0}, {0.1, 0.1, 0.1}),
                     in = boxMesh({0.02, 0.02, 0.02}, {0.08, 0.08, 0.08});
  for (const TriangleMesh& nested :
       {together({box, in}), together({box, turned(in)}), together({turned(box), in})}) {
    const ConvexParts parts = convexParts(nested, quick(8));
    CHECK(parts.parts.size() == 1);
    CHECK(parts.excess < 1e-9);
  }
  const ConvexParts copies = convexParts(together({lShape(), lShape(), lShape()}), quick(8));
  CHECK(copies.parts.size() == 2);
  CHECK(copies.excess < 1e-5);
  for (const double size : {1e-9, 1e-3, 1e7}) {
    TriangleMesh mesh = lShape();
    for (Eigen::Vector3d& v : mesh.vertices) v *= size;
    const ConvexParts parts = convexParts(mesh, quick(8));
    CHECK(parts.parts.size() == 2);
    CHECK(parts.excess < 1e-4 * size);
  }
}
