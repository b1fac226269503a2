// The proof that hulls cover the inside of a mesh, on a cube in eight.
#include <catch2/catch.hpp>

#include "fcl_stpbv/parts/inside_proof.h"
#include "test/reference/shapes.h"
#include "test/reference/solids.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

constexpr double kSlack = 1e-7;

// The corners of each eighth of a cube of 2 m, moved a bit from its corner
// in the middle, or without that one.
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
  CHECK(isInsideCovered(all, eighths(true, 1e-8), cube, kSlack));  // within what hulls are moved out
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
  CHECK(flat.front().empty());
  CHECK_FALSE(isInsideCovered(Cell(cube), flat, cube, kSlack));
  const Cell beside = Cell(cube).above({Vector3d::UnitX(), 1.0 + 1e-3}, kSlack);
  CHECK(isInsideCovered(beside, flat, cube, kSlack));
}
