// The closest features of two hulls, by FCL's GJK with a stopping criterion that proves convergence. Its
// bounds hold for known distances of pairs that FCL gets wrong, and for planes that are checked with all
// vertices. Its features are right in poses where they are obvious.
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "test/adapter/mirrored_pairs.h"
#include "test/reference/hard_cases.h"
#include "test/reference/shapes.h"
#include "test/reference/source_folder.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using Verdict = PolyhedralWitness::Verdict;

namespace {

/// Gap between the supporting planes along `n`, over all vertices and in the world frame. This check shares
/// no code with the tested code.
double planeGap(const Cloud& a, const Isometry3d& poseA, const Cloud& b, const Isometry3d& poseB,
                const Vector3d& n) {
  double highA = -1e300, lowB = 1e300;
  for (const Vector3d& p : a) highA = std::max(highA, n.dot(poseA * p));
  for (const Vector3d& p : b) lowB = std::min(lowB, n.dot(poseB * p));
  return lowB - highA;
}

double sameDigits(double metres) { return 1e-14 * (1 + metres); }

}  // namespace

TEST_CASE("the polyhedral witness is right where FCL stops on equal norms") {
  for (const HardCase& c : equalNormCases()) {
    CAPTURE(c.name);
    const PolyhedralWitness w = polyhedralWitness(HullGraph(c.first), c.pose1, HullGraph(c.second), c.pose2);
    CHECK(std::abs(w.upper - c.distance) <= c.tolerance);
    CHECK(w.upper - w.lower <= 1e-12);
    CHECK(w.verdict != Verdict::failed);
    if (c.distance > 0) CHECK(w.verdict == Verdict::separated);
  }
}

TEST_CASE("the polyhedral witness calls the field cases overlapping or touching") {
  const std::vector<HardCase> cases =
      fieldCases(test::sourceFolder() + "/data/hard_cases/fcl_field_cases.txt");
  REQUIRE(cases.size() == 8);
  for (const HardCase& c : cases) {
    CAPTURE(c.name);
    const PolyhedralWitness w = polyhedralWitness(HullGraph(c.first), c.pose1, HullGraph(c.second), c.pose2);
    CHECK(w.lower <= 1e-6);
    if (c.distance < -1e-6) CHECK(w.verdict == Verdict::overlapping);
  }
}

TEST_CASE("a hull and its mirror image in mirrored poses always get a closed gap") {
  MirroredPairs pairs(1);
  for (int i = 0; i < 30000; ++i) {
    if (i % 1000 == 0) pairs.nextShape();
    pairs.nextPose();
    const PolyhedralWitness w =
        polyhedralWitness(pairs.hull(), pairs.pose(), pairs.mirrorHull(), pairs.mirrorPose());
    if (w.verdict == Verdict::overlapping) continue;
    REQUIRE(w.verdict == Verdict::separated);
    REQUIRE(w.upper - w.lower <= 1e-13);
  }
}

TEST_CASE("both bounds of the polyhedral witness hold when checked against every vertex") {
  Random random(7);
  const std::vector<Cloud> shapes{
      box(0.2, 0.3, 0.4), plate(0.3, 0.2),          needle(0.5),
      cylinder(0.1, 0.4), geodesicSphere(0.2, 3),   randomHull(300, {0.3, 0.2, 0.1}, 5),
      {{0.1, 0.2, 0.3}},  {{0, 0, 0}, {0.3, 0, 0}}, {{0, 0, 0}, {0.2, 0, 0}, {0, 0.3, 0}}};
  for (const Cloud& a : shapes)
    for (const Cloud& b : shapes) {
      const HullGraph hullA(a), hullB(b);
      for (int i = 0; i < 40; ++i) {
        const Isometry3d poseA = pose(random.rotation(), random.direction());
        const Isometry3d poseB =
            pose(random.rotation(), poseA.translation() + random.uniform(0.1, 0.9) * random.direction());
        const PolyhedralWitness w = polyhedralWitness(hullA, poseA, hullB, poseB);
        REQUIRE(w.verdict != Verdict::failed);
        if (w.verdict == Verdict::overlapping) continue;
        REQUIRE(w.upper - w.lower <= 1e-13);
        REQUIRE(std::abs(w.direction.norm() - 1) <= 1e-14);
        REQUIRE(std::abs(planeGap(a, poseA, b, poseB, w.direction) - w.lower) <= 1e-13);
        REQUIRE(std::abs((w.point[1] - w.point[0]).norm() - w.upper) <= 1e-13);
      }
    }
}

TEST_CASE("the witness features are the vertex, edge or face that the points lie on") {
  const HullGraph cube(box(0.2, 0.2, 0.2));
  const Isometry3d here = Isometry3d::Identity();
  const double quarter = std::acos(-1.0) / 4;
  const auto kinds = [](const PolyhedralWitness& w) {
    return std::array{w.feature[0].kind, w.feature[1].kind};
  };
  const auto turned = [](double angle, const Vector3d& axis) {
    return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  };

  SECTION("parallel faces: any feature of theirs") {
    const PolyhedralWitness w =
        polyhedralWitness(cube, here, cube, pose(turned(0.3, Vector3d::UnitX()), {0.5, 0, 0}));
    CHECK((w.direction - Vector3d::UnitX()).norm() <= 1e-14);
    CHECK(w.upper == Approx(0.3).margin(1e-15));
    for (const int v : w.vertices[0])
      if (v >= 0) CHECK(cube.point(v)[0] == Approx(0.1));
  }
  SECTION("face to vertex") {
    const double tilt = std::atan(std::sqrt(0.5));
    const PolyhedralWitness w = polyhedralWitness(
        cube, here, cube,
        pose(turned(tilt, Vector3d::UnitY()) * turned(quarter, Vector3d::UnitZ()), {0.5, 0.01, 0.02}));
    CHECK(kinds(w) == std::array{PatchKind::face, PatchKind::vertex});
    CHECK(w.upper == Approx(0.4 - 0.1 * std::sqrt(3.0)).margin(1e-14));
  }
  SECTION("edge to edge") {
    const PolyhedralWitness w =
        polyhedralWitness(cube, pose(turned(quarter, Vector3d::UnitZ()), {0, 0, 0}), cube,
                          pose(turned(quarter, Vector3d::UnitY()), {0.5, 0.01, 0.02}));
    CHECK(kinds(w) == std::array{PatchKind::edge, PatchKind::edge});
    CHECK(w.upper == Approx(0.5 - 0.2 * std::sqrt(2.0)).margin(1e-14));
  }
  SECTION("vertex to vertex") {
    const double tilt = std::atan(std::sqrt(0.5));
    const Eigen::Matrix3d corner = turned(tilt, Vector3d::UnitY()) * turned(quarter, Vector3d::UnitZ());
    const PolyhedralWitness w =
        polyhedralWitness(cube, pose(corner, {0, 0, 0}), cube, pose(corner, {0.5, 0.002, 0.001}));
    CHECK(kinds(w) == std::array{PatchKind::vertex, PatchKind::vertex});
  }
}

TEST_CASE("the polyhedral witness does not depend on scale, place or start") {
  Random random(11);
  const Cloud cloud = randomHull(100, {0.3, 0.2, 0.1}, 3);
  for (const double scale : {1e-6, 1e-3, 1.0, 1e4}) {
    Cloud scaled = cloud;
    for (Vector3d& p : scaled) p *= scale;
    const HullGraph hull(scaled);
    for (int i = 0; i < 200; ++i) {
      const Isometry3d poseA = pose(random.rotation(), Vector3d::Zero());
      const Isometry3d poseB =
          pose(random.rotation(), random.uniform(0.75, 2.0) * scale * random.direction());
      const PolyhedralWitness w = polyhedralWitness(hull, poseA, hull, poseB);
      REQUIRE(w.verdict == Verdict::separated);
      REQUIRE(w.upper - w.lower <= 1e-13 * scale);
      const PolyhedralWitness again = polyhedralWitness(hull, poseA, hull, poseB, w.start());
      REQUIRE(std::abs(again.upper - w.upper) <= 1e-14 * scale);
      WitnessStart odd{random.direction(),
                       {random.below(hull.vertexCount()), random.below(hull.vertexCount())}};
      REQUIRE(std::abs(polyhedralWitness(hull, poseA, hull, poseB, odd).upper - w.upper) <= 1e-13 * scale);
    }
  }
}

TEST_CASE("a witness that stops early keeps its bounds, for less work") {
  Random random(12);
  const HullGraph hull(randomHull(100, {0.3, 0.2, 0.1}, 3));
  constexpr double kRounding = 1e-15;  // for points less than a metre away
  long supports = 0, exactSupports = 0;
  for (int i = 0; i < 500; ++i) {
    const Isometry3d poseA = pose(random.rotation(), Vector3d::Zero());
    const Isometry3d poseB = pose(random.rotation(), random.uniform(0.75, 1.0) * random.direction());
    const PolyhedralWitness exact = polyhedralWitness(hull, poseA, hull, poseB);
    REQUIRE(exact.verdict == Verdict::separated);
    exactSupports += exact.supports;
    for (const double gap : {0.01, 0.9}) {
      const PolyhedralWitness w = polyhedralWitness(hull, poseA, hull, poseB, {}, gap);
      REQUIRE(w.verdict == Verdict::separated);
      REQUIRE(w.upper - w.lower <= gap * w.upper + kRounding);
      REQUIRE(w.lower <= exact.upper + kRounding);
      REQUIRE(w.upper >= exact.lower - kRounding);
      REQUIRE(std::abs((w.point[1] - w.point[0]).norm() - w.upper) <= kRounding);
      supports += w.supports;
    }
  }
  CHECK(supports < 2 * exactSupports);
}

TEST_CASE("touching and nearly touching hulls keep both bounds") {
  Random random(13);
  const HullGraph cube(box(0.2, 0.2, 0.2));
  for (const double gap : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 0.0}) {
    const PolyhedralWitness w = polyhedralWitness(cube, Isometry3d::Identity(), cube,
                                                  pose(random.rotation(0.0), {0.2 + gap, 0.05, 0.03}));
    CAPTURE(gap);
    CHECK(w.verdict != Verdict::failed);
    CHECK(w.lower <= gap + 1e-16);
    CHECK(std::abs(w.upper - gap) <= sameDigits(0.2));
  }
}

TEST_CASE("a witness of poses that are not finite fails quietly") {
  const HullGraph cube(box(0.2, 0.2, 0.2)), sphere(geodesicSphere(0.2, 3));
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, 1e308}) {
    for (int entry = 0; entry < 12; ++entry) {
      Isometry3d broken = Isometry3d::Identity();
      broken.matrix()(entry % 3, entry / 3) = bad;
      for (const PolyhedralWitness& w : {polyhedralWitness(cube, broken, sphere, Isometry3d::Identity()),
                                         polyhedralWitness(sphere, Isometry3d::Identity(), cube, broken)}) {
        // 1e308 is finite: any verdict is accepted, if the call returns.
        if (std::abs(bad) < HUGE_VAL) continue;
        CHECK(w.verdict == Verdict::failed);
        CHECK(w.supports == 0);  // values that are not finite do not reach FCL
        CHECK(w.direction == Vector3d(0, 0, 0));
      }
    }
  }
}
