// A built volume: its features, its surface, and what the builder refuses.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/brute_support.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

struct Counts {
  int vertices, edges, faces;
  bool operator==(const Counts& o) const {
    return vertices == o.vertices && edges == o.edges && faces == o.faces;
  }
};
std::ostream& operator<<(std::ostream& out, const Counts& c) {
  return out << c.vertices << " vertices, " << c.edges << " edges, " << c.faces << " faces";
}
Counts countsOf(const StpBv& v) { return {v.vertexCount(), v.edgeCount(), v.faceCount()}; }

Cloud disc(double radius, int sides) {
  Cloud points;
  for (const Vector3d& p : cylinder(radius, 1, sides))
    if (p.z() > 0) points.push_back({p.x(), p.y(), 0});
  return points;
}

struct Named {
  const char* name;
  Cloud points;
};

// Clouds that are small enough for the brute-force reference.
std::vector<Named> smallClouds() {
  Cloud flat = randomHull(14, {0.3, 0.2, 0.1}, 5);
  for (Vector3d& p : flat) p.z() = 0;
  Cloud line;
  for (int i = 0; i < 7; ++i) line.push_back(Vector3d(0.1, 0.2, -0.3) * (i / 6.0));
  Cloud doubled = box(0.2, 0.3, 0.4);
  Random random(11);
  for (int i = 0; i < 8; ++i)
    doubled.push_back(doubled[static_cast<std::size_t>(i)] + 1e-9 * random.direction());
  return {{"one point", {{1, 2, 3}}},
          {"two points", {{0, 0, 0}, {0.3, 0, 0}}},
          {"three points", {{0, 0, 0}, {0.3, 0, 0}, {0.1, 0.05, 0}}},
          {"collinear points", line},
          {"flat points", flat},
          {"disc", disc(0.1, 12)},
          {"box", box(0.2, 0.4, 0.6)},
          {"plate", plate(0.3, 0.2)},
          {"needle", needle(0.5)},
          {"prism", cylinder(0.1, 0.3, 7)},
          {"icosahedron", geodesicSphere(0.2, 0)},
          {"random points", randomHull(20, {0.1, 0.2, 0.3}, 3)},
          {"duplicates 1e-9 apart", doubled}};
}

}  // namespace

TEST_CASE("The support function equals the definition by all pairs and triples of points") {
  for (const Named& cloud : smallClouds()) {
    const double smallest = StpBv::smallestR(cloud.points, 0.01);
    for (const double R : {smallest * 1.001, smallest * 1.1, 0.6, 1.0, 10.0, 100.0}) {
      if (R <= smallest) continue;
      INFO(cloud.name << " at R = " << R);
      const StpBv::Ptr volume = StpBv::build(cloud.points, {0.01, R});
      Random random(7);
      double worst = 0;
      for (int k = 0; k < 60; ++k) {
        const Vector3d n = random.direction();
        const long double expected = bruteSupport(cloud.points, 0.01, R, n);
        worst = std::max(worst, static_cast<double>(std::abs(volume->support(n) - expected)));
      }
      // The library rounds coordinates of up to 4 m. The reference's slack of 1e-17 rho^2 moves its centres
      // by 1e-17 rho, times the ratio of rho to a face's size.
      CHECK(worst <= 2e-15 * (1 + R));
    }
  }
}

TEST_CASE("An edge that turns by a little more than half a turn owns all its normals") {
  // Flat obtuse triangles. The longest side turns by half a turn or more; the larger R, the less. Around the
  // plate's normals the longest side is the highest feature.
  for (const double apex : {0.03, 0.05, 0.08, 0.095, 0.0999})
    for (const double R : {1.0, 10.0, 100.0, 1e4, 1e6}) {
      INFO("apex " << apex << ", R = " << R);
      const Cloud points{{0, 0, 0}, {0.2, 0, 0}, {0.1, apex, 0}};
      const StpBv::Ptr volume = StpBv::build(points, {0.01, R});
      Random random(7);
      double worst = 0;
      for (int k = 0; k < 400; ++k) {
        const double tilt = std::pow(10, -random.uniform(0, 8));
        const Vector3d n = (Vector3d::UnitZ() + tilt * random.direction()).normalized();
        const long double expected = bruteSupport(points, 0.01, R, n);
        worst = std::max(worst, static_cast<double>(std::abs(volume->support(n) - expected)));
      }
      CHECK(worst <= 2e-15 * (1 + R));
      CHECK(verify(*volume, points).message == "ok");
    }
}

TEST_CASE("A built volume verifies itself from the smallest radius to a million metres") {
  std::vector<Named> clouds = smallClouds();
  clouds.push_back({"32-gon disc", disc(0.1, 32)});
  clouds.push_back({"32-gon cylinder", cylinder(0.1, 0.3)});
  clouds.push_back({"geodesic sphere", geodesicSphere(0.2, 2)});
  clouds.push_back({"random cloud", randomHull(400, {0.3, 0.2, 0.1}, 9)});
  for (const Named& cloud : clouds) {
    const double smallest = StpBv::smallestR(cloud.points, 0.01);
    for (const double R : {smallest * (1 + 1e-9), smallest * (1 + 1e-6), smallest * 1.001, smallest * 1.3,
                           1.0, 10.0, 1e4, 1e6}) {
      if (R <= smallest) continue;
      INFO(cloud.name << " at R = " << R);
      const Verification check = verify(*StpBv::build(cloud.points, {0.01, R}), cloud.points);
      INFO(check.message);
      CHECK(check.ok);
    }
  }
}

TEST_CASE("Cospherical points share one k-gon face in any orientation") {
  Random random(3);
  const auto turned = [&](Cloud points) {
    const Eigen::Matrix3d rotation = random.rotation();
    const Vector3d shift = random.direction();
    for (Vector3d& p : points) p = rotation * p + shift;
    return points;
  };
  for (int k = 0; k < 50; ++k) {
    CHECK(countsOf(*StpBv::build(turned(box(0.2, 0.4, 0.6)))) == Counts{8, 12, 6});
    CHECK(countsOf(*StpBv::build(turned(plate(0.3, 0.2)))) == Counts{8, 12, 6});
    CHECK(countsOf(*StpBv::build(turned(cylinder(0.1, 0.3)))) == Counts{64, 96, 34});
    CHECK(countsOf(*StpBv::build(turned(disc(0.1, 32)))) == Counts{32, 32, 2});
  }
  CHECK(countsOf(*StpBv::build(geodesicSphere(0.2, 2))) == Counts{162, 480, 320});
}

TEST_CASE("Clouds of fewer than three dimensions give a sphere, a spindle and a lens") {
  CHECK(countsOf(*StpBv::build({{1, 2, 3}})) == Counts{1, 0, 0});
  CHECK(countsOf(*StpBv::build({{0, 0, 0}, {0.3, 0, 0}})) == Counts{2, 1, 0});
  CHECK(countsOf(*StpBv::build({{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}, {0.3, 0, 0}})) == Counts{2, 1, 0});
  CHECK(countsOf(*StpBv::build({{0, 0, 0}, {0.3, 0, 0}, {0.1, 0.2, 0}})) == Counts{3, 3, 2});
}

TEST_CASE("Two vertices may be joined by two edges near the smallest radius") {
  // Only two opposite sides cut into the spindle of the two far points.
  const Cloud points{{-1, 0, 0}, {1, 0, 0}, {0, 0.8, 0}, {0, -0.8, 0}};
  const StpBv::Ptr volume = StpBv::build(points, {0, 1.05});
  CHECK(countsOf(*volume) == Counts{4, 6, 4});
  int joining = 0;
  for (const StpBv::Edge& edge : volume->edges()) joining += edge.vertex[0] + edge.vertex[1] == 1;
  CHECK(joining == 2);
  CHECK(verify(*volume, points).ok);
  Random random(2);
  for (int k = 0; k < 200; ++k) {
    const Vector3d n = random.direction();
    CHECK(std::abs(volume->support(n) - static_cast<double>(bruteSupport(points, 0, 1.05, n))) <= 4e-15);
  }
}

TEST_CASE(
    "A flat polygon just above its smallest R: both sides share diagonals over which the ball hardly turns") {
  Random random(41);
  for (int i = 0; i < 1500; ++i) {
    const Cloud points = disc(random.uniform(0.03, 1), 3 + random.below(40));
    const double above = std::pow(10.0, -random.uniform(2, 8));
    CAPTURE(i, points.size(), above);
    StpBv::Ptr volume;
    REQUIRE_NOTHROW(volume = StpBv::build(points, {0.0, StpBv::smallestR(points, 0.0) + above}));
    CHECK(volume->vertexCount() == static_cast<int>(points.size()));
  }
}

TEST_CASE("Points inside and points closer than rounding drop out") {
  Cloud points = box(0.2, 0.4, 0.6);
  Random random(4);
  for (int i = 0; i < 2000; ++i)
    points.push_back({random.uniform(-0.1, 0.1), random.uniform(-0.2, 0.2), random.uniform(-0.3, 0.3)});
  for (int i = 0; i < 8; ++i)
    points.push_back(points[static_cast<std::size_t>(i)] + 1e-17 * random.direction());
  for (int i = 0; i <= 10; ++i)  // a subdivided face whose inner points are off the plane by rounding
    for (int j = 0; j <= 10; ++j)
      points.push_back({-0.1 + 0.02 * i, -0.2 + 0.04 * j, 0.3 + 1e-17 * random.normal()});
  for (const double R : {0.6, 10.0, 1e4})
    CHECK(countsOf(*StpBv::build(points, {0.01, R})) == Counts{8, 12, 6});
}

TEST_CASE("Cospherical points perturbed from rounding to micrometres build volumes that verify") {
  Random random(8);
  for (int power = -17; power <= -6; ++power)
    for (int k = 0; k < 20; ++k) {
      Cloud points = k % 2 == 0 ? box(0.2, 0.4, 0.6) : cylinder(0.1, 0.3, 16);
      for (Vector3d& p : points) p += std::pow(10.0, power) * random.direction();
      for (const double R : {0.5, 10.0, 1e4}) {
        const Verification check = verify(*StpBv::build(points, {0.01, R}), points);
        INFO("perturbed by 1e" << power << ", R = " << R << ": " << check.message);
        CHECK(check.ok);
      }
    }
}

TEST_CASE("The builder says what is wrong with its input and what would work") {
  const Cloud good = box(0.2, 0.4, 0.6);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(StpBv::build({}), Catch::Contains("no points"));
  CHECK_THROWS_WITH(StpBv::build({{0, 0, 0}, {nan, 0, 0}}), Catch::Contains("point 1 is not finite"));
  CHECK_THROWS_WITH(StpBv::build({{0, 0, 0}, {0, -1e300, 0}}), Catch::Contains("point 1 is too far away"));
  CHECK_THROWS_WITH(StpBv::build(good, {-0.01, 10}), Catch::Contains("r = -0.01"));
  CHECK_THROWS_WITH(StpBv::build(good, {nan, 10}), Catch::Contains("small radius"));
  CHECK_THROWS_WITH(StpBv::build(good, {0.5, 0.5}), Catch::Contains("larger than r"));
  CHECK_THROWS_WITH(StpBv::build(good, {0.01, nan}), Catch::Contains("big radius"));
  CHECK_THROWS_WITH(StpBv::build(good, {0.01, 0.3}), Catch::Contains("smallest usable R") &&
                                                         Catch::Contains("0.3841657") &&
                                                         !Catch::Contains("millimetres"));
  const double side = 600;  // a link's side in other units
  CHECK_THROWS_WITH(StpBv::build({{0, 0, 0}, {side, 0, 0}, {0, side, 0}}),
                    Catch::Contains("smallest usable R") && Catch::Contains("424.26") &&
                        Catch::Contains("are they in millimetres?"));
}

TEST_CASE("The R that a refusal states works, however large r is beside the cloud") {
  for (const double r : {0.0, 0.001, 1.0, 1e6})
    for (const double size : {3e-5, 0.0123, 0.7, 12345.0}) {
      const Cloud cloud = box(size, 0.7 * size, 0.2 * size);
      INFO("r = " << r << ", size " << size);
      std::string said;
      try {
        StpBv::build(cloud, {r, r + 0.1 * size});
      } catch (const Error& error) {
        said = error.what();
      }
      const std::string words = " m is ";
      REQUIRE(said.rfind(words) != std::string::npos);
      CHECK_NOTHROW(StpBv::build(cloud, {r, std::stod(said.substr(said.rfind(words) + words.size()))}));
    }
}

TEST_CASE("The R that a refusal names is too small as it is printed, and the one that it states works") {
  const auto after = [](const std::string& text, const std::string& words) {
    REQUIRE(text.rfind(words) != std::string::npos);
    return std::stod(text.substr(text.rfind(words) + words.size()));
  };
  std::vector<Named> clouds = smallClouds();
  clouds.push_back({"cube", box(0.2, 0.2, 0.2)});
  for (const Named& cloud : clouds)
    for (const double r : {0.0, 0.01, 1.0}) {
      if (cloud.points.size() < 2) continue;
      const double smallest = StpBv::smallestR(cloud.points, r);
      for (const double R :
           {smallest, smallest * (1 - 1e-13), smallest * (1 - 1e-10), smallest * (1 - 1e-6)}) {
        std::string said;
        try {
          StpBv::build(cloud.points, {r, R});
        } catch (const Error& error) {
          said = error.what();
        }
        INFO(cloud.name << ", r = " << r << ", R is " << smallest - R << " below the smallest: " << said);
        if (R == smallest && said.empty()) continue;  // r + radius was rounded up
        const double named = after(said, "R = "), stated = after(said, " m is ");
        CHECK(named < stated);
        CHECK(named == Approx(R).epsilon(1e-8));
        CHECK(stated < smallest * (1 + 1e-8));
        CHECK_THROWS_AS(StpBv::build(cloud.points, {r, named}), Error);
        CHECK_NOTHROW(StpBv::build(cloud.points, {r, stated}));
      }
    }
  const Cloud cube = box(0.2, 0.2, 0.2);
  CHECK_THROWS_WITH(StpBv::build(cube, {0, StpBv::smallestR(cube, 0)}),
                    Catch::Contains("R = 0.1732050807568877") && Catch::Contains("is 0.173205081 m"));
}

TEST_CASE("The smallest usable radius is the minimum enclosing ball's and the one stated works") {
  for (const Named& cloud : smallClouds()) {
    if (cloud.points.size() < 2) continue;
    const double smallest = StpBv::smallestR(cloud.points, 0.01);
    INFO(cloud.name);
    CHECK_THROWS_AS(StpBv::build(cloud.points, {0.01, smallest * (1 - 1e-9)}), Error);
    CHECK_NOTHROW(StpBv::build(cloud.points, {0.01, smallest * (1 + 1e-9)}));
  }
}

TEST_CASE("Radii are refused from where faces are flat to rounding, and right just below") {
  for (const Named& cloud : smallClouds()) {
    if (cloud.points.size() < 2) continue;
    const double size = StpBv::smallestR(cloud.points, 0.01), eps = std::numeric_limits<double>::epsilon();
    INFO(cloud.name);
    CHECK_THROWS_WITH(StpBv::build(cloud.points, {0.01, 1.001 * size / eps}), Catch::Contains("too large"));
    CHECK_THROWS_WITH(StpBv::build(cloud.points, {0.01, 1e300}), Catch::Contains("largest usable R"));
    const StpBv::Ptr volume = StpBv::build(cloud.points, {0.01, 0.999 * size / eps});
    Random random(8);
    for (int k = 0; k < 300; ++k) {
      const Vector3d n = random.direction();
      double hull = -std::numeric_limits<double>::infinity();
      for (const Vector3d& p : cloud.points) hull = std::max(hull, n.dot(p));
      // The bulge is smaller than the rounding, which comes from a few sums of two products here.
      CHECK(std::abs(volume->support(n) - hull - 0.01) <= 16 * eps * size);
    }
  }
}

TEST_CASE("Every normal belongs to one region and every walk finds it") {
  for (const Named& cloud : smallClouds()) {
    for (const double R : {StpBv::smallestR(cloud.points, 0.01) * 1.01, 10.0}) {
      const StpBv::Ptr volume = StpBv::build(cloud.points, {0.01, R});
      INFO(cloud.name << " at R = " << R);
      Random random(6);
      for (int k = 0; k < 300; ++k) {
        const Vector3d n = random.direction();
        int owners = 0, owner = -1;
        for (int p = 0; p < volume->patchCount(); ++p)
          if (volume->outside(p, n) <= 0) ++owners, owner = p;
        REQUIRE(owners == 1);  // a random normal lies on a boundary with probability zero
        CHECK(volume->owner(n) == owner);
        CHECK(volume->owner(n, random.below(volume->patchCount())) == owner);
        for (const int none : {volume->patchCount(), std::numeric_limits<int>::max(), -7}) {
          CHECK(volume->owner(n, none) == owner);
          CHECK(volume->support(n, none) == volume->support(n));
          CHECK(volume->surfacePoint(n, none) == volume->surfacePoint(n));
        }
      }
    }
  }
}

TEST_CASE("A volume takes at most 1.1 kB of memory a vertex") {
  for (const int subdivisions : {1, 2, 4}) {
    const StpBv::Ptr volume = StpBv::build(geodesicSphere(0.2, subdivisions));
    CHECK(volume->memory() <= 1126 * static_cast<std::size_t>(volume->vertexCount()));
  }
}

TEST_CASE("A volume assembled from its own parts is the same and damaged parts are refused") {
  const StpBv::Ptr volume = StpBv::build(geodesicSphere(0.2, 1));
  const StpBv::Ptr again = StpBv::assemble(volume->vertices(), volume->faces(), {0.01, 10});
  Random random(1);
  for (int k = 0; k < 100; ++k) {
    const Vector3d n = random.direction();
    CHECK(again->support(n) == volume->support(n));
  }
  std::vector<StpBv::Ring> faces = volume->faces();
  faces.pop_back();
  CHECK_THROWS_WITH(StpBv::assemble(volume->vertices(), faces, {0.01, 10}), Catch::Contains("do not close"));
  faces = volume->faces();
  faces[3][1] = 99;
  CHECK_THROWS_WITH(StpBv::assemble(volume->vertices(), faces, {0.01, 10}), Catch::Contains("face 3"));
  Cloud moved = volume->vertices();
  moved[5] *= 0.5;
  CHECK_THROWS_WITH(StpBv::assemble(moved, volume->faces(), {0.01, 10}),
                    Catch::Contains("outside the ball of face"));
  // Vertices that coincide, or almost, are on each other's balls.
  const StpBv::Ptr cube = StpBv::build(box(0.1, 0.1, 0.1));
  for (const double apart : {0.0, 1e-200, 1e-12, 1e-6})
    for (std::size_t i = 1; i < 8; ++i) {
      CAPTURE(apart, i);
      moved = cube->vertices();
      moved[i] = moved[0] + Vector3d(0, 0, apart);
      CHECK_THROWS_AS(StpBv::assemble(moved, cube->faces(), {0.01, 10}), Error);
    }
}

TEST_CASE("Near-duplicates however close build a volume that verifies") {
  Random random(11);
  for (int exponent = -17; exponent <= -9; ++exponent)
    for (const double R : {0.4, 10.0, 1e4}) {
      Cloud cloud = box(0.3, 0.2, 0.25);
      for (int i = 0; i < 24; ++i)
        cloud.push_back(cloud[static_cast<std::size_t>(i % 8)] +
                        std::pow(10.0, exponent) * random.direction());
      CAPTURE(exponent, R);
      const StpBv::Ptr volume = StpBv::build(cloud, {0.01, R});
      const Verification check = verify(*volume, cloud);
      CHECK(check.message == "ok");
    }
}

TEST_CASE("A near-duplicate on the ball that the smallest R leaves does not join opposite faces") {
  for (const double apart : {1e-14, 1e-12, 1e-10}) {
    const Cloud cloud{
        {-0.27, -0.17, 0.78}, {-0.52, 0.12, -1.07}, {0.89, 0.11, 0.03}, {-0.27 + apart, -0.17, 0.78}};
    for (const double beyond : {1e-9, 1e-7, 1e-4}) {
      CAPTURE(apart, beyond);
      const StpBv::Ptr volume = StpBv::build(cloud, {0.0, StpBv::smallestR(cloud, 0.0) * (1 + beyond)});
      CHECK(verify(*volume, cloud).message == "ok");
    }
  }
}

TEST_CASE("Points that rounding has moved off a box's sides build a volume that verifies, for any R") {
  for (const int cells : {2, 3, 4})
    for (int k = 0; k < 60; ++k) {
      Random random(7 * k + cells);
      const auto one = [&] { return random.uniform(0.1, 1); };
      const Vector3d size = 15e-6 * Vector3d(one(), one(), one()),
                     away = random.uniform(-1, 1) * Vector3d::Ones();
      const Eigen::Matrix3d turned = k % 2 ? random.rotation() : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
      Cloud cloud;
      for (int x = 0; x <= cells; ++x)
        for (int y = 0; y <= cells; ++y)
          for (int z = 0; z <= cells; ++z)
            if (x % cells == 0 || y % cells == 0 || z % cells == 0)
              cloud.push_back(turned * (size.cwiseProduct(Vector3d(x, y, z)) / cells + away));
      INFO(cells << " cells, " << k);
      for (const double R : {1e3, 1e6, 9e7})
        CHECK(verify(*StpBv::build(cloud, {0.01, R}), cloud).message == "ok");
    }
}

TEST_CASE("A ball that rolls over an edge between near-duplicates does not roll past the other points") {
  // The fourth and fifth point are 4.6e-15 m apart, a few units in their last place. The ball that rests on
  // both and on the third point rolls by 4.1 rad over their edge, and meets the first point on its way.
  const Cloud points{{-0x1.82fd693293821p-3, 0x1.b9f36bf5a56cbp-4, -0x1.e40d9efe3526ep-3},
                     {0x1.4ea898180702cp-3, -0x1.06046452da5bap-4, 0x1.9d8f4416a4376p-3},
                     {0x1.83f9a1a804cb7p-4, -0x1.5ec654ea23624p-2, -0x1.be20325ded32p-8},
                     {-0x1.997d571f4752ap-4, 0x1.608668b3aef1bp-2, -0x1.79b1d88f9bc88p-5},
                     {-0x1.997d571f47669p-4, 0x1.608668b3aef1cp-2, -0x1.79b1d88f9bd28p-5}};
  const StpBv::Ptr volume = StpBv::build(points, {0.01, 0.38959506646365211});
  const Verification found = verify(*volume, points);
  INFO(found.message);
  CHECK(found.ok);
}

TEST_CASE("Two pairs of near-duplicates as far apart as the ball allows build a volume that verifies") {
  // R and points of clouds that rolling alone refuses, from the random clouds of test/fuzz/clouds.cpp.
  const std::vector<std::pair<double, Cloud>> cases = {
      {0x1.03800052a3d16p-8,
       {{-0x1.6ed106376c606p-15, 0x1.6a86b32bb6effp-8, -0x1.c7dd1f42d04acp-11},
        {0x1.6c10fa219953p-8, -0x1.16b239d2ab901p-14, -0x1.701bd5f668c5fp-11},
        {-0x1.6ed10637712cp-15, 0x1.6a86b32bb6e42p-8, -0x1.c7dd1f42d2a0ep-11},
        {0x1.6c10fa200d656p-8, -0x1.16b23a4cbc842p-14, -0x1.701bd656dc3eap-11}}},
      {0x1.2e77e7da340c7p-7,
       {{0x1.73a9e93a6cf88p-7, 0x1.5770b464a043ep-8, 0x1.b5a9bceeae3b4p-9},
        {0x1.57109c478bccep-8, -0x1.82c1060a9b161p-7, 0x1.85215190ded81p-11},
        {0x1.73a9e93a6cfbp-7, 0x1.5770b464a044fp-8, 0x1.b5a9bceeae162p-9},
        {0x1.57109c478802ep-8, -0x1.82c1060a9b7b9p-7, 0x1.852151914fc4p-11}}},
      {0x1.6a8e7e4aa486p-8,
       {{0x1.6b2fb11a1b066p-9, 0x1.9d45e3e09e288p-5, -0x1.9b810e3fdd184p-10},
        {-0x1.41e17c1704e24p-8, 0x1.dc350e7520753p-5, -0x1.9b810e3fbcf13p-10},
        {-0x1.41e17c1704e24p-8, 0x1.dc350e7520753p-5, -0x1.9b810e3fdd1dap-10},
        {0x1.6b2fb11a1b066p-9, 0x1.9d45e3e09e288p-5, -0x1.9b810e4022cc1p-10}}},
      {0x1.dbb1a62e28c03p+24,
       {{0x1.a420d5cde05b1p+4, 0x1.9c468728eb26p-18, -0x1.054d0f787e034p-18},
        {-0x1.ba3887684ab3fp+4, 0x1.43292d3980169p-49, 0x1.de9e7a30d5382p-48},
        {0x1.a420d5cde05cbp+4, 0x1.9c46881137028p-18, -0x1.054d0f9442569p-18},
        {0x1.4e3dfd944475bp+4, 0x1.800b66b236461p-48, -0x1.5943e9eea3f95p-45}}},
  };
  for (const auto& [R, points] : cases) {
    CAPTURE(R);
    const StpBv::Ptr volume = StpBv::build(points, {0, R});
    const Verification check = verify(*volume, points);
    CHECK(check.message == "ok");
  }
}

TEST_CASE("two vertices that coincide are no spindle") {
  CHECK_THROWS_WITH(StpBv::assemble({{1, 2, 3}, {1, 2, 3}}, {}, {0.1, 1}), Catch::Contains("coincide"));
  CHECK(StpBv::assemble({{1, 2, 3}, {1, 2, 3.001}}, {}, {0.1, 1})->edgeCount() == 1);
}

TEST_CASE("An R just above the smallest one gives a volume, or an error that names an R which works") {
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Cloud points = randomHull(2 + static_cast<int>(seed % 8), {1, 1, 1}, seed);
    const double R = std::nextafter((1 + 1e-15) * StpBv::smallestR(points, 0.3), 1e9);
    try {
      const StpBv::Ptr volume = StpBv::build(points, {0.3, R});
      CHECK(volume->vertexCount() > 1);
    } catch (const Error& error) {
      const std::string message = error.what(), before = "use at least ";
      CAPTURE(message);
      REQUIRE(message.find(before) != std::string::npos);
      CHECK_NOTHROW(
          StpBv::build(points, {0.3, std::stod(message.substr(message.find(before) + before.size()))}));
      ++refused;
    }
  }
  CHECK(refused > 0);
}
