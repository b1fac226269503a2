// An STP-BV against each simple shape: derivatives, continuity, planes, penetration, robustness. The parity
// with the reference on random poses is shape_soak.
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/distance/shape_distance.h"
#include "test/distance/shape_reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

std::vector<std::string> allShapes() {
  std::vector<std::string> names = boundedShapes();
  names.insert(names.end(), {"halfspace", "plane"});
  return names;
}

/// Moves a pose by a twist [linear; angular] about its origin.
Isometry3d moved(const Isometry3d& at, const Eigen::Matrix<double, 6, 1>& twist) {
  Isometry3d to = at;
  const double angle = twist.tail<3>().norm();
  if (angle > 0)
    to.linear() =
        Eigen::AngleAxisd(angle, Vector3d(twist.tail<3>() / angle)).toRotationMatrix() * at.linear();
  to.translation() += twist.head<3>();
  return to;
}

}  // namespace

TEST_CASE("the gradient to both poses is the central difference of the distance, for every shape") {
  const auto volume = StpBv::build(randomHull(20, {0.2, 0.15, 0.1}, 3), {0.01, 2});
  Random random(5);
  for (const std::string& name : allShapes())
    for (int i = 0; i < 20; ++i) {
      CAPTURE(name, i);
      const TestShape shape = randomShape(name, random);
      const Isometry3d a = pose(random.rotation(), random.direction());
      const Isometry3d b = pose(random.rotation(), a.translation() + 1.4 * random.direction());
      const Distance d = distance(*volume, a, shape.shape, b);
      if (d.status != DistanceStatus::exact || d.distance < 0) continue;
      constexpr double kStep = 1e-5;
      for (int k = 0; k < 6; ++k) {
        const Eigen::Matrix<double, 6, 1> e = kStep * Eigen::Matrix<double, 6, 1>::Unit(k);
        const double fa = (distance(*volume, moved(a, e), shape.shape, b).distance -
                           distance(*volume, moved(a, -e), shape.shape, b).distance) /
                          (2 * kStep);
        const double fb = (distance(*volume, a, shape.shape, moved(b, e)).distance -
                           distance(*volume, a, shape.shape, moved(b, -e)).distance) /
                          (2 * kStep);
        // A seam between the two poses costs a first-order term: the step over the least radius of curvature.
        CHECK(std::abs(fa - d.gradient(0, a.translation())[k]) <= 2e-3);
        CHECK(std::abs(fb - d.gradient(1, b.translation())[k]) <= 2e-3);
      }
    }
}

TEST_CASE("the normal never turns faster than theory allows, over parallel faces, edges and rims") {
  // docs/theory.md, 6: a translation eps turns n by at most eps / (delta + r), and a flat body has r = 0.
  const auto volume = StpBv::build(box(0.3, 0.2, 0.1), {0.01, 10});
  Random random(11);
  for (const std::string& name : boundedShapes())
    for (int sweep = 0; sweep < 4; ++sweep) {
      CAPTURE(name, sweep);
      const TestShape shape = randomShape(name, random);
      const Eigen::Matrix3d turn =
          sweep % 2 == 0 ? Eigen::Matrix3d(random.rotation(1e-4)) : random.rotation();
      const double z = 0.08 + shape.shape.reach + shape.shape.margin;
      const double step = 1e-4;
      Vector3d last(0, 0, 0);
      double lastDistance = 0;
      for (int i = 0; i < 1500; ++i) {
        const Isometry3d at = pose(turn, {-0.4 + i * step, 0.03 * sweep, z});
        const Distance d = distance(*volume, Isometry3d::Identity(), shape.shape, at);
        REQUIRE(d.status == DistanceStatus::exact);
        if (i > 0) {
          const double core = std::min(d.distance, lastDistance) + 0.01 + shape.shape.margin;
          REQUIRE((d.normal - last).norm() <= step / core * (1 + 1e-3) + 1e-12);
          REQUIRE(std::abs(d.distance - lastDistance) <= step + 1e-14);
        }
        last = d.normal;
        lastDistance = d.distance;
      }
    }
}

TEST_CASE("half spaces and planes give the support value at any depth") {
  const Cloud cloud = randomHull(20, {0.2, 0.15, 0.1}, 3);
  const auto volume = StpBv::build(cloud, {0.01, 2});
  Random random(6);
  for (int i = 0; i < 500; ++i) {
    const Isometry3d a = pose(random.rotation(), random.direction()),
                     b = pose(random.rotation(), random.direction());
    const ReferenceBody body = referenceBody(cloud, 0.01, 2, a);
    for (const std::string name : {"halfspace", "plane"}) {
      const TestShape s = randomShape(name, random);
      const Vector3L n = (b.linear() * s.shape.normal).cast<long double>().normalized();
      const long double height = n.dot(b.translation().cast<long double>()) + s.shape.offset;
      const long double above = -height - referenceSupport(body, -n);
      const long double below = height - referenceSupport(body, n);
      const Distance d = distance(*volume, a, s.shape, b);
      CHECK(d.status == DistanceStatus::exact);
      CHECK(std::abs(static_cast<double>(d.distance - (name == "plane" ? std::max(above, below) : above))) <=
            1e-14);
      CHECK((d.point[1] - d.point[0] - d.distance * d.normal).norm() <= 1e-12);
    }
  }
}

TEST_CASE("the two orders of a pair are one answer, mirrored") {
  const auto volume = StpBv::build(box(0.3, 0.2, 0.1), {0.01, 10});
  Random random(8);
  for (const std::string& name : allShapes())
    for (int i = 0; i < 200; ++i) {
      const TestShape shape = randomShape(name, random);
      const Isometry3d a = pose(random.rotation(), 1000 * random.direction());
      const Isometry3d b = pose(random.rotation(), a.translation() + 0.6 * random.direction());
      const Distance d = distance(*volume, a, shape.shape, b), e = distance(shape.shape, b, *volume, a);
      CHECK(d.distance == e.distance);
      CHECK(d.normal == -e.normal);
      CHECK(d.point[0] == e.point[1]);
      CHECK(d.patch[0] == e.patch[1]);
      CHECK(d.lower <= d.upper);
    }
}

TEST_CASE("deep in each other: bounds on both sides of the widest gap that a dense search finds") {
  const Cloud cloud = box(0.3, 0.2, 0.1);
  const auto volume = StpBv::build(cloud, {0.01, 10});
  Random random(13);
  int deep = 0;
  for (const std::string& name : boundedShapes())
    for (int i = 0; i < 12; ++i) {
      CAPTURE(name, i);
      const TestShape shape = randomShape(name, random);
      const Isometry3d b = pose(random.rotation(), 0.05 * random.direction());
      const Distance d = distance(*volume, Isometry3d::Identity(), shape.shape, b);
      if (d.status != DistanceStatus::local) continue;
      ++deep;
      const double truth =
          static_cast<double>(widestGapOverDirections(referenceBody(cloud, 0.01, 10), shape.posed(b), 2000));
      CHECK(d.distance < 0);
      CHECK(d.lower <= d.upper);
      CHECK((d.point[1] - d.point[0] - d.distance * d.normal).norm() <= 1e-14);
      CHECK(truth <= d.upper + 1e-9);
      // Both are gaps along some normal, so neither can exceed the widest; the library's is no worse.
      CHECK(d.distance >= truth - 1e-6 * (1e-3 - truth));
    }
  CHECK(deep > 40);
}

TEST_CASE("deep in a box the witness point is the matching one in its face, not a corner of it") {
  Random random(14);
  const Vector3d half(0.5, 0.6, 0.7);
  for (const Cloud& cloud : {box(0.3, 0.2, 0.1), geodesicSphere(0.1, 2), plate(0.3, 0.2)})
    for (int i = 0; i < 40; ++i) {
      const auto volume = StpBv::build(cloud, {0.01, i % 2 ? 1.0 : 10.0});
      const Isometry3d a = pose(random.rotation(), random.direction());
      const Isometry3d b = a * pose(i % 4 ? random.rotation() : Eigen::Matrix3d(Eigen::Matrix3d::Identity()),
                                    0.25 * random.direction());
      CAPTURE(cloud.size(), i);
      const Distance d = distance(*volume, a, Shape::boxOf(2 * half), b);
      REQUIRE(d.status == DistanceStatus::local);
      CHECK((d.point[1] - d.point[0] - d.distance * d.normal).norm() <= 1e-14);
      const Vector3d inBox = b.inverse() * d.point[1];
      CHECK(std::abs((inBox.cwiseAbs() - half).maxCoeff()) <= 1e-14);  // on its surface
    }
}

TEST_CASE("poses that are no poses and shapes that are no shapes are answered invalid") {
  const auto volume = StpBv::build(box(0.3, 0.2, 0.1), {0.01, 10});
  Isometry3d broken = Isometry3d::Identity();
  broken.translation().x() = std::nan("");
  for (const Distance& d :
       {distance(*volume, broken, Shape::sphere(0.1), Isometry3d::Identity()),
        distance(*volume, Isometry3d::Identity(), Shape::sphere(-1), Isometry3d::Identity()),
        distance(*volume, Isometry3d::Identity(), Shape::sphere(std::nan("")), Isometry3d::Identity()),
        distance(*volume, Isometry3d::Identity(), Shape::polytopeOf(nullptr, 0), Isometry3d::Identity())}) {
    CHECK(d.status == DistanceStatus::invalid);
    CHECK(d.distance == 0);
  }
}

TEST_CASE("shapes without extent are points, segments and discs like any other") {
  const auto volume = StpBv::build(box(0.2, 0.2, 0.2), {0, 1});
  Isometry3d at = Isometry3d::Identity();
  at.translation().x() = 1.0;
  const double truth = distance(*volume, Isometry3d::Identity(), Vector3d(1, 0, 0)).distance;
  for (const Shape& s :
       {Shape::sphere(0), Shape::capsule(0, 0), Shape::boxOf({0, 0, 0}), Shape::cylinderOf(0, 0),
        Shape::coneOf(0, 0), Shape::ellipsoidOf({0, 0, 0}), Shape::cylinderOf(0, 0.1), Shape::coneOf(0, 0.1),
        Shape::triangleOf({0, 0, 0}, {0, 0, 0}, {0, 0, 0}),
        Shape::triangleOf({0, 0, 0}, {1, 0, 0}, {2, 0, 0})}) {
    const Distance d = distance(*volume, Isometry3d::Identity(), s, at);
    CHECK(d.status == DistanceStatus::exact);
    CHECK(std::abs(d.distance - truth) <= 1e-14);
    CHECK(std::isfinite(d.normal.norm()));
  }
}
