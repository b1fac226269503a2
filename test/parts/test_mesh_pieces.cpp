// Meshes with faces that were written more than once: they enclose the same space.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/parts/mesh_solid.h"
#include "test/reference/mesh_reference.h"
#include "test/reference/solids.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

using Side = MeshSolid::Side;

std::array<int, 3> opposite(const std::array<int, 3>& t) { return {t[0], t[2], t[1]}; }

// The mesh with both sides of every face.
TriangleMesh doubleSided(TriangleMesh mesh) {
  const std::vector<std::array<int, 3>> faces = mesh.triangles;
  for (const auto& t : faces) mesh.triangles.push_back(opposite(t));
  return mesh;
}

// A cube of 1 m without its left and right faces, and one of these faces.
TriangleMesh tube(double x) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(x + (i & 1), (i >> 1) & 1, i >> 2);
  mesh.triangles = {{0, 1, 5}, {0, 5, 4}, {2, 7, 3}, {2, 6, 7}, {0, 3, 1}, {0, 2, 3}, {4, 5, 7}, {4, 7, 6}};
  return mesh;
}
TriangleMesh wall(double x) {
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) mesh.vertices.emplace_back(x, i & 1, i >> 1);
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}};  // seen from the right
  return mesh;
}

}  // namespace

TEST_CASE("a mesh encloses the same with faces written twice, in any direction") {
  Random random(11);
  for (const TriangleMesh& sound : {lShape(), torusMesh(0.12, 0.03, 24, 12)}) {
    std::vector<TriangleMesh> meshes{doubleSided(sound), together({sound, sound}),
                                     together({sound, turned(sound), sound})};
    for (const int every : {1, 2, 3, 17, 1000}) {
      TriangleMesh mesh = sound;
      for (std::size_t t = 0; t < sound.triangles.size(); t += static_cast<std::size_t>(every))
        for (int copies = random.below(3); copies >= 0; --copies)
          mesh.triangles.push_back(random.below(2) ? sound.triangles[t] : opposite(sound.triangles[t]));
      for (std::size_t t = mesh.triangles.size() - 1; t > 0; --t)
        std::swap(mesh.triangles[t], mesh.triangles[static_cast<std::size_t>(random.below(int(t) + 1))]);
      meshes.push_back(mesh);
    }
    for (const TriangleMesh& mesh : meshes) {
      const MeshSolid solid(mesh), plain(sound);
      CHECK(solid.closed());
      CHECK(solid.triangles().size() == plain.triangles().size());
      int wrong = 0, enclosed = 0;
      for (int i = 0; i < 1000; ++i) {
        const Eigen::Vector3d p(random.uniform(-0.15, 0.15), random.uniform(-0.15, 0.15),
                                random.uniform(-0.05, 0.15));
        const Side side = plain.side(p);
        if (side == Side::unsure) continue;
        enclosed += side == Side::enclosed;
        wrong += solid.side(p) != side;
      }
      CHECK(wrong == 0);
      CHECK(enclosed > 10);
    }
  }
}

TEST_CASE("parts cover the inside of a mesh with faces written twice") {
  TriangleMesh mesh = doubleSided(lShape());
  const ConvexParts parts = convexParts(mesh, {2}), plain = convexParts(lShape(), {2});
  CHECK(parts.closedPieces == 1);
  CHECK(parts.parts.size() == plain.parts.size());
  CHECK(parts.excess == plain.excess);
}

TEST_CASE("two bodies with a wall between them are closed, wherever the wall's faces point") {
  const TriangleMesh w = wall(0);
  for (const TriangleMesh& between :
       {together({w, turned(w)}), together({w, w}), together({turned(w), turned(w)}), together({w, w, w})}) {
    const MeshSolid solid(together({turned(wall(-1)), tube(-1), between, tube(0), wall(1)}));
    CHECK(solid.closed());
    CHECK(solid.side({-0.41, 0.53, 0.37}) == Side::enclosed);
    CHECK(solid.side({0.41, 0.53, 0.37}) == Side::enclosed);
    CHECK(solid.side({1.41, 0.53, 0.37}) == Side::outside);
    CHECK(solid.nearest({0.1, 0.53, 0.37}).distance == Approx(0.1));
  }
}

TEST_CASE(
    "a fin with two sides on a body encloses nothing, and the body encloses the same space as without it") {
  TriangleMesh fin;
  fin.vertices = {{1, 0, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0, 0}};
  fin.triangles = {{0, 1, 2}, {0, 2, 3}};
  const TriangleMesh cube = together({turned(wall(0)), tube(0), wall(1)});
  const MeshSolid solid(together({cube, doubleSided(fin)}));
  CHECK(solid.closed());
  CHECK(solid.side({0.41, 0.53, 0.37}) == Side::enclosed);
  CHECK(solid.side({1.41, 0.53, 0.01}) == Side::outside);
  CHECK(solid.nearest({1.5, 0.5, 0.25}).distance == Approx(0.25));
  CHECK_FALSE(MeshSolid(together({cube, fin})).closed());
}

TEST_CASE("sheets with two sides are not closed: they have no inside") {
  const TriangleMesh box = together({turned(wall(0)), tube(0)});
  for (const TriangleMesh& sheet : {doubleSided(wall(0)), doubleSided(box), box}) {
    const MeshSolid solid(sheet);
    CHECK_FALSE(solid.closed());
    CHECK(solid.side({0.41, 0.53, 0.37}) == Side::outside);
  }
}

TEST_CASE("points of no triangle are pieces that enclose nothing, and parts cover them") {
  TriangleMesh mesh = together({turned(wall(0)), tube(0), wall(1)});
  mesh.vertices.emplace_back(3, 0.5, 0.5);
  mesh.vertices.emplace_back(3, 0.5, 0.5);  // the same again
  mesh.vertices.push_back(mesh.vertices[0]);
  const MeshSolid solid(mesh);
  CHECK(solid.closed());
  CHECK(solid.pieces().pieces() == 2);
  CHECK(solid.side({0.41, 0.53, 0.37}) == Side::enclosed);
  CHECK(solid.side({2.9, 0.5, 0.5}) == Side::outside);
  CHECK(solid.nearest({2.5, 0.5, 0.5}).distance == Approx(0.5));
  for (const int most : {1, 4}) {
    PartsOptions options;
    options.most = most;
    const ConvexParts parts = convexParts(mesh, options);
    const bool covered = std::any_of(parts.parts.begin(), parts.parts.end(), [](const ConvexPart& part) {
      return std::find(part.points.begin(), part.points.end(), Eigen::Vector3d(3, 0.5, 0.5)) !=
             part.points.end();
    });
    CAPTURE(most);
    CHECK(covered);
  }
}

TEST_CASE(
    "triangles that are only a corner or an edge of others are no pieces, and copies of lines are one") {
  for (TriangleMesh mesh : {together({turned(wall(0)), tube(0), wall(1)}), tube(0)}) {
    const MeshPieces sound = meshPieces(mesh);
    const int far = static_cast<int>(mesh.vertices.size());
    for (int i = 0; i < far; ++i) mesh.triangles.push_back({i, i, i});
    mesh.triangles.push_back({0, 1, 1});
    MeshPieces found = meshPieces(mesh);
    CHECK(found.triangles == sound.triangles);
    CHECK(found.pieces() == sound.pieces());
    CHECK(found.closedPieces() == sound.closedPieces());
    mesh.vertices.emplace_back(3, 0.5, 0.5);
    for (const std::array<int, 3>& line :
         {std::array{0, far, far}, std::array{far, 0, 0}, std::array{far, far, 0}, std::array{far, far, far}})
      mesh.triangles.push_back(line);
    found = meshPieces(mesh);
    CHECK(found.pieces() == sound.pieces() + 1);
    CHECK(found.closedPieces() == sound.closedPieces());
  }
}
