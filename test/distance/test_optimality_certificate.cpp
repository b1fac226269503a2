// A ball and the corners of a feature around the origin: where the proof holds, no direction is a shorter way
// out of their hull than the one over the feature. Also the axes of two boxes, and the answers that they
// prove.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "fcl_stpbv/distance/box_axes.h"
#include "fcl_stpbv/distance/certificate.h"
#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shapes.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

/// A maximum at `-depth n`, with three or four corners around it and a ball below.
struct Hull {
  Vector3d n, centre;
  double depth, radius;
  FeatureCorners corners;

  static Hull random(Random& some) {
    Hull h;
    h.n = some.direction();
    h.depth = std::pow(10.0, some.uniform(-3, -0.5));
    // Numbers are drawn in separate statements, because compilers evaluate an expression's parts in different
    // orders.
    const double radius = some.uniform(0.5, 2.0), decade = some.uniform(0, 1);
    h.radius = radius * h.depth * std::pow(10.0, decade);
    const double size = h.depth * std::pow(10.0, some.uniform(-2, 0.5)),
                 below = size * std::pow(10.0, some.uniform(-3, 0));
    const Vector3d out = -h.n, x = out.unitOrthogonal(), y = out.cross(x);
    const double alongX = some.uniform(-2, 2), alongY = some.uniform(-2, 2);
    h.centre = (h.depth - h.radius - below) * out + size * (alongX * x + alongY * y);
    h.corners.count = some.uniform(0, 1) < 0.5 ? 3 : 4;
    const double step = 2 * M_PI / static_cast<double>(h.corners.count), start = some.uniform(0, step);
    for (std::size_t i = 0; i < h.corners.count; ++i) {
      const double angle = start + step * (static_cast<double>(i) + some.uniform(-0.2, 0.2)),
                   far = size * some.uniform(0.5, 2), height = h.depth - 0.1 * below * some.uniform(0, 1);
      h.corners.point[i] = pack(height * out + far * (std::cos(angle) * x + std::sin(angle) * y));
    }
    return h;
  }

  bool closes() const { return closesOverBall(pack(centre), radius, corners, pack(n), depth); }

  /// Support of the hull and the maximum's point along `m`.
  double support(const Vector3d& m) const {
    double most = std::max(m.dot(centre) + radius, -depth * n.dot(m));
    for (std::size_t i = 0; i < corners.count; ++i) most = std::max(most, m.dot(unpack(corners.point[i])));
    return most;
  }

  /// Least distance of the planes through the maximum's point and each side of the feature.
  double side() const {
    double least = depth;
    for (std::size_t i = 0; i < corners.count; ++i) {
      const Vector3d p = unpack(corners.point[i]), q = unpack(corners.point[(i + 1) % corners.count]);
      least = std::min(least, p.dot((q - p).cross(-depth * n - p).normalized()));
    }
    return least;
  }
};

/// The least support found by trying directions closer and closer around the best so far.
double leastSupport(const Hull& h, Random& some) {
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start < 12; ++start) {
    const double spread = some.uniform(0, 1);
    const Vector3d any = some.direction();
    Vector3d best = start < 10 ? Vector3d((-h.n + spread * any).normalized()) : any;
    double here = h.support(best);
    for (double reach = 0.5; reach > 1e-7; reach *= 0.9) {
      const Vector3d m = (best + reach * some.direction()).normalized();
      if (h.support(m) < here) here = h.support(m), best = m;
    }
    least = std::min(least, here);
  }
  return least;
}

}  // namespace

TEST_CASE("A ball and the corners of a feature prove a depth") {
  Random some(5);
  int proven = 0, refuted = 0;
  for (int i = 0; i < trials(30000); ++i) {
    const Hull h = Hull::random(some);
    const double side = h.side();
    if (!(side > 0.9 * h.depth)) continue;
    const bool closes = h.closes();
    if (!closes && refuted > trials(300)) continue;
    const double least = leastSupport(h, some);
    if (closes) {
      ++proven;
      INFO("hull " << i << ", depth " << h.depth << ", side " << side);
      CHECK(least >= side * (1 - 1e-12));
    } else {
      refuted += least < side * (1 - 1e-6);
    }
  }
  CHECK(proven > trials(300));
  CHECK(refuted > trials(300));  // for some of the hulls the proof does not hold
}

TEST_CASE("The inner ball is inside the vertices' hull, and as large as the centre allows") {
  const std::vector<std::pair<Cloud, double>> bodies{{box(0.2, 0.4, 0.6), 0.1},
                                                     {cylinder(0.1, 0.3), 0.1 * std::cos(M_PI / 24)},
                                                     {geodesicSphere(0.2, 3), 0.199},
                                                     {plate(0.5, 0.5), 0.0005},
                                                     {needle(0.5), 0.001}};
  Random some(6);
  for (const auto& [cloud, radius] : bodies) {
    const StpBv::Ptr volume = StpBv::build(cloud, {0.01, 10.0});
    CHECK(volume->innerRadius() >= 0.98 * radius);
    for (int i = 0; i < 1000; ++i) {
      const Vector3d m = some.direction();
      double reach = -std::numeric_limits<double>::infinity();
      for (const Vector3d& p : cloud) reach = std::max(reach, m.dot(p - volume->centre()));
      CHECK(volume->innerRadius() <= reach);
    }
  }
}

TEST_CASE("A body's box is its hull only where the vertices are its corners") {
  Random some(7);
  const auto boxOf = [](const Cloud& cloud) { return StpBv::build(cloud, {0.01, 10.0})->tables().box; };
  const auto turned = [&](Cloud cloud, double noise) {
    const Eigen::Matrix3d turn = some.rotation();
    for (Vector3d& p : cloud) p = turn * p + Vector3d(0.3, -0.2, 0.1) + noise * some.direction();
    return cloud;
  };
  for (const Cloud& cloud : {box(0.2, 0.3, 0.4), plate(0.3, 0.2, 0.01)}) {
    CHECK(boxOf(cloud).isHull);
    CHECK(boxOf(cloud).isTelling);
    for (int i = 0; i < 20; ++i) {
      CHECK(boxOf(turned(cloud, 0)).isHull);
      CHECK_FALSE(boxOf(turned(cloud, 1e-9)).isHull);
    }
  }
  CHECK_FALSE(boxOf(cylinder(0.1, 0.4)).isHull);
  CHECK(boxOf(cylinder(0.1, 0.4)).isTelling);
  CHECK_FALSE(boxOf(geodesicSphere(0.2, 1)).isTelling);
  CHECK_FALSE(boxOf({Vector3d(1, 2, 3)}).isTelling);
  CHECK_FALSE(boxOf(plate(0.5, 0.5, 1e-4)).isHull);  // too thin
}

TEST_CASE("Two boxes overlap least along one of fifteen axes") {
  Random some(8);
  for (int i = 0; i < 200; ++i) {
    const auto sizes = [&] { return Vector3d(some.uniform(0.05, 0.5), some.uniform(0.05, 0.5), 0.3); };
    const Vector3d sizeA = sizes(), sizeB = sizes();
    const Cloud cloudA = box(sizeA.x(), sizeA.y(), sizeA.z()), cloudB = box(sizeB.x(), sizeB.y(), sizeB.z());
    const StpBv::Ptr a = StpBv::build(cloudA, {0.01, 10.0}), b = StpBv::build(cloudB, {0.01, 10.0});
    const RelativePose pose(fcl_stpbv::test::pose(some.rotation(), some.direction()),
                            fcl_stpbv::test::pose(some.rotation(), some.direction()));
    const BodyPair pair(*a, *b, pose);
    const auto overlap = [&](const Vector3d& n) {
      double most = -1e300, least = 1e300;
      for (const Vector3d& p : cloudA) most = std::max(most, n.dot(p));
      for (const Vector3d& p : cloudB) least = std::min(least, n.dot(pose.placed(p)));
      return most - least;
    };
    const BoxAxes axes(pair);
    std::vector<double> along;
    for (std::size_t kind = 0; kind < BoxAxes::Axis::kinds; ++kind)
      for (int which = 0; which < 3; ++which) {
        const BoxAxes::Axis axis{kind, which};
        along.push_back(axes.overlap(axis));
        CHECK(std::abs(along.back() - overlap(axes.normal(axis))) < 1e-12);
        CHECK(std::abs(axes.opposite(axis) - overlap(-axes.normal(axis))) < 1e-12);
      }
    const BoxAxes::Axis least = axes.least();
    std::sort(along.begin(), along.end());
    CHECK(axes.overlap(least) == along[0]);
    if (!(along[0] > 0.0)) continue;
    for (int k = 0; k < 1000; ++k) CHECK(overlap(some.direction()) >= along[0]);
    CHECK(axes.othersBeyond(least, along[1] * (1 - 1e-9)));
    CHECK_FALSE(axes.othersBeyond(least, along[1] * (1 + 1e-9)));
  }
}

TEST_CASE("What an answer for two boxes proves holds for the maximum on the other side") {
  // Long thin boxes bulge by millimetres, so the nearer side of the vertices' difference need not be the way
  // out.
  Random some(9);
  const StpBv::Ptr a = StpBv::build(box(0.3, 0.2, 0.1), {0.005, 100.0}),
                   b = StpBv::build(needle(0.5, 0.01), {0.005, 10.0});
  for (int i = 0; i < 3000; ++i) {
    const Eigen::Isometry3d still = Eigen::Isometry3d::Identity(),
                            at = fcl_stpbv::test::pose(some.rotation(),
                                                       some.uniform(0, 0.02) * some.direction());
    const Distance d = distance(*a, still, *b, at);
    PairCache cache;
    cache.normal = -d.normal;
    cache.patch = {0, 0};
    const Distance other = distance(*a, still, *b, at, &cache);
    CHECK(d.upper >= other.distance);
    CHECK(other.upper >= d.distance);
  }
}

TEST_CASE("A depth that the certificate proves is known to rounding") {
  Random some(10);
  const StpBv::Ptr a = StpBv::build(geodesicSphere(0.2, 2), {0.01, 10.0}),
                   b = StpBv::build(box(0.3, 0.2, 0.1), {0.01, 10.0});
  int overlaps = 0, tight = 0;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Isometry3d still = fcl_stpbv::test::pose(some.rotation(), some.direction()),
                            at = still * fcl_stpbv::test::pose(some.rotation(), 0.22 * some.direction());
    const Distance d = distance(*a, still, *b, at);
    if (d.status != DistanceStatus::local) continue;
    ++overlaps;
    tight += d.upper - d.lower < 1e-12;  // a hundred roundings of a metre, and of R across the normal
    CHECK(d.upper - d.lower < 1e-3 * -d.distance);
  }
  CHECK(overlaps > 500);
  CHECK(2 * tight > overlaps);
}

TEST_CASE("Thin rods that cross are as deep as they are, whatever R: the bounds meet") {
  // The four vertices of the difference with which the search begins are often in one plane.
  Random random(71);
  for (const double thickness : {1e-6, 1e-4, 1e-3, 1e-2})
    for (const double R : {1.0, 10.0, 1e4})
      for (int i = 0; i < 60; ++i) {
        const auto rod = [&] {
          Cloud cloud;
          for (int k = 0; k < 8; ++k)
            cloud.push_back(random.uniform(-0.3, 0.3) * Vector3d::UnitX() + thickness * random.direction());
          return StpBv::build(cloud, {0.005, R});
        };
        const StpBv::Ptr a = rod(), b = rod();
        const Eigen::Isometry3d at = pose(random.rotation(), random.uniform(0, 0.1) * Vector3d::UnitX());
        const Distance d = distance(*a, Eigen::Isometry3d::Identity(), *b, at);
        if (d.status != DistanceStatus::local) continue;
        CAPTURE(thickness, R, i, d.distance, d.lower, d.upper);
        const auto gap = [&](const Vector3d& n) {
          const Vector3d back = at.linear().transpose() * n;
          return n.dot(at.translation()) - b->support(-back) - a->support(n);
        };
        REQUIRE(std::abs(gap(d.normal) - d.distance) <= 1e-13 * (1 + R));
        // If a bound did not hold, other normals would show it: perpendicular to both rods, and random ones.
        const Vector3d across = Vector3d::UnitX().cross(at.linear().col(0)).normalized();
        for (int k = 0; k < 300; ++k) {
          const Vector3d n = (across + random.uniform(0, 0.3) * random.direction()).normalized();
          REQUIRE(std::max(gap(n), gap(-n)) <= d.upper + 1e-13 * (1 + R));
          REQUIRE(gap(random.direction()) <= d.upper + 1e-13 * (1 + R));
        }
        // Near the smallest R bodies are balls, almost equally deep along all normals, and the search runs
        // out of points. Elsewhere the bounds are 16 ulps of rho apart, for both bodies.
        if (R > 3) REQUIRE(d.upper - d.lower <= 1e-13 + 8e-15 * R);
      }
}

TEST_CASE("Bodies next to their smallest R are almost balls, and as deep as they are: the bounds meet") {
  const std::vector<Cloud> clouds{
      box(0.3, 0.2, 0.1),      plate(0.3, 0.2), cylinder(0.1, 0.3, 32),
      geodesicSphere(0.15, 2), needle(0.5),     randomHull(200, {0.2, 0.15, 0.1}, 3)};
  Random random(72);
  int deep = 0, met = 0;
  for (const double more : {1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 0.1}) {
    std::vector<StpBv::Ptr> volumes;
    // If many corners share a face's ball up to rounding, the support function is off by rounding times this
    // factor.
    const double support = 1e-16 * (1 + more) / std::sqrt(more * (2 + more));
    for (const Cloud& cloud : clouds)
      volumes.push_back(StpBv::build(cloud, {0.01, (1 + more) * StpBv::smallestR(cloud, 0.01)}));
    for (int i = 0; i < 150; ++i) {
      const StpBv &a = *volumes[static_cast<std::size_t>(random.below(6))],
                  &b = *volumes[static_cast<std::size_t>(random.below(6))];
      const Eigen::Isometry3d at = pose(random.below(3) ? random.rotation() : random.rotation(1e-3),
                                        random.uniform(0, 0.15) * random.direction());
      const Distance d = distance(a, Eigen::Isometry3d::Identity(), b, at);
      if (!(d.distance < -0.021)) continue;
      ++deep;
      met += d.upper - d.lower <= 1e-13 + support;
      CAPTURE(more, i, d.distance, d.lower, d.upper);
      // If whole rings of normals are equally good, the polytope runs out of points: up to 3e-4 of the depth
      // in 14,000 of such pairs, less in these.
      REQUIRE(d.upper - d.lower <= 2e-4 * -d.distance);
      const auto gap = [&](const Vector3d& n) {
        return n.dot(at.translation()) - b.support(-(at.linear().transpose() * n)) - a.support(n);
      };
      REQUIRE(std::abs(gap(d.normal) - d.distance) <= 1e-15);
      for (int k = 0; k < 300; ++k) {
        const double off = std::pow(10.0, random.uniform(-6, 1));
        REQUIRE(gap((d.normal + off * random.direction()).normalized()) <= d.upper + 1e-15);
      }
    }
  }
  CHECK(deep > 800);
  CHECK(met >= 0.97 * deep);  // EPA's own triangles meet it in half of them
}
