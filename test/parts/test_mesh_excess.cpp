// Distances from meshes, their insides, and the bound on the distance of a surface from a mesh.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/parts/known_excess.h"
#include "fcl_stpbv/parts/mesh_solid.h"
#include "test/reference/mesh_reference.h"
#include "test/reference/solids.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Catch::Matchers::Contains;
using Eigen::Vector3d;

namespace {

constexpr double kRounding = 1e-14;  // m, of coordinates below 1 m

std::vector<std::pair<std::string, TriangleMesh>> closedMeshes() {
  Random random(3);
  const TriangleMesh ball = torusMesh(0.12, 0.03, 24, 12);
  return {{"an L", lShape()},
          {"a fine L, shaken", shaken(lShape(), 1e-3, random)},
          {"a ring", ball},
          {"a ring inside out", turned(ball)},
          {"two boxes that cross",
           together({boxMesh({0, 0, 0}, {0.1, 0.1, 0.1}), boxMesh({0.05, 0.05, 0.02}, {0.2, 0.08, 0.08})})}};
}

Eigen::Vector3d pointAround(const TriangleMesh& mesh, Random& random) {
  Eigen::Vector3d low = mesh.vertices[0], high = low;
  for (const Eigen::Vector3d& v : mesh.vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  Eigen::Vector3d p;
  for (int k = 0; k < 3; ++k) p[k] = random.uniform(low[k] - 0.01, high[k] + 0.01);
  return p;
}

}  // namespace

TEST_CASE("the distance from a mesh is that of its nearest triangle") {
  Random random(5);
  for (const auto& [name, mesh] : closedMeshes()) {
    INFO(name);
    const MeshSolid solid(mesh);
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3d p = pointAround(mesh, random);
      worst = std::max(worst, std::abs(solid.nearest(p).distance - referenceDistance(mesh, p)));
      worst =
          std::max(worst, std::abs(solid.nearest(p, random.below(12)).distance - referenceDistance(mesh, p)));
    }
    CHECK(worst < kRounding);
  }
}

TEST_CASE("the distance from a triangle holds for slivers, needles and points") {
  Random random(6);
  double below = 0, above = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto anywhere = [&] {
      return Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    const double width = std::pow(10, random.uniform(-17, 0));  // width of a triangle a metre long
    const Vector3d a = anywhere(), b = anywhere(),
                   c = a + random.uniform(-0.5, 1.5) * (b - a) + width * anywhere();
    const Vector3d beside = anywhere() * std::pow(10, random.uniform(-16, 0));
    const double s = random.uniform(-0.2, 1.2), t = random.uniform(-0.2, 1.2);
    const Vector3d p = a + s * (b - a) + t * (c - a) + beside;
    const double found = MeshSolid({{a, b, c}, {{0, 1, 2}}}).nearest(p).distance;
    const double u = (b - a).norm(), v = (c - a).norm(), sine = (b - a).cross(c - a).norm() / (u * v);
    const double sides = referenceDistance({{a, b, c}, {{0, 1, 1}, {1, 2, 2}, {2, 0, 0}}}, p);
    if (sine > 1e-5) {  // rounding moves a foot in the plane by about 1e-15 / sine
      const double truth = referenceDistance({{a, b, c}, {{0, 1, 2}}}, p);
      below = std::max(below, truth - found);
      above = std::max(above, found - truth - 1e-15 / sine);
    } else {  // the plane of a sliver is too inaccurate in the reference
      below = std::max(below, sides - sine * std::min(u, v) - found);
      above = std::max(above, found - sides);
    }
  }
  CHECK(below < kRounding);
  CHECK(above < kRounding);
  const MeshSolid point(TriangleMesh{{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, {{0, 1, 2}}});
  CHECK(point.nearest({1, 2, 5}).distance == 2);
}

TEST_CASE("a distance that is near enough ends the search for a nearer one") {
  Random random(8);
  for (const auto& [name, mesh] : closedMeshes()) {
    INFO(name);
    const MeshSolid solid(mesh);
    int ended = 0;
    for (int i = 0; i < 500; ++i) {
      const Eigen::Vector3d p = pointAround(mesh, random);
      const double truth = referenceDistance(mesh, p), enough = random.uniform(0, 0.05);
      const MeshSolid::Nearest found = solid.nearest(p, -1, enough);
      CHECK(found.distance >= truth - kRounding);
      CHECK(found.distance <= std::max(truth, enough) + kRounding);
      CHECK(std::abs(found.distance - solid.distance(p, found.triangle)) < kRounding);
      ended += found.distance > truth + kRounding;
    }
    CHECK(ended > 0);
  }
}

TEST_CASE("the excess of a needle ends") {
  // A triangle of a hull with its corners on a line, next to the mesh's nearest triangle (upper arm of
  // Interbotix' WX250). No part of it is over that triangle, so cutting that part off left the same needle.
  const Vector3d left(-0.0496, -0.0215, 0.23575), middle(0.00144, -0.0215, 0.23575),
      right(0.0496, -0.0215, 0.23575);
  const TriangleMesh mesh{
      {left, right, {-0.0104, -0.02, 0.23355}, {0.0104, -0.02, 0.23355}, {-0.0104, -0.0121, 0.23355}},
      {{0, 0, 0}, {1, 1, 1}, {2, 3, 4}}};
  ExcessOptions options;
  options.absolute = 1e-7;
  const MeshExcess excess = excessOf({{left, middle, right}}, MeshSolid(mesh), options);
  CHECK(excess.lower > 0.01);
  CHECK(excess.upper <= excess.lower * (1 + options.relative) + options.absolute);
}

TEST_CASE("a mesh encloses what its winding number says, whichever way its faces point") {
  Random random(7);
  for (const auto& [name, mesh] : closedMeshes()) {
    INFO(name);
    const MeshSolid solid(mesh);
    CHECK(solid.closed());
    int enclosed = 0, wrong = 0;
    for (int i = 0; i < 2000; ++i) {
      const Eigen::Vector3d p = pointAround(mesh, random);
      const bool inside = std::abs(referenceWinding(mesh, p)) > 0.5;
      enclosed += inside;
      wrong += solid.side(p) != (inside ? MeshSolid::Side::enclosed : MeshSolid::Side::outside);
    }
    CHECK(enclosed > 100);
    CHECK(wrong == 0);
  }
}

TEST_CASE("single flipped faces are turned to agree with their neighbours") {
  TriangleMesh mesh = lShape();
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3)
    std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
  const MeshSolid solid(mesh);
  CHECK(solid.closed());
  CHECK(solid.side({0.02, 0.02, 0.02}) == MeshSolid::Side::enclosed);
  CHECK(solid.side({0.1, 0.1, 0.02}) == MeshSolid::Side::outside);
}

TEST_CASE("a shell inside another is enclosed, cavity or not") {
  const TriangleMesh inner = boxMesh({0.04, 0.04, 0.04}, {0.06, 0.06, 0.06}),
                     outer = boxMesh({0, 0, 0}, {0.1, 0.1, 0.1});
  for (const TriangleMesh& nested : {inner, turned(inner)})
    CHECK(MeshSolid(together({outer, nested})).side({0.05, 0.051, 0.0502}) == MeshSolid::Side::enclosed);
}

TEST_CASE("a mesh with a hole encloses nothing, and a point on a surface is on no side for sure") {
  const MeshSolid open(bowl(0.1, 8));
  CHECK_FALSE(open.closed());
  CHECK(open.pieces().closedPieces() == 0);
  CHECK(open.side({0, 0, -0.05}) == MeshSolid::Side::outside);
  CHECK(MeshSolid(lShape()).side({0.025, 0.03, 0.05}) == MeshSolid::Side::unsure);
}

TEST_CASE("the excess of a hull over a closed mesh, and over open ones, lies between its bounds") {
  Random random(11);
  auto meshes = closedMeshes();
  meshes.push_back({"a bowl", bowl(0.1, 10)});
  meshes.push_back({"a bowl beside a ring", together({bowl(0.1, 6), torusMesh(0.2, 0.02, 20, 8)})});
  for (const auto& [name, mesh] : meshes) {
    const MeshSolid solid(mesh);
    TriangleMesh hull;
    for (const Triangle& t : hullTriangles(mesh.vertices)) {
      const int n = static_cast<int>(hull.vertices.size());
      hull.vertices.insert(hull.vertices.end(), t.begin(), t.end());
      hull.triangles.push_back({n, n + 1, n + 2});
    }
    for (const bool filled : {true, false}) {
      INFO(name << (filled ? ", filled" : ""));
      const auto truth = [&](const Eigen::Vector3d& p) {
        return filled ? referenceSolidDistance(mesh, p) : referenceDistance(mesh, p);
      };
      ExcessOptions options;
      options.filled = filled;
      const MeshExcess excess = hullExcess(mesh.vertices, solid, options);
      CHECK(excess.upper - excess.lower <= options.absolute + options.relative * excess.lower);
      CHECK(truth(excess.where) >= excess.lower - kRounding);
      double seen = 0;
      for (int i = 0; i < 1000; ++i) seen = std::max(seen, truth(pointOn(hull, random)));
      CHECK(seen <= excess.upper);
      CHECK(seen > 0.5 * excess.lower);
    }
  }
}

TEST_CASE(
    "the hull of an L is farthest from it where its long face is as far from one arm as from the other") {
  ExcessOptions exact;
  exact.absolute = 1e-9;
  exact.relative = 1e-9;
  const MeshExcess excess = hullExcess(lShape().vertices, MeshSolid(lShape()), exact);
  const double truth = 0.075;  // at (0.125, 0.125), which is equally far from both arms
  CHECK(excess.lower <= truth + 1e-9);
  CHECK(excess.upper >= truth - kRounding);
  CHECK(excess.upper - excess.lower < 2e-9);
}

TEST_CASE("bounds that go on from those of earlier hulls hold, and are as narrow") {
  for (const bool closed : {true, false}) {
    TriangleMesh shape = torusMesh(0.12, 0.03, 24, 12);
    if (!closed) shape.triangles.resize(shape.triangles.size() - 5);
    const MeshSolid mesh(shape);
    REQUIRE(mesh.hasInside() == closed);
    detail::KnownExcess known;
    Random random(5);
    for (int hull = 0; hull < 60; ++hull) {  // most of the points each, so that they share faces
      std::vector<Vector3d> points;
      for (const Vector3d& p : shape.vertices)
        if (random.uniform(0, 8) > 1) points.push_back(p);
      const std::vector<Triangle> surface = hullTriangles(points);
      ExcessOptions options;
      options.absolute = hull % 3 == 0 ? 1e-3 : 1e-5;
      options.relative = hull % 2 == 0 ? 0.1 : 1e-3;
      options.queries = hull % 5 == 0 ? 50 : 100000;
      const MeshExcess found = detail::excessOf(surface, mesh, options, known);
      const MeshExcess alone = excessOf(surface, mesh);
      CHECK(found.lower <= alone.upper);
      CHECK(alone.lower <= found.upper);
      CHECK(mesh.nearest(found.where).distance >= found.lower - 1e-12);
      if (hull % 5 != 0)
        CHECK(found.upper <= found.lower * (1 + options.relative) + options.absolute + 1e-12);
      options.queries = 100000;
      options.enough = 0.5 * alone.lower;
      CHECK(detail::excessOf(surface, mesh, options, known).lower > options.enough);
    }
  }
}

TEST_CASE("a bound that may not take long is wider and still holds") {
  ExcessOptions few;
  few.queries = 100;
  const MeshSolid ring(torusMesh(0.12, 0.03, 24, 12));
  const MeshExcess rough = hullExcess(torusMesh(0.12, 0.03, 24, 12).vertices, ring, few);
  const MeshExcess fine = hullExcess(torusMesh(0.12, 0.03, 24, 12).vertices, ring);
  CHECK(rough.upper >= fine.lower);
  CHECK(rough.lower <= fine.upper);
}

TEST_CASE("a mesh without triangles, or with coordinates that are no numbers, is refused in one message") {
  CHECK_THROWS_WITH(MeshSolid({{{0, 0, 0}}, {}}), Contains("no triangles"));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(MeshSolid({{{0, 0, 0}, {1, 0, nan}, {0, 1, 0}}, {{0, 1, 2}}}), Contains("finite"));
  CHECK_THROWS_WITH(MeshSolid({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}}), Contains("does not exist"));
}

TEST_CASE("a hull of no points, or of coordinates that are no numbers, is refused in one message") {
  const MeshSolid solid(lShape());
  CHECK_THROWS_WITH(hullExcess({}, solid), Contains("no points"));
  CHECK_THROWS_WITH(hullTriangles({}), Contains("no points"));
  CHECK_THROWS_WITH(hullExcess({{0, 0, 0}, {std::nan(""), 0, 0}}, solid), Contains("point 1 is not finite"));
}

TEST_CASE(
    "parts whose faces end on flat parts' borders and inside the solid are known to a millionth, quickly") {
  // The lower box of an L, and the whole height of its upright part. Their faces partly lie on the L's own
  // faces and partly cross its inside.
  const MeshSolid solid(lShape());
  const Eigen::Vector3d low = solid.low(), high = solid.high();
  ExcessOptions fine;
  fine.absolute = 1e-6;
  fine.queries = 2000;                  // halving alone would take more than 100,000
  std::vector<Eigen::Vector3d> corner;  // a box inside, whose faces lie on three of the L's
  for (int k = 0; k < 8; ++k)
    corner.push_back(low + 0.05 * Eigen::Vector3d(k & 1, k >> 1 & 1, k >> 2 & 1).cwiseProduct(high - low));
  CHECK(hullExcess(corner, solid, fine).upper <= 1e-6);
  const MeshExcess whole = hullExcess(solid.pieces().vertices, solid, fine);
  CHECK(whole.upper <= 1.001 * whole.lower + 1.001e-6);
  CHECK(whole.lower > 1e-3);
}
