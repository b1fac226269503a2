// The proof that hulls cover the inside of a mesh, for a cube in eight parts.
#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "fcl_stpbv/parts/inside_proof.h"
#include "test/reference/shapes.h"
#include "test/reference/solids.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

constexpr double kSlack = 1e-7;

// The corners of each eighth of a cube of 2 m. The corner in the cube's middle is moved a little, or left
// out.
std::vector<HullPlanes> eighths(bool middle, double gap = 0) {
  std::vector<HullPlanes> hulls;
  for (int k = 0; k < 8; ++k) {
    const Vector3d out(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    std::vector<Vector3d> points;
    for (int c = middle ? 0 : 1; c < 8; ++c)
      points.push_back(out.cwiseProduct(Vector3d(c & 1 ? 1 : gap, c & 2 ? 1 : gap, c & 4 ? 1 : gap)));
    hulls.push_back(hullPlanes(points, 2 * kSlack));
  }
  return hulls;
}

}  // namespace

TEST_CASE("eight boxes cover a cube, and not without the corners in its middle") {
  const MeshSolid cube(boxMesh({-1, -1, -1}, {1, 1, 1}));
  const Cell all(cube);
  CHECK(isInsideCovered(all, eighths(true), cube, kSlack));
  CHECK_FALSE(isInsideCovered(all, eighths(false), cube, kSlack));
  CHECK_FALSE(isInsideCovered(all, eighths(true, 1e-5), cube, kSlack));
  CHECK(isInsideCovered(all, eighths(true, 1e-8), cube, kSlack));  // less than hulls are moved outwards
  std::vector<HullPlanes> seven = eighths(true);
  seven.pop_back();
  CHECK_FALSE(isInsideCovered(all, seven, cube, kSlack));
  const Cell half = all.above({Vector3d::UnitX(), 0}, kSlack).above({-Vector3d::UnitX(), -1.0}, kSlack);
  CHECK(isInsideCovered(half.above({Vector3d(0, 0, -1), 0}, kSlack), seven, cube, kSlack));
}

TEST_CASE("a flat hull covers nothing, and a cell outside the mesh needs nothing") {
  const MeshSolid cube(boxMesh({-1, -1, -1}, {1, 1, 1}));
  const std::vector<HullPlanes> flat{
      hullPlanes({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, 2 * kSlack)};
  CHECK(flat.front().size() == 1);
  CHECK(hullPlanes({{-1, -1, 0}, {1, 1, 0}}, 2 * kSlack).empty());
  CHECK_FALSE(isInsideCovered(Cell(cube), flat, cube, kSlack));
  const Cell beside = Cell(cube).above({Vector3d::UnitX(), 1.0 + 1e-3}, kSlack);
  CHECK(isInsideCovered(beside, flat, cube, kSlack));
}

TEST_CASE("a floor of two flat hulls covers nothing between them, whatever is above it") {
  // A pan: a box of 2 x 2 x 1 m that is hollow from above, with a floor and walls.
  const auto [floor, inner] =
      GENERATE(table<double, double>({{0.3, 0.7}, {0.3, 0.9}, {0.1, 0.9}, {0.1, 0.5}}));
  CAPTURE(floor, inner);
  TriangleMesh pan = boxMesh({-1, -1, 0}, {1, 1, 1});
  TriangleMesh hollow = boxMesh({-inner, -inner, floor}, {inner, inner, 1});
  for (auto& t : hollow.triangles) std::swap(t[1], t[2]);
  for (TriangleMesh* mesh : {&pan, &hollow})  // without their lids
    mesh->triangles.erase(std::remove_if(mesh->triangles.begin(), mesh->triangles.end(),
                                         [&](const auto& t) {
                                           return std::all_of(t.begin(), t.end(), [&](int v) {
                                             return mesh->vertices[static_cast<std::size_t>(v)].z() == 1;
                                           });
                                         }),
                          mesh->triangles.end());
  TriangleMesh whole = together({pan, hollow});
  const int own = static_cast<int>(pan.vertices.size());
  for (int k = 0; k < 4; ++k) {  // the rim: corners 4 to 7 of each box are its upper ones
    const int a = 4 + k, b = 4 + (k + 1) % 4;
    whole.triangles.push_back({a, b, own + b});
    whole.triangles.push_back({a, own + b, own + a});
  }
  const MeshSolid solid(whole);
  REQUIRE(solid.pieces().closedPieces() == 1);
  const auto floorAt = [](double half, double z) {
    return hullPlanes({{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}}, 2 * kSlack);
  };
  std::vector<HullPlanes> hulls;
  for (const double sign : {-1.0, 1.0}) {
    std::vector<Vector3d> alongX, alongY;
    for (const double z : {0.0, floor, 1.0})
      for (const double side : {-1.0, 1.0})
        for (const double across : {1.0, inner}) {
          if (z == 0 && across < 1) continue;
          alongX.push_back({sign * across, side * across, z});
          alongY.push_back({side * across, sign * across, z});
        }
    hulls.push_back(hullPlanes(alongX, 2 * kSlack));
    hulls.push_back(hullPlanes(alongY, 2 * kSlack));
  }
  std::vector<HullPlanes> flat = hulls, slab = hulls;
  flat.push_back(floorAt(1, 0));
  flat.push_back(floorAt(inner, floor));
  std::vector<Vector3d> both;
  for (const double side : {-1.0, 1.0})
    for (const double other : {-1.0, 1.0}) {
      both.push_back({side, other, 0});
      both.push_back({inner * side, inner * other, floor});
    }
  slab.push_back(hullPlanes(both, 2 * kSlack));
  CHECK(isInsideCovered(Cell(solid), slab, solid, kSlack));
  CHECK_FALSE(isInsideCovered(Cell(solid), flat, solid, kSlack));
}
