// A simple shape deep in an STP-BV or in another shape, and ellipsoids as thin as discs: bounds and witness
// points, compared with supports in long double.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shape_reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct OverlapBody {
  Cloud cloud;
  StpBv::Ptr volume;
};

std::vector<OverlapBody> overlapBodies(double largest) {
  std::vector<OverlapBody> all;
  const auto add = [&](const Cloud& cloud, double r, double R) {
    if (R <= largest) all.push_back({cloud, StpBv::build(cloud, {r, R})});
  };
  add(box(0.3, 0.2, 0.1), 0.01, 10);
  add(plate(0.3, 0.2), 0.005, 10);
  add(needle(0.5), 0.01, 1);
  add(cylinder(0.1, 0.4, 16), 0.02, 100);
  add(geodesicSphere(0.2, 1), 0.01, 1);
  add(box(0.2, 0.2, 0.2), 0, 10);
  add(box(0.3, 0.2, 0.1), 0.01, 1e4);
  add(box(0.3, 0.2, 0.1), 0.01, 1e6);
  return all;
}

/// The local maximum of the gap that `n` leads to, by a shrinking compass.
template <typename Gap>
double hilltop(const Gap& gap, const Vector3d& from) {
  Vector3L n = from.cast<long double>().normalized();
  long double best = gap(n), step = 1e-2L;
  while (step > 1e-14L) {
    const Vector3L e = n.unitOrthogonal(), f = n.cross(e);
    bool grew = false;
    for (int k = 0; k < 8; ++k) {
      const long double angle = 0.785398163397448L * k + 7 * step;  // turned a little in each round
      const Vector3L m = (n + step * (std::cos(angle) * e + std::sin(angle) * f)).normalized();
      const long double g = gap(m);
      if (g > best) best = g, n = m, grew = true;
    }
    if (!grew) step *= 0.5L;
  }
  return static_cast<double>(best);
}

/// A pose of which a quarter is aligned and a quarter nearly so, within 0.2 m of each other's centre.
Isometry3d inside(Random& random) {
  Eigen::Matrix3d turn = random.rotation();
  const int kind = random.below(4);
  if (kind == 0) turn = Eigen::Matrix3d::Identity();
  if (kind == 1) turn = random.rotation(random.below(2) ? 1e-6 : 1e-3);
  return pose(turn, random.uniform(0, 0.2) * random.direction());
}

std::string anyBounded(Random& random) {
  return boundedShapes()[static_cast<std::size_t>(random.below(static_cast<int>(boundedShapes().size())))];
}

}  // namespace

TEST_CASE("two shapes deep in each other: no gap on the answer's hill is above the upper bound") {
  Random random(5);
  int deep = 0, exact = 0;
  for (int i = 0; i < 4000; ++i) {
    const TestShape a = randomShape(anyBounded(random), random), b = randomShape(anyBounded(random), random);
    const Isometry3d base = pose(random.rotation(), random.direction()), at = base * inside(random);
    const Distance d = distance(a.shape, base, b.shape, at);
    if (!(d.distance < -(a.shape.margin + b.shape.margin))) continue;
    ++deep;
    exact += d.status == DistanceStatus::exact;
    const ReferenceShape ra = a.posed(base), rb = b.posed(at);
    const double top = hilltop([&](const Vector3L& n) { return referenceGap(ra, rb, n); }, d.normal);
    CAPTURE(i, a.name, b.name, d.distance, d.upper - d.distance, top - d.upper);
    REQUIRE(d.upper >= top);
    REQUIRE(d.lower <= top);
  }
  REQUIRE(deep > 1500);
  REQUIRE(exact > deep / 2);
}

TEST_CASE("an STP-BV and a shape deep in it: no gap on the answer's hill is above the upper bound") {
  // The reference's long double is accurate to 1e-13 m at R = 1e6 m, which is better than the bound there.
  const std::vector<OverlapBody> bodies = overlapBodies(1e6);
  Random random(6);
  int deep = 0;
  for (int i = 0; i < 1200; ++i) {
    const OverlapBody& body = bodies[static_cast<std::size_t>(i) % bodies.size()];
    const double r = body.volume->radii().r, R = body.volume->radii().R;
    const TestShape b = randomShape(anyBounded(random), random);
    const Isometry3d base = pose(random.rotation(), random.direction()), at = base * inside(random);
    const Distance d = distance(*body.volume, base, b.shape, at);
    if (!(d.distance < -(r + b.shape.margin))) continue;
    ++deep;
    const ReferenceBody ra = referenceBody(body.cloud, r, R, base);
    const ReferenceShape rb = b.posed(at);
    const auto gap = [&](const Vector3L& n) -> long double {
      return n.dot(rb.support(-n)) - rb.margin - referenceSupport(ra, n);
    };
    const double top = hilltop(gap, d.normal);
    CAPTURE(i, b.name, R, d.distance, d.upper - d.distance, top - d.upper);
    REQUIRE(d.upper >= top);
    REQUIRE(d.lower <= top);
  }
  REQUIRE(deep > 500);
}

TEST_CASE("deep in an STP-BV both witness points are on their bodies and opposite each other") {
  const std::vector<OverlapBody> bodies = overlapBodies(100);
  Random random(7);
  int deep = 0;
  for (int i = 0; i < 3000; ++i) {
    const OverlapBody& body = bodies[static_cast<std::size_t>(i) % bodies.size()];
    TestShape b = randomShape(anyBounded(random), random);
    if (i % 10 == 0) b = {"needle", Shape::ellipsoidOf({random.uniform(0.1, 0.5), 0, 0}), nullptr};
    if (i % 10 == 5)
      b = {"disc", Shape::ellipsoidOf({random.uniform(0.1, 0.5), 0, random.uniform(0.1, 0.5)}), nullptr};
    const Isometry3d base = pose(random.rotation(), random.direction()), at = base * inside(random);
    const Distance d = distance(*body.volume, base, b.shape, at);
    if (!(d.distance < -(body.volume->radii().r + b.shape.margin))) continue;
    ++deep;
    CAPTURE(i, b.name, body.volume->radii().R, d.distance);
    // For coordinates of about 3 m. An ulp of the normal moves the volume's point by R ulps.
    const double rounding = 1e-14 * (3 + body.volume->radii().R);
    REQUIRE((d.point[1] - d.point[0] - d.distance * d.normal).norm() < rounding);
    // The shape's point is `margin` away from a point of its core that lies in the core's supporting plane.
    Shape core = b.shape;
    core.margin = 0;
    const Vector3d y = d.point[1] + b.shape.margin * d.normal;
    Isometry3d there = at;
    there.translation() = y;
    REQUIRE(distance(Shape::sphere(0), there, core, at).distance < 1e-14);
    const Vector3d facing = at * core.support(-(at.linear().transpose() * d.normal));
    REQUIRE(std::abs(d.normal.dot(y - facing)) < 1e-14);
  }
  REQUIRE(deep > 1000);
}

TEST_CASE(
    "a round shape deep in an STP-BV with large R: the gap is a local maximum, the points are opposite") {
  // At these R a patch's region of normals is down to 1e-9 rad wide, less than the error of EPA's normal.
  const Cloud flat = box(1, 1, 1e-3), prism = cylinder(0.5, 1, 16), hexagon = cylinder(0.5, 1, 6);
  const Vector3d slanted = Vector3d(-0.693304, -0.151656, -0.704507).normalized();
  struct Case {
    const Cloud& cloud;
    double r;
    TestShape shape;
    Isometry3d at;
  };
  const auto turned = [](double angle, const Vector3d& axis, double up) {
    return pose(Eigen::AngleAxisd(angle, axis).toRotationMatrix(), Vector3d(0, 0, up));
  };
  const TestShape ellipsoid{"ellipsoid", Shape::ellipsoidOf({0.5, 0.4, 1}), nullptr},
      tube{"cylinder", Shape::cylinderOf(0.5, 2), nullptr};
  std::vector<Case> cases{{flat, 0.01, ellipsoid, turned(1e-7, slanted, 0)}};
  for (const double tilt : {1e-9, 1e-8, 1e-7, 1e-6})
    for (const double up : {0.0, 0.1}) {
      cases.push_back({prism, 0, tube, turned(tilt, Vector3d::UnitX(), up)});
      cases.push_back({hexagon, 0, tube, turned(tilt, Vector3d::UnitX(), up)});
    }
  for (const double R : {1e4, 1e5, 1e6})
    for (const Case& c : cases) {
      const Isometry3d base = Isometry3d::Identity();
      const Distance d = distance(c.shape.shape, base, *StpBv::build(c.cloud, {c.r, R}), c.at);
      const ReferenceShape ra = c.shape.posed(base);
      const ReferenceBody rb = referenceBody(c.cloud, c.r, R, c.at);
      const auto gap = [&](const Vector3L& n) -> long double {
        return -referenceSupport(rb, -n) - n.dot(ra.support(n)) - ra.margin;
      };
      CAPTURE(R, c.shape.name, c.cloud.size(), c.at.translation()[2], d.distance);
      REQUIRE(d.status == DistanceStatus::local);
      // The reference's long double is good to 1e-19 R.
      CHECK(std::abs(hilltop(gap, d.normal) - d.distance) < 2e-14 + 3e-19 * R);
      // An ulp of the normal moves the volume's point by 2.2e-16 R; the points are of several operations.
      CHECK((d.point[1] - d.point[0] - d.distance * d.normal).norm() < 1e-15 * (3 + R));
    }
}

TEST_CASE(
    "two shapes deep in each other: the normal is the top of its hill, the points are on their bodies") {
  Random random(12);
  int deep = 0;
  for (int i = 0; i < 2000; ++i) {
    const TestShape a = randomShape(anyBounded(random), random), b = randomShape(anyBounded(random), random);
    const Isometry3d base = pose(random.rotation(), random.direction()),
                     at = base * pose(random.rotation(), random.uniform(0, 0.2) * random.direction());
    const Distance d = distance(a.shape, base, b.shape, at);
    if (!(d.distance < -(a.shape.margin + b.shape.margin))) continue;
    ++deep;
    CAPTURE(i, a.name, b.name, d.distance);
    const ReferenceShape ra = a.posed(base), rb = b.posed(at);
    const double top = hilltop([&](const Vector3L& n) { return referenceGap(ra, rb, n); }, d.normal);
    CHECK(top - d.distance <= 2e-14);
    for (const int side : {0, 1}) {
      const ReferenceShape& body = side == 0 ? ra : rb;
      const Vector3L n = (side == 0 ? 1 : -1) * d.normal.cast<long double>(),
                     x = d.point[static_cast<std::size_t>(side)].cast<long double>();
      const auto beyond = [&](const Vector3L& m) -> long double {
        return m.dot(x - body.support(m)) - body.margin;
      };
      CHECK(std::abs(static_cast<double>(beyond(n))) <= 1e-14);  // in the supporting plane
      const Vector3L e = n.unitOrthogonal(), f = n.cross(e);
      for (const long double tilt : {1.0L, 1e-1L, 1e-2L, 1e-4L, 1e-6L})  // and not outside
        for (int k = 0; k < 8; ++k) {
          const long double angle = 0.785398163397448L * k;
          const Vector3L m = (n + tilt * (std::cos(angle) * e + std::sin(angle) * f)).normalized();
          CHECK(beyond(m) <= 1e-14L);
        }
    }
  }
  CHECK(deep > 1000);
}

TEST_CASE("bodies of revolution on nearly parallel axes: both witness points are on their bodies") {
  // The supporting faces are generators and discs. EPA examines only a few of their points.
  const std::vector<std::string> names{"cylinder", "cone", "capsule", "ellipsoid"};
  Random random(11);
  int overlaps = 0, off = 0;
  for (int i = 0; i < 2000; ++i) {
    TestShape a = randomShape(names[static_cast<std::size_t>(random.below(2))], random);
    TestShape b = randomShape(names[static_cast<std::size_t>(random.below(4))], random);
    if (b.name == "ellipsoid") b.shape = Shape::ellipsoidOf({0.2, 0.2, random.uniform(0.1, 0.5)});
    const double tilt = i % 4 == 0 ? 0.0 : std::pow(10.0, random.uniform(-9, -3));
    const Isometry3d base = pose(random.rotation(), random.direction());
    const Isometry3d at =
        base * pose(random.rotation(tilt), i % 2 ? Vector3d(0, 0, 0) : Vector3d(0.05 * random.direction()));
    const Distance d = distance(a.shape, base, b.shape, at);
    if (!(d.distance < -(a.shape.margin + b.shape.margin))) continue;
    ++overlaps;
    CAPTURE(i, a.name, b.name, tilt, d.distance);
    double away = 0;
    for (const int side : {0, 1}) {
      const Shape& shape = side == 0 ? a.shape : b.shape;
      Isometry3d there = Isometry3d::Identity();
      there.translation() = d.point[static_cast<std::size_t>(side)];
      away = std::max(away, distance(Shape::sphere(0), there, shape, side == 0 ? base : at).distance);
    }
    REQUIRE(away < 1e-4);
    off += away > 1e-6;
  }
  REQUIRE(overlaps > 1000);
  REQUIRE(off < overlaps / 50);
}

TEST_CASE("nearly parallel segments that almost touch: no gap along their common normal is above the bound") {
  Random random(9);
  int near = 0;
  for (int i = 0; i < 20000; ++i) {
    const double h = random.uniform(0.05, 1), k = random.uniform(0.05, 1);
    const double angle = std::pow(10.0, random.uniform(-12, -4));
    const Isometry3d a = pose(random.rotation(), Vector3d::Zero());
    Isometry3d b = pose(random.rotation(angle) * a.linear(), Vector3d::Zero());
    b.translation() = random.uniform(0, 0.5) * angle * h * random.direction();
    const Distance d = distance(Shape::capsule(0, 2 * h), a, Shape::capsule(0, 2 * k), b);
    const Vector3L u = a.linear().col(2).cast<long double>(), v = b.linear().col(2).cast<long double>();
    const Vector3L r = b.translation().cast<long double>(), n = u.cross(v).normalized();
    const long double gap = std::abs(n.dot(r)) - std::abs(n.dot(u)) * h - std::abs(n.dot(v)) * k;
    CAPTURE(i, h, k, angle, d.distance, d.upper - d.distance, static_cast<double>(gap) - d.upper);
    REQUIRE(d.upper >= static_cast<double>(gap));
    REQUIRE(d.lower <= d.upper);
    near += gap > 1e-14L;
  }
  REQUIRE(near > 5000);
}

TEST_CASE("crossing capsules: both witness points are on their bodies") {
  Random random(10);
  for (int i = 0; i < 1000; ++i) {
    const double r = random.uniform(0.01, 0.2), s = random.uniform(0.01, 0.2), h = random.uniform(0.1, 1),
                 k = random.uniform(0.1, 1);
    const Isometry3d a = pose(random.rotation(), random.direction());
    Isometry3d b = pose(random.rotation(), a.translation());
    if (i % 2) b.translation() += random.uniform(-h, h) * a.linear().col(2);  // the axes still meet
    const Distance d = distance(Shape::capsule(r, 2 * h), a, Shape::capsule(s, 2 * k), b);
    CAPTURE(i, r, s, h, k, d.distance);
    const auto off = [](const Isometry3d& at, double half, double radius, const Vector3d& point) {
      const Vector3d p = at.inverse() * point;
      return std::abs((p - Vector3d(0, 0, std::clamp(p.z(), -half, half))).norm() - radius);
    };
    REQUIRE(std::abs(d.distance + r + s) < 1e-14);
    REQUIRE(off(a, h, r, d.point[0]) < 1e-14);
    REQUIRE(off(b, k, s, d.point[1]) < 1e-14);
  }
}

TEST_CASE(
    "an ellipsoid as thin as a disc or a needle: distance, witness points and gradient keep their digits") {
  const std::vector<OverlapBody> bodies = overlapBodies(100);
  Random random(8);
  for (const double thickness : {1e-2, 1e-4, 1e-6, 1e-9, 0.0}) {
    int apart = 0;
    for (int i = 0; i < 200; ++i) {
      const OverlapBody& body = bodies[static_cast<std::size_t>(i) % bodies.size()];
      const double r = body.volume->radii().r, R = body.volume->radii().R, length = random.uniform(0.05, 0.4);
      Vector3d axes(length, i % 3 == 0 ? thickness * length : random.uniform(0.05, 0.4), thickness * length);
      std::rotate(axes.data(), axes.data() + random.below(3), axes.data() + 3);
      const TestShape thin{"ellipsoid", Shape::ellipsoidOf(axes), nullptr};
      Isometry3d rel = inside(random);
      rel.translation() = random.uniform(0.2, 1.5) * random.direction();
      const Isometry3d base = pose(random.rotation(), random.direction()), at = base * rel;
      const Vector3L towards = (at.translation() - base.translation()).cast<long double>();
      const ReferenceAnswer truth =
          referenceDistance(referenceBody(body.cloud, r, R, base), thin.posed(at), towards);
      if (truth.overlap || truth.distance < 1e-3L) continue;
      ++apart;
      const Distance d = distance(*body.volume, base, thin.shape, at);
      CAPTURE(thickness, i, R, d.distance, axes.transpose());
      REQUIRE(d.status == DistanceStatus::exact);
      REQUIRE(std::abs(d.distance - static_cast<double>(truth.distance)) < 1e-14);
      // The points are opposite each other, so the gradient is that of the distance: its moments are those of
      // the points.
      const double rounding = 1e-14 * (3 + R);
      REQUIRE((d.point[1] - d.point[0] - d.distance * d.normal).norm() < rounding);
      const Vector3d p = at.linear().transpose() * (d.point[1] - at.translation());
      for (int k = 0; k < 3; ++k) REQUIRE(std::abs(p[k]) <= axes[k] + 1e-15);
      double level = 0;
      for (int k = 0; k < 3; ++k)
        if (axes[k] > 1e-3) level += p[k] / axes[k] * (p[k] / axes[k]);
      // The points are accurate to 1e-15 m, and the axes count as at least 1e-3 m.
      REQUIRE(level < 1 + 1e-11);
    }
    REQUIRE(apart > 100);
  }
}

TEST_CASE("a small shape deep in a large STP-BV takes a few steps, not a polytope") {
  // EPA takes about sixty steps; the first or second normal finds a corner that is the last to leave.
  const StpBv::Ptr body = StpBv::build(randomHull(60, {0.4, 0.4, 0.4}, 4), {0.01, 10});
  const Shape triangle = Shape::triangleOf({0, 0, 0}, {0.01, 0, 0}, {0.003, 0.01, 0});
  Random random(9);
  for (const Shape& shape : {triangle, Shape::boxOf({0.01, 0.01, 0.01}), Shape::sphere(0.02)}) {
    int deep = 0;
    double steps = 0;
    for (int i = 0; i < 300; ++i) {
      const Isometry3d at = pose(random.rotation(), random.uniform(0, 0.35) * random.direction());
      const Distance d = distance(*body, Isometry3d::Identity(), shape, at);
      if (!(d.distance < -0.05)) continue;
      ++deep;
      steps += d.patchPairs;
      REQUIRE(d.upper - d.lower <= 1e-9);
    }
    REQUIRE(deep > 200);
    CAPTURE(steps / deep);
    REQUIRE(steps <= 12.0 * deep);
  }
}
