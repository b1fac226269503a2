// fcl_stpbv::distance instead of FCL's. Tests distances against the known ones of sharp polyhedra, gradients
// against central differences, and swapped and mirrored pairs against each other. Also tests the contents of
// FCL's result, and the answers for pairs without an STP-BV and for invalid poses.
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>
#include <fcl/narrowphase/distance.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/volume/measure.h"
#include "test/adapter/mirrored_pairs.h"
#include "test/reference/fcl_bodies.h"
#include "test/reference/hard_cases.h"
#include "test/reference/shapes.h"
#include "test/reference/source_folder.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// A result as a penetrating FCL query on other objects leaves it.
fcl::DistanceResultd dirtyResult() {
  fcl::DistanceResultd result;
  result.min_distance = -1;
  result.nearest_points[0] = result.nearest_points[1] = Vector3d::Constant(std::nan(""));
  result.b1 = 7;
  result.b2 = 9;
  return result;
}

}  // namespace

TEST_CASE("sharp polyhedra's known distances come out within the over-cover, with a closed certificate") {
  std::vector<HardCase> cases = equalNormCases();
  for (const HardCase& c : fieldCases(test::sourceFolder() + "/data/hard_cases/fcl_field_cases.txt"))
    cases.push_back(c);
  for (const HardCase& c : cases)
    for (const StpBvOptions options : {StpBvOptions{0.0, 1000.0}, StpBvOptions{1e-3, 200.0}}) {
      CAPTURE(c.name, options.r);
      const auto a = geometryOf(c.first, options.r, options.R),
                 b = geometryOf(c.second, options.r, options.R);
      const DistanceAnswer d = distance(*a, c.pose1, *b, c.pose2);
      const double excess = overCover(a->volume()).max + overCover(b->volume()).max;
      CHECK(d.continuous);
      CHECK(d.lower <= d.distance);
      CHECK(d.distance <= d.upper);
      CHECK(d.distance <= c.distance + c.tolerance);
      CHECK(d.distance >= c.distance - excess - c.tolerance);
      if (d.status == DistanceStatus::exact) CHECK(d.upper - d.lower <= 1e-12);
      CHECK((d.status == DistanceStatus::exact || d.distance < -2 * options.r));
    }
}

TEST_CASE("a body and its mirror image in mirrored poses get an exact answer, mirrored too") {
  MirroredPairs pairs(2);
  const Matrix3d across = Vector3d(1, -1, 1).asDiagonal();
  for (int i = 0; i < 30000; ++i) {
    if (i % 1000 == 0) pairs.nextShape();
    pairs.nextPose();
    const DistanceAnswer d = distance(pairs.geometry(), pairs.pose(), pairs.mirror(), pairs.mirrorPose());
    if (d.status == DistanceStatus::local) continue;
    REQUIRE(d.status == DistanceStatus::exact);
    REQUIRE(d.upper - d.lower <= 1e-13);
    REQUIRE((across * d.normal + d.normal).norm() <= 1e-7);
    REQUIRE((across * d.points[0] - d.points[1]).norm() <= 1e-6);
  }
}

TEST_CASE("swapping the objects swaps the answer") {
  Random random(3);
  const auto a = geometryOf(box(0.2, 0.3, 0.4)), b = geometryOf(cylinder(0.1, 0.4));
  for (int i = 0; i < 500; ++i) {
    const Isometry3d poseA = pose(random.rotation(), random.direction());
    const Isometry3d poseB =
        pose(random.rotation(), poseA.translation() + random.uniform(0.5, 1.5) * random.direction());
    const DistanceAnswer d = distance(*a, poseA, *b, poseB), e = distance(*b, poseB, *a, poseA);
    REQUIRE(std::abs(d.distance - e.distance) <= 1e-14);
    REQUIRE((d.normal + e.normal).norm() <= 1e-12);
    REQUIRE((d.gradient[0] - e.gradient[1]).norm() <= 1e-11);
  }
}

TEST_CASE("the gradient is the derivative of the distance") {
  Random random(5);
  const auto a = geometryOf(box(0.2, 0.3, 0.4)), b = geometryOf(geodesicSphere(0.2, 2));
  const double step = 1e-5;
  for (int i = 0; i < 100; ++i) {
    const Isometry3d poseA = pose(random.rotation(), random.direction());
    const Isometry3d poseB =
        pose(random.rotation(), poseA.translation() + random.uniform(0.6, 1.5) * random.direction());
    const DistanceAnswer d = distance(*a, poseA, *b, poseB);
    Eigen::Matrix<double, 6, 1> twist;
    twist << random.direction(), random.direction();
    const auto moved = [&](const Isometry3d& p, double s) {
      const Vector3d turn = s * twist.tail<3>();
      return pose(Eigen::AngleAxisd(turn.norm(), turn.normalized()) * p.linear(),
                  p.translation() + s * twist.head<3>());
    };
    const double byA = (distance(*a, moved(poseA, step), *b, poseB).distance -
                        distance(*a, moved(poseA, -step), *b, poseB).distance) /
                       (2 * step);
    const double byB = (distance(*a, poseA, *b, moved(poseB, step)).distance -
                        distance(*a, poseA, *b, moved(poseB, -step)).distance) /
                       (2 * step);
    REQUIRE(byA == Approx(d.gradient[0].dot(twist)).margin(1e-6));
    REQUIRE(byB == Approx(d.gradient[1].dot(twist)).margin(1e-6));
  }
}

TEST_CASE("the answer continues smoothly from separated to penetrating") {
  const auto a = geometryOf(box(0.2, 0.2, 0.2), 0.01), b = geometryOf(geodesicSphere(0.1, 2), 0.01);
  double last = distance(*a, at(0, 0, 0), *b, at(0.215, 0.02, 0.01)).distance;
  for (double x = 0.2149; x > 0.205; x -= 1e-4) {
    const DistanceAnswer d = distance(*a, at(0, 0, 0), *b, at(x, 0.02, 0.01));
    REQUIRE(d.status == DistanceStatus::exact);
    REQUIRE(last - d.distance == Approx(1e-4).epsilon(0.01));
    last = d.distance;
  }
  CHECK(last < -0.005);
}

TEST_CASE("the FCL result is filled afresh, whatever it held before") {
  const auto cube = geometryOf(box(0.2, 0.2, 0.2));
  const fcl::CollisionObjectd a(cube), b(cube, at(0.5, 0, 0)), c(cube, at(1, 0, 0));
  for (const bool points : {false, true}) {
    fcl::DistanceRequestd request(points);
    fcl::DistanceResultd result = dirtyResult();
    const double d = fcl_stpbv::distance(&a, &b, request, result);
    CHECK(d == result.min_distance);
    CHECK(d < 0.28);  // faces bulge by up to 2.2 mm over the sharp cubes' 0.3 m minus two margins
    CHECK(d > 0.276);
    CHECK(result.o1 == a.collisionGeometry().get());
    CHECK(result.o2 == b.collisionGeometry().get());
    CHECK(result.b1 == -1);  // FCL's NONE, which FCL declares but never defines
    CHECK(result.b2 == -1);
    CHECK((result.nearest_points[1] - result.nearest_points[0]).norm() == Approx(d).margin(1e-14));

    // A farther pair after a nearer one: FCL would keep the nearer one.
    CHECK(fcl_stpbv::distance(&a, &c, request, result) == result.min_distance);
    CHECK(result.min_distance > d + 0.4);

    // The overload for geometries gives the same.
    fcl::DistanceResultd again = dirtyResult();
    fcl_stpbv::distance(a.collisionGeometry().get(), a.getTransform(), c.collisionGeometry().get(),
                        c.getTransform(), request, again);
    CHECK(again.min_distance == result.min_distance);
    CHECK(again.nearest_points[0] == result.nearest_points[0]);
  }
}

TEST_CASE("penetration of two STP-BVs is a signed distance, whether asked for or not") {
  const auto cube = geometryOf(box(0.2, 0.2, 0.2), 0.01);
  const fcl::CollisionObjectd a(cube), b(cube, at(0.21, 0, 0));
  for (const bool isSigned : {false, true}) {
    fcl::DistanceRequestd request(true, isSigned);
    fcl::DistanceResultd result;
    const double d = fcl_stpbv::distance(&a, &b, request, result);
    CHECK(d < -0.01);
    CHECK(d > -0.015);
  }
}

TEST_CASE("a pair without an STP-BV gets an answer marked as not continuous") {
  const auto ball = std::make_shared<fcl::Sphered>(0.1);
  const auto crate = std::make_shared<fcl::Boxd>(0.2, 0.2, 0.2);
  SECTION("apart") {
    const DistanceAnswer d = distance(*crate, at(0, 0, 0), *ball, at(0.5, 0, 0));
    CHECK_FALSE(d.continuous);
    CHECK(d.status == DistanceStatus::exact);
    CHECK(std::abs(d.distance - 0.3) <= 1e-15);
    CHECK(d.lower <= d.distance);
    CHECK(d.distance <= d.upper);
    CHECK((d.normal - Vector3d::UnitX()).norm() <= 1e-15);
    CHECK(d.patch == std::array{-1, -1});
  }
  SECTION("overlapping: signed here and in FCL's result") {
    const DistanceAnswer d = distance(*crate, at(0, 0, 0), *crate, at(0.1, 0.02, 0.01));
    CHECK(d.status == DistanceStatus::exact);
    CHECK(d.distance == Approx(-0.1).margin(1e-15));
    CHECK((d.normal - Vector3d::UnitX()).norm() <= 1e-15);
    fcl::DistanceRequestd request(true, true);  // signed; FCL itself may abort here
    fcl::DistanceResultd result = dirtyResult();
    CHECK(fcl_stpbv::distance(crate.get(), at(0, 0, 0), crate.get(), at(0.1, 0.02, 0.01), request, result) ==
          d.distance);
    CHECK(result.nearest_points[0] == d.points[0]);
  }
  SECTION("signed requests of stacked crates are answered") {
    Random random(9);
    fcl::DistanceRequestd request(true, true);
    for (int i = 0; i < 500; ++i) {
      fcl::DistanceResultd result;
      const Isometry3d above =
          pose(Eigen::AngleAxisd(random.uniform(0, 3), Vector3d::UnitZ()).toRotationMatrix(),
               {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.2 - random.uniform(0, 1e-3)});
      REQUIRE(
          std::isfinite(fcl_stpbv::distance(crate.get(), at(0, 0, 0), crate.get(), above, request, result)));
    }
  }
  SECTION("two unbounded shapes, and meshes that are empty, have no answer") {
    const std::vector<std::shared_ptr<fcl::CollisionGeometryd>> others{
        std::make_shared<fcl::Planed>(Vector3d(0, 0, 1), 0.0),
        std::make_shared<fcl::Halfspaced>(Vector3d(0, 0, 1), 0.0),
        std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>(), std::make_shared<fcl::BVHModel<fcl::AABBd>>()};
    for (const auto& first : others)
      for (const fcl::CollisionGeometryd* second :
           {first.get(), static_cast<fcl::CollisionGeometryd*>(ball.get())}) {
        Shape plane;  // against a bounded shape a plane has a closed form
        if (second == ball.get() && shapeOf(*first, plane)) continue;
        CHECK(distance(*first, at(0, 0, 0), *second, at(0, 0, 1)).status == DistanceStatus::invalid);
        CHECK(distance(*second, at(0, 0, 0), *first, at(0, 0, 1)).status == DistanceStatus::invalid);
      }
  }
  SECTION("a mesh on either side keeps its point on its side") {
    const auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    mesh->beginModel();
    mesh->addTriangle({0, -1, -1}, {0, 1, -1}, {0, 0, 1});
    mesh->endModel();
    const DistanceAnswer d = distance(*mesh, at(0, 0, 0), *crate, at(0.5, 0, 0));
    const DistanceAnswer e = distance(*crate, at(0.5, 0, 0), *mesh, at(0, 0, 0));
    CHECK(std::abs(d.distance - 0.4) <= 1e-15);
    CHECK(std::abs(e.distance - 0.4) <= 1e-15);
    CHECK((d.normal - Vector3d::UnitX()).norm() <= 1e-15);
    CHECK((e.normal + Vector3d::UnitX()).norm() <= 1e-15);
    CHECK(d.geometry[0] == mesh.get());
    CHECK(e.geometry[1] == mesh.get());

    // The points are in the world's frame, also for balls.
    const DistanceAnswer f = distance(*mesh, at(3, 0, 0), *ball, at(3.5, 0, 0));
    CHECK(std::abs(f.distance - 0.4) <= 1e-15);
    CHECK((f.normal - Vector3d::UnitX()).norm() <= 1e-15);
    CHECK((f.points[0] - Vector3d(3, 0, 0)).norm() <= 1e-15);
  }
}

TEST_CASE("poses that are not finite give status invalid, never NaN and never an exception") {
  const auto cube = geometryOf(box(0.2, 0.2, 0.2));
  const auto ball = std::make_shared<fcl::Sphered>(0.1);
  fcl::DistanceRequestd request;
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL})
    for (int entry = 0; entry < 12; ++entry)
      for (const fcl::CollisionGeometryd* other : {static_cast<fcl::CollisionGeometryd*>(cube.get()),
                                                   static_cast<fcl::CollisionGeometryd*>(ball.get())}) {
        Isometry3d broken = at(0, 0, 0);
        broken.matrix()(entry % 3, entry / 3) = bad;
        DistanceAnswer d;
        REQUIRE_NOTHROW(d = distance(*cube, broken, *other, at(1, 0, 0)));
        CHECK(d.status == DistanceStatus::invalid);
        CHECK(d.normal == Vector3d(0, 0, 0));
        CHECK(d.lower < d.upper);
        fcl::DistanceResultd result = dirtyResult();
        CHECK(fcl_stpbv::distance(other, at(1, 0, 0), cube.get(), broken, request, result) == -1);
        CHECK(result.nearest_points[0] == Vector3d(0, 0, 0));
      }
}

TEST_CASE("a pair asked again and again agrees with single queries and asks FCL once") {
  Random random(21);
  const auto a = geometryOf(box(0.2, 0.3, 0.4)), b = geometryOf(geodesicSphere(0.2, 2));
  MappingCounts counts;
  PairDistance pair(a, b, &counts), uncounted(a, b);
  Matrix3d turn = random.rotation();
  for (int i = 0; i < 500; ++i) {
    turn = random.rotation(0.02) * turn;
    const Isometry3d poseB = pose(turn, {0.6 + 0.2 * std::sin(0.01 * i), 0.1, 0});
    const DistanceAnswer d = pair(at(0, 0, 0), poseB), e = distance(*a, at(0, 0, 0), *b, poseB);
    REQUIRE(std::abs(d.distance - e.distance) <= 1e-14);
    REQUIRE((d.normal - e.normal).norm() <= 1e-12);
    REQUIRE(std::abs(uncounted(at(0, 0, 0), poseB).distance - e.distance) <= 1e-14);
  }
  CHECK(counts.total() == 1);
  pair.forget();
  pair(at(0, 0, 0), at(1, 0, 0));
  CHECK(counts.total() == 2);
}

TEST_CASE("the answer is the same from the line of centres and from FCL's witness, for both callers") {
  Random random(22);
  QueryContext fromWitness;
  fromWitness.start = StartFrom::fclWitness;
  for (const Cloud& cloud :
       {box(0.2, 0.3, 0.4), geodesicSphere(0.2, 2), plate(0.3, 0.2), cylinder(0.1, 0.4)}) {
    const auto a = geometryOf(cloud), b = geometryOf(box(0.1, 0.2, 0.5));
    for (int i = 0; i < 400; ++i) {
      const Isometry3d poseA = pose(random.rotation(), {0, 0, 0}),
                       poseB = pose(random.rotation(), random.uniform(0.02, 1.2) * random.direction());
      const DistanceAnswer d = distance(*a, poseA, *b, poseB),
                           e = distance(*a, poseA, *b, poseB, fromWitness);
      // Each is within the other's bounds. For separated bodies the bounds are only rounding apart.
      CHECK(d.lower <= e.upper);
      CHECK(e.lower <= d.upper);
      if (d.distance > 0) CHECK(std::abs(d.distance - e.distance) <= 1e-14);
      DistanceData fromCentres, asThePaper;
      asThePaper.start = StartFrom::fclWitness;
      fcl::CollisionObjectd one(a, poseA), two(b, poseB);
      double ignored = 0;
      distanceCallback(&one, &two, &fromCentres, ignored);
      distanceCallback(&one, &two, &asThePaper, ignored);
      CHECK(fromCentres.result.distance == d.distance);
      CHECK(asThePaper.result.distance == e.distance);
    }
  }
}

TEST_CASE("degenerate volumes are bodies like any other") {
  const std::vector<Cloud> clouds{
      {{0, 0, 0}}, {{-0.1, 0, 0}, {0.1, 0, 0}}, {{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0, 0.1, 0}}};
  for (const Cloud& cloudA : clouds)
    for (const Cloud& cloudB : clouds) {
      const auto a = geometryOf(cloudA), b = geometryOf(cloudB);
      const DistanceAnswer d = distance(*a, at(0, 0, 0), *b, at(0, 0.02, 0.5));
      CHECK(d.status == DistanceStatus::exact);
      // Rounded outward, for a sum of coordinates of 1 m.
      CHECK(d.upper - d.lower <= 1e-14 + 3 * kGapRounding);
      CHECK(d.distance < 0.4805);
      CHECK(d.distance > 0.47);
    }
}
