// The penetration depth of two shapes without an STP-BV, compared with closed forms and brute force.
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shapes.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// Separating axes in long double: the widest gap over face normals and cross products of edges.
double boxGap(const Vector3d& sidesA, const Isometry3d& a, const Vector3d& sidesB, const Isometry3d& b) {
  using Vector3l = Eigen::Matrix<long double, 3, 1>;
  const Eigen::Matrix<long double, 3, 3> u = a.linear().cast<long double>(),
                                         v = b.linear().cast<long double>();
  const Vector3l t = b.translation().cast<long double>() - a.translation().cast<long double>();
  const Vector3l h = sidesA.cast<long double>() / 2, k = sidesB.cast<long double>() / 2;
  long double best = -1e30L;
  const auto test = [&](const Vector3l& axis) {
    const long double length = axis.norm();
    if (length < 1e-9L) return;
    const Vector3l n = axis / length;
    const long double gap =
        std::abs(n.dot(t)) - (u.transpose() * n).cwiseAbs().dot(h) - (v.transpose() * n).cwiseAbs().dot(k);
    best = std::max(best, gap);
  };
  for (int i = 0; i < 3; ++i) {
    test(u.col(i));
    test(v.col(i));
    for (int j = 0; j < 3; ++j) test(u.col(i).cross(v.col(j)));
  }
  return static_cast<double>(best);
}

/// The gap of two shapes along `n`, by support points of the placed bodies.
double gapAlong(const Shape& a, const Isometry3d& poseA, const Shape& b, const Isometry3d& poseB,
                const Vector3d& n) {
  const Vector3d p = poseA * a.support(poseA.linear().transpose() * n);
  const Vector3d q = poseB * b.support(-(poseB.linear().transpose() * n));
  return n.dot(q - p) - a.margin - b.margin;
}

/// `far`: distance of the bodies from the world's origin (m), with which the rounding of their coordinates
/// grows.
void checkConsistent(const DistanceAnswer& d, const DistanceAnswer& e, double far = 1) {
  CHECK(d.status != DistanceStatus::invalid);
  CHECK((std::isfinite(d.distance) && d.points[0].allFinite() && d.normal.allFinite()));
  CHECK(std::abs(d.normal.norm() - 1) <= 1e-14);
  CHECK((d.points[1] - d.points[0] - d.distance * d.normal).norm() <= 1e-14 * far);
  CHECK((d.lower <= d.distance && d.distance <= d.upper));
  CHECK_FALSE(d.continuous);
  CHECK(e.distance == d.distance);
  CHECK(e.normal == -d.normal);
  CHECK(e.points[0] == d.points[1]);
  CHECK(e.points[1] == d.points[0]);
}

}  // namespace

TEST_CASE("overlapping boxes: the widest gap over the separating axes") {
  Random random(1);
  const Vector3d s(0.2, 0.3, 0.4), t(0.4, 0.1, 0.2);
  const fcl::Boxd first(s), second(t);
  int exact = 0, overlapping = 0;
  for (int i = 0; i < 1000; ++i) {
    CAPTURE(i);
    const Isometry3d a = pose(random.rotation(), random.direction());
    const Isometry3d b =
        pose(random.rotation(), a.translation() + random.uniform(0, 0.3) * random.direction());
    const double truth = boxGap(s, a, t, b);
    if (!(truth < 0)) continue;
    ++overlapping;
    const DistanceAnswer d = distance(first, a, second, b), e = distance(second, b, first, a);
    checkConsistent(d, e);
    // Poses 1 m from the origin are rounded by about 1e-16 m each, amplified by flat faces of the difference.
    CHECK(d.lower <= truth + 1e-14);
    CHECK(d.upper >= truth - 1e-14);
    if (d.status != DistanceStatus::exact) continue;
    ++exact;
    CHECK(std::abs(d.distance - truth) <= 1e-14);
  }
  CHECK(overlapping > 500);
  CHECK(exact >= overlapping * 99 / 100);
}

TEST_CASE("balls, capsules, half spaces and planes overlap by their closed forms") {
  Random random(2);
  const fcl::Sphered ball(0.2), small(0.1);
  const fcl::Boxd box(0.6, 0.8, 1.0);
  const fcl::Capsuled capsule(0.1, 0.6);
  const Vector3d half(0.3, 0.4, 0.5);
  for (int i = 0; i < 500; ++i) {
    CAPTURE(i);
    const Isometry3d a = pose(random.rotation(), random.direction());
    const Vector3d x(random.uniform(-0.3, 0.3), random.uniform(-0.4, 0.4), random.uniform(-0.5, 0.5));
    const Isometry3d b = pose(random.rotation(), a * x);
    const DistanceAnswer d = distance(box, a, ball, b);
    checkConsistent(d, distance(ball, b, box, a));
    CHECK(std::abs(d.distance + (half - x.cwiseAbs()).minCoeff() + 0.2) <= 1e-14);
    const Isometry3d c =
        pose(random.rotation(), a.translation() + random.uniform(1e-3, 0.3) * random.direction());
    const DistanceAnswer balls = distance(ball, a, small, c);
    checkConsistent(balls, distance(small, c, ball, a));
    CHECK(std::abs(balls.distance - ((c.translation() - a.translation()).norm() - 0.3)) <= 1e-14);
    const fcl::Halfspaced ground(Vector3d(0, 0, 1), 0.1);
    const fcl::Planed sheet(Vector3d(0, 0, 1), 0.1);
    const double below = x.z() - 0.1;
    const DistanceAnswer g = distance(ground, a, ball, b), p = distance(sheet, a, ball, b);
    checkConsistent(g, distance(ball, b, ground, a));
    checkConsistent(p, distance(ball, b, sheet, a));
    CHECK(std::abs(g.distance - (below - 0.2)) <= 1e-14);
    CHECK(std::abs(p.distance - (std::abs(below) - 0.2)) <= 1e-14);
  }
  // Axes that cross: the way out is along their common normal, past both radii.
  Eigen::Matrix3d turned = Eigen::AngleAxisd(1.0, Vector3d::UnitX()).toRotationMatrix();
  for (const double apart : {0.0, 1e-9, 0.05}) {
    const Isometry3d here = Isometry3d::Identity(), there = pose(turned, {apart, 0, 0});
    CHECK(std::abs(distance(capsule, here, capsule, there).distance - (apart - 0.2)) <= 1e-14);
  }
}

TEST_CASE(
    "every two bounded shapes: bounds that no direction breaks, the tolerance is met, also 1 km from the "
    "origin") {
  const std::vector<std::shared_ptr<fcl::CollisionGeometryd>> shapes{
      std::make_shared<fcl::Capsuled>(0.1, 0.4),
      std::make_shared<fcl::Boxd>(0.3, 0.2, 0.1),
      std::make_shared<fcl::Cylinderd>(0.2, 0.3),
      std::make_shared<fcl::Coned>(0.2, 0.3),
      std::make_shared<fcl::Ellipsoidd>(0.1, 0.2, 0.3),
      std::make_shared<fcl::Sphered>(0.2),
      hullGeometry(randomHull(30, {0.2, 0.15, 0.1}, 9)),
      std::make_shared<fcl::TrianglePd>(Vector3d(0.2, 0, 0.01), Vector3d(-0.1, 0.2, 0),
                                        Vector3d(-0.1, -0.2, 0))};
  Random random(3);
  int loose = 0, overlapping = 0;
  for (const auto& first : shapes)
    for (const auto& second : shapes)
      for (int i = 0; i < 24; ++i) {
        CAPTURE(static_cast<int>(first->getNodeType()), static_cast<int>(second->getNodeType()), i);
        Shape s, t;
        REQUIRE((shapeOf(*first, s) && shapeOf(*second, t)));
        const double far = i % 3 == 2 ? 1000 : 1;
        const Isometry3d a = pose(random.rotation(), far * random.direction());
        const Isometry3d b =
            i == 0 ? pose(random.rotation(), a.translation())
                   : pose(random.rotation(), a.translation() + random.uniform(0, 0.1) * random.direction());
        const DistanceAnswer d = distance(*first, a, *second, b);
        checkConsistent(d, distance(*second, b, *first, a), far);
        if (!(d.distance < 0)) continue;  // two triangles may miss each other
        ++overlapping;
        CHECK(std::abs(gapAlong(s, a, t, b, d.normal) - d.distance) <= 1e-14 * far);
        double best = -1;
        for (int k = 0; k < 2000; ++k) best = std::max(best, gapAlong(s, a, t, b, random.direction()));
        CHECK(best <= d.upper + 1e-14 * far);
        loose += d.upper - d.lower > 1e-6 * std::abs(d.distance) + 1e-14 * far;
      }
  CHECK(overlapping > 1400);
  CHECK(loose == 0);
}

TEST_CASE("a ball in a cone, a cylinder or a spheroid is exact, on the axis, beside it and away from it") {
  Random random(6);
  const fcl::Sphered ball(0.1);
  const fcl::Coned cone(0.2, 0.3);
  const fcl::Cylinderd cylinder(0.1, 0.6);
  const fcl::Ellipsoidd spheroid(0.1, 0.3, 0.1);
  for (int i = 0; i < 400; ++i) {
    const double off = std::vector<double>{0, 1e-12, 1e-6, 0.03}[static_cast<std::size_t>(i % 4)];
    CAPTURE(i, off);
    const double angle = random.uniform(0, 6.28), z = random.uniform(-0.14, 0.05);
    const Vector3d x(off * std::cos(angle), off * std::sin(angle), z);
    const Isometry3d a = pose(random.rotation(), random.direction()), b = pose(random.rotation(), a * x);
    const DistanceAnswer c = distance(cone, a, ball, b), d = distance(cylinder, a, ball, b);
    checkConsistent(c, distance(ball, b, cone, a));
    checkConsistent(d, distance(ball, b, cylinder, a));
    const double side = ((0.15 - z) * 0.2 - off * 0.3) / std::hypot(0.2, 0.3);
    CHECK((c.status == DistanceStatus::exact && d.status == DistanceStatus::exact));
    CHECK(std::abs(c.distance + std::min(z + 0.15, side) + 0.1) <= 2e-15);
    CHECK(std::abs(d.distance + std::min(0.3 - std::abs(z), 0.1 - off) + 0.1) <= 2e-15);

    // A spheroid about y: its nearest point by a scan of the meridian, refined by halving down to rounding.
    const Isometry3d e = pose(random.rotation(), a * Vector3d(x.x(), x.z(), x.y()));
    const DistanceAnswer s = distance(spheroid, a, ball, e);
    checkConsistent(s, distance(ball, e, spheroid, a));
    CHECK(s.status == DistanceStatus::exact);
    const auto far = [&](double t) { return std::hypot(0.1 * std::sin(t) - off, 0.3 * std::cos(t) - z); };
    double best = 0, width = 3.2;
    for (int round = 0; round < 30; ++round, width *= 0.2) {
      const double middle = best;
      for (int k = -50; k <= 50; ++k)
        if (far(middle + 0.02 * k * width) < far(best)) best = middle + 0.02 * k * width;
    }
    CHECK(std::abs(s.distance + far(best) + 0.1) <= 3e-15);
  }
}

TEST_CASE(
    "two bodies of revolution on parallel axes are exact, and proven to a hundred times the tilt of others") {
  const std::vector<std::shared_ptr<fcl::CollisionGeometryd>> shapes{
      std::make_shared<fcl::Capsuled>(0.1, 0.6), std::make_shared<fcl::Cylinderd>(0.1, 0.6),
      std::make_shared<fcl::Coned>(0.2, 0.3), std::make_shared<fcl::Ellipsoidd>(0.1, 0.1, 0.3)};
  Random random(8);
  int compared = 0;
  for (const auto& first : shapes)
    for (const auto& second : shapes)
      for (const double off : {0.0, 1e-9, 1e-4, 0.05})
        for (const double tilt : {0.0, 1e-10}) {
          CAPTURE(static_cast<int>(first->getNodeType()), static_cast<int>(second->getNodeType()), off, tilt);
          Shape s, t;
          REQUIRE((shapeOf(*first, s) && shapeOf(*second, t)));
          const Isometry3d a = pose(random.rotation(), random.direction());
          const Eigen::Matrix3d spin =
              Eigen::AngleAxisd(random.uniform(0, 6), Vector3d::UnitZ()).toRotationMatrix();
          const Isometry3d b =
              a * pose(spin * random.rotation(tilt), spin * Vector3d(off, 0, random.uniform(-0.1, 0.1)));
          const DistanceAnswer d = distance(*first, a, *second, b);
          checkConsistent(d, distance(*second, b, *first, a));
          if (s.kind == ShapeKind::segment && t.kind == ShapeKind::segment)
            continue;  // cores without a volume
          if (tilt == 0) CHECK(d.status == DistanceStatus::exact);
          // Rounded outward, for a sum of sizes and distances of 2 m.
          CHECK(d.upper - d.lower <= 2e-15 + 2 * tilt + 2 * kGapRounding * 2);
          CHECK(std::abs(gapAlong(s, a, t, b, d.normal) - d.distance) <= 2e-15);
          double best = -1;
          for (int k = 0; k < 20000; ++k) best = std::max(best, gapAlong(s, a, t, b, random.direction()));
          for (int k = 0; k < 20000; ++k)  // close to the normal, where a better one would be
            best = std::max(best, gapAlong(s, a, t, b, (d.normal + 0.01 * random.direction()).normalized()));
          CHECK(best <= d.upper + 1e-15);
          ++compared;
        }
  CHECK(compared == 120);
}

TEST_CASE("a ball in a hull or a triangle overlaps by its closed form, 1 km from the origin too") {
  Random random(5);
  const auto points = box(0.6, 0.8, 1.0);
  const auto hull = hullGeometry(points);
  const fcl::TrianglePd triangle(Vector3d(1, 0, 0), Vector3d(-1, 1, 0), Vector3d(-1, -1, 0));
  const fcl::Sphered ball(0.2);
  const Vector3d half(0.3, 0.4, 0.5);
  for (int i = 0; i < 300; ++i) {
    CAPTURE(i);
    const double far = i % 2 ? 1000 : 1;
    const Isometry3d a = pose(random.rotation(), far * random.direction());
    const Vector3d x(random.uniform(-0.3, 0.3), random.uniform(-0.4, 0.4), random.uniform(-0.5, 0.5));
    const Isometry3d b = pose(random.rotation(), a * x);
    const DistanceAnswer d = distance(*hull, a, ball, b);
    checkConsistent(d, distance(ball, b, *hull, a), far);
    CHECK(std::abs(d.distance + (half - x.cwiseAbs()).minCoeff() + 0.2) <= 1e-13 * far);
    const Vector3d y(0.3 * x.x(), 0.3 * x.y(), 0.3 * x.z());
    const Isometry3d c = pose(random.rotation(), a * y);
    const DistanceAnswer e = distance(triangle, a, ball, c);
    checkConsistent(e, distance(ball, c, triangle, a), far);
    CHECK(std::abs(e.distance - (std::abs(y.z()) - 0.2)) <= 1e-13 * far);
  }
}

TEST_CASE("identical, pointlike and barely overlapping boxes") {
  const fcl::Boxd box(0.2, 0.3, 0.4);
  const Isometry3d here = Isometry3d::Identity();
  CHECK(std::abs(distance(box, here, box, here).distance + 0.2) <= 1e-15);
  const fcl::Sphered ball(0.1);
  CHECK(distance(ball, here, ball, here).distance == -0.2);
  CHECK(distance(fcl::Boxd(0, 0, 0), here, box, here).distance == Approx(-0.1).margin(1e-15));
  const DistanceAnswer d =
      distance(box, here, box, pose(Eigen::Matrix3d::Identity(), {0.2 - 1e-9, 0.01, 0.02}));
  CHECK(std::abs(d.distance + 1e-9) <= 1e-15);
  CHECK((d.normal - Vector3d::UnitX()).norm() <= 1e-9);
}

TEST_CASE("overlapping hulls: the widest gap over all normals that three vertices or two edges can have") {
  Random random(4);
  constexpr int kSmall = trials(200), kLarge = trials(3);
  for (int i = 0; i < kSmall + kLarge; ++i) {
    const int count = i < kSmall ? 10 : 60;
    CAPTURE(i, count);
    const auto p = randomHull(count, {0.2, 0.15, 0.1}, static_cast<unsigned>(2 * i + 1));
    const auto q = randomHull(count, {0.1, 0.2, 0.15}, static_cast<unsigned>(2 * i + 2));
    const Isometry3d a = pose(random.rotation(), random.direction());
    const Isometry3d b =
        pose(random.rotation(), a.translation() + random.uniform(0, 0.1) * random.direction());
    std::vector<Vector3d> x, y, sidesX, sidesY;
    for (const Vector3d& v : p) x.push_back(a * v - a.translation());
    for (const Vector3d& v : q) y.push_back(b * v - a.translation());
    double truth = -1e9;
    const auto test = [&](const Vector3d& axis) {
      if (!(axis.norm() > 1e-9)) return;
      const Vector3d n = axis.normalized();
      double lowX = 1e9, highX = -1e9, lowY = 1e9, highY = -1e9;
      for (const Vector3d& v : x) lowX = std::min(lowX, n.dot(v)), highX = std::max(highX, n.dot(v));
      for (const Vector3d& v : y) lowY = std::min(lowY, n.dot(v)), highY = std::max(highY, n.dot(v));
      truth = std::max({truth, lowY - highX, lowX - highY});
    };
    for (const auto& [points, sides] : {std::make_pair(&x, &sidesX), std::make_pair(&y, &sidesY)})
      for (std::size_t j = 0; j < points->size(); ++j)
        for (std::size_t k = 0; k < j; ++k) {
          sides->push_back((*points)[j] - (*points)[k]);
          for (std::size_t l = 0; l < k; ++l) test(sides->back().cross((*points)[l] - (*points)[k]));
        }
    for (const Vector3d& e : sidesX)
      for (const Vector3d& f : sidesY) test(e.cross(f));
    if (!(truth < 0)) continue;
    const Distance d = distance(Shape::polytopeOf(p.data(), static_cast<int>(p.size())), a,
                                Shape::polytopeOf(q.data(), static_cast<int>(q.size())), b);
    CHECK(d.status == DistanceStatus::exact);
    CHECK(std::abs(d.distance - truth) <= 1e-14);
  }
}
