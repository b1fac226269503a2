// r and R that fit a body: its smallest width, and how little the volume then exceeds the hull.
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/robot/fitted_radii.h"
#include "fcl_stpbv/volume/measure.h"
#include "test/reference/reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

// The smallest width is along the normal of three points, or perpendicular to two pairs of points. All of
// these are tried.
double widthOverAll(const Cloud& points) {
  double least = 1e300;
  const auto width = [&](const Vector3d& direction) {
    if (!(direction.norm() > 1e-12)) return;
    const Vector3d n = direction.normalized();
    double low = 1e300, high = -1e300;
    for (const Vector3d& p : points) {
      low = std::min(low, n.dot(p));
      high = std::max(high, n.dot(p));
    }
    least = std::min(least, high - low);
  };
  std::vector<Vector3d> edges;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) edges.push_back(points[i] - points[j]);
  for (std::size_t e = 0; e < edges.size(); ++e)
    for (std::size_t f = 0; f < e; ++f) width(edges[e].cross(edges[f]));
  return least;
}

}  // namespace

TEST_CASE("the smallest width is that of the best of all directions, and never more") {
  Random random(5);
  for (int round = 0; round < 60; ++round) {
    const Vector3d half(random.uniform(0.002, 0.3), random.uniform(0.002, 0.3), random.uniform(0.002, 0.3));
    Cloud points = round % 3 == 0 ? box(half.x(), half.y(), half.z())
                                  : randomHull(5 + random.below(10), half, static_cast<std::uint64_t>(round));
    const Eigen::Isometry3d placed = pose(random.rotation(), Vector3d(1, -2, 0.5));
    for (Vector3d& p : points) p = placed * p;
    const double width = widthOverAll(points), found = sizeOf(points).width;
    CHECK(found <= width + 1e-14);  // a few roundings of coordinates of 1 m
    CHECK(found >= width * (1 - 1e-6) - 1e-14);
  }
}

TEST_CASE("finer bodies, thin ones and flat ones have a width as well") {
  const BodySize round = sizeOf(geodesicSphere(0.1, 3));
  CHECK(round.width <= 0.2);
  CHECK(round.width > 0.19);
  CHECK(round.ball == Approx(0.1).epsilon(1e-9));
  CHECK(sizeOf(plate(0.3, 0.2, 1e-3)).width == Approx(1e-3).epsilon(1e-6));
  for (const Cloud& flat : {plate(0.3, 0.2, 0), Cloud{{0, 0, 0}, {0.3, 0, 0}}, Cloud{{0.1, 0.2, 0.3}}})
    CHECK(sizeOf(flat).width < 1e-15);
}

TEST_CASE("fitted radii keep r to a twentieth of the width and the bulge to r, or to 1/200 of the ball") {
  Random random(6);
  for (int round = 0; round < 60; ++round) {
    const double scale = std::pow(10, random.uniform(-2, 1));
    const Vector3d half(scale * std::pow(10, random.uniform(-2.5, 0)), scale * random.uniform(0.1, 1), scale);
    const Cloud points = round % 2 == 0
                             ? box(2 * half.x(), 2 * half.y(), 2 * half.z())
                             : randomHull(4 + random.below(60), half, static_cast<std::uint64_t>(round));
    const BodySize size = sizeOf(points);
    const StpBvOptions radii = fittedRadii(size);
    INFO("width " << size.width << ", ball " << size.ball << ", r " << radii.r << ", R " << radii.R);
    CHECK(radii.r <= std::min(0.01, std::max(size.width / 20, size.ball / 250)) * (1 + 1e-15));
    CHECK(radii.r > 0);
    const StpBv::Ptr volume = StpBv::build(points, radii);
    const double most = radii.r + std::max(radii.r, size.ball / 200) * (1 + 1e-9);
    CHECK(overCover(*volume, points).max <= most);
    const ReferenceBody body = referenceBody(points, radii.r, radii.R);
    for (int k = 0; k < 50; ++k) {
      const Vector3d n = random.direction();
      double hull = -1e300;
      for (const Vector3d& p : points) hull = std::max(hull, n.dot(p));
      CHECK(static_cast<double>(referenceSupport(body, n.cast<long double>())) - hull <= most);
    }
  }
  CHECK(fittedRadii({0.02, 0.05}).r == Approx(0.001));
  CHECK(fittedRadii({0.5, 0.5}).r == 0.01);
  CHECK(fittedRadii({0, 0}).R == 10);
}
