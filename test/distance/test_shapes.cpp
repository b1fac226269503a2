// An STP-BV against each simple shape: derivatives, continuity, planes, penetration, robustness. shape_soak
// compares random poses with the reference.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shape_reference.h"
#include "test/reference/trials.h"

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

}  // namespace

TEST_CASE("along fine paths the normal never turns faster than theory allows, for every pair of shapes") {
  // docs/theory.md, 6: a translation eps turns n by at most eps / (delta + r1 + r2). A flat body has r = 0.
  const std::vector<StpBv::Ptr> volumes{
      StpBv::build(box(0.3, 0.2, 0.1), {0.01, 10}), StpBv::build(geodesicSphere(0.2, 1), {0.01, 1}),
      StpBv::build(plate(0.3, 0.2), {0.005, 10}), StpBv::build(cylinder(0.1, 0.4, 16), {0.02, 100}),
      StpBv::build({{0, 0, 0}, {0.3, 0, 0}}, {0.02, 0.5})};
  Random random(11);
  for (const std::string& name : boundedShapes())
    for (int path = 0; path < 60; ++path) {
      CAPTURE(name, path);
      const StpBv& volume = *volumes[static_cast<std::size_t>(path % 5)];
      const TestShape shape = randomShape(name, random);
      const double margins = volume.radii().r + shape.shape.margin;
      // In a third of the cases along a face of the volume, turned by almost nothing. The distance goes down
      // to within the margins.
      const Eigen::Matrix3d turn =
          path % 3 == 0 ? Eigen::Matrix3d(random.rotation(random.below(2) ? 0 : 1e-6)) : random.rotation();
      Vector3d way = random.direction();
      Isometry3d at =
          pose(turn, path % 3 == 0 ? Vector3d(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), 2)
                                   : Vector3d(2 * random.direction()));
      const double gap = path % 2 ? random.uniform(-0.8, 0) * margins : random.uniform(1e-4, 0.05);
      const auto ask = [&] { return distance(volume, Isometry3d::Identity(), shape.shape, at); };
      Distance last = ask();
      for (int i = 0; i < 100 && std::abs(last.distance - gap) > 1e-9; ++i) {
        at.translation() += (gap - last.distance) * last.normal;
        last = ask();
      }
      REQUIRE(last.status == DistanceStatus::exact);
      way = (way - way.dot(last.normal) * last.normal)
                .normalized();  // along the surfaces, across their boundaries
      for (const double step : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
        CAPTURE(step);
        const Vector3d start = at.translation();
        last = ask();
        double worst = 0, jump = 0;
        for (int i = 1; i <= 150; ++i) {
          at.translation() = start + i * step * way;
          const Distance d = ask();
          if (d.status == DistanceStatus::local) break;  // moved too deep
          REQUIRE(d.status == DistanceStatus::exact);
          // Between two poses the cores may be slightly nearer than at either, because no distance curves
          // more than a point's. The error of a normal is what an ulp of it moves the core's point by,
          // divided by what curves the gap.
          const double ends = std::min(d.distance, last.distance) + margins;
          const double nearer = ends - step * step / (6 * ends);
          if (!(nearer > step)) break;
          const double rounded = 16 * 2.2e-16 * (volume.radii().rho + 4) / nearer;
          const double angle = 2 * std::asin(std::min(1.0, 0.5 * (d.normal - last.normal).norm()));
          worst = std::max(worst, angle / (step / nearer + rounded));
          jump = std::max(jump, std::abs(d.distance - last.distance) / (step + 1e-15 * 4));
          last = d;
        }
        CHECK(worst <= 1);
        CHECK(jump <= 1);
        at.translation() = start + step * way;
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

TEST_CASE("the two orders of two hulls are one answer, mirrored, even if only their corners differ") {
  Cloud cube, turned;
  for (int i = 0; i < 8; ++i) {
    const Vector3d p(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    cube.push_back(p);
    turned.emplace_back(0.6 * p.x() - 0.8 * p.y(), 0.8 * p.x() + 0.6 * p.y(), p.z());
  }
  Shape square = Shape::polytopeOf(cube.data(), 8), diamond = Shape::polytopeOf(turned.data(), 8);
  diamond.reach = square.reach;  // they differ by rounding
  const Vector3d p(1, 0, 0), q(-0.5, std::sqrt(0.75), 0), r(-0.5, -std::sqrt(0.75), 0);
  const Shape triangle = Shape::triangleOf(p, q, r), opposite = Shape::triangleOf(-p, -q, -r);
  for (const auto& [one, other] : {std::pair(square, diamond), std::pair(triangle, opposite)}) {
    const Isometry3d at = Isometry3d::Identity();
    const Distance d = distance(one, at, other, at), e = distance(other, at, one, at);
    CHECK(d.distance == e.distance);
    CHECK(d.normal == -e.normal);
    CHECK(d.point[0] == e.point[1]);
  }
}

TEST_CASE("deep in each other: bounds on both sides of the widest gap that a dense search finds") {
  // The differences of the spindle with segments and triangles are nearly flat.
  const std::vector<std::pair<Cloud, double>> bodies{{box(0.3, 0.2, 0.1), 10},
                                                     {{{0, 0, 0}, {0.3, 0, 0}}, 0.5}};
  Random random(13);
  int deep = 0;
  for (const std::string& name : boundedShapes())
    for (int i = 0; i < 40; ++i) {
      CAPTURE(name, i);
      const TestShape shape = randomShape(name, random);
      const auto& [cloud, R] = bodies[static_cast<std::size_t>(i % 2)];
      const auto volume = StpBv::build(cloud, {0.01, R});
      const Isometry3d b = pose(random.rotation(), 0.05 * random.direction());
      const Distance d = distance(*volume, Isometry3d::Identity(), shape.shape, b);
      if (d.status != DistanceStatus::local) continue;
      ++deep;
      const double truth =
          static_cast<double>(widestGapOverDirections(referenceBody(cloud, 0.01, R), shape.posed(b), 1000));
      CHECK(d.distance < 0);
      CHECK(d.lower <= d.upper);
      CHECK((d.point[1] - d.point[0] - d.distance * d.normal).norm() <= 1e-14);
      CHECK(truth <= d.upper + 1e-9);
      // Both are gaps along some normal, so neither can exceed the widest one. The library's is not worse.
      CHECK(d.distance >= truth - 1e-6 * (1e-3 - truth));
    }
  CHECK(deep > 150);
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
    CHECK(d.distance == -std::numeric_limits<double>::infinity());
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

TEST_CASE("a needle is as far, and its normal unit, whichever shape it is written as") {
  Random random(41);
  int asked = 0;
  for (int i = 0; i < trials(3000); ++i) {
    const double length = random.uniform(1, 20);
    const std::array<Vector3d, 2> end{Vector3d(0, 0, -length / 2), Vector3d(0, 0, length / 2)};
    // A corner of the volume next to the needle, or exactly at its end.
    const double gap = i % 4 == 0 ? 0.0 : length * std::pow(10.0, random.uniform(-13, -7));
    Vector3d beside = gap * random.direction();
    if (i % 2 == 0) beside.z() = 0;
    const double along = i % 6 == 0 ? 0.5 : random.uniform(-0.55, 0.55);
    std::vector<Vector3d> points{beside + along * length * Vector3d::UnitZ()};
    for (int k = 0; k < i % 3; ++k) {
      Vector3d away = random.direction();
      away.x() = std::abs(away.x());
      points.push_back(points[0] + random.uniform(0.1, 3) * away);
    }
    const auto volume = StpBv::build(points, {i % 5 < 2 ? 0.0 : 0.1, random.uniform(4, 50)});
    const Isometry3d at = pose(random.rotation(), random.direction());
    double lower = -std::numeric_limits<double>::infinity(), upper = -lower;
    for (const Shape& needle :
         {Shape::polytopeOf(end.data(), 2), Shape::boxOf({0, 0, length}), Shape::capsule(0, length),
          Shape::cylinderOf(0, length), Shape::coneOf(0, length), Shape::triangleOf(end[0], end[1], end[1]),
          Shape::ellipsoidOf({0, 0, length / 2})}) {
      const Distance d = distance(*volume, at, needle, at);
      lower = std::max(lower, d.lower);
      upper = std::min(upper, d.upper);
      CAPTURE(i, static_cast<int>(needle.kind));
      CHECK(std::abs(d.normal.norm() - 1) <= 1e-14);
      ++asked;
    }
    CAPTURE(i, upper - lower);
    CHECK(lower <= upper);
  }
  CHECK(asked == 7 * trials(3000));
}
