// Distance, normal and witness points against the long double reference.
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/reference.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct Body {
  Cloud cloud;
  double r, R;
  StpBv::Ptr volume;
  Body(Cloud points, double smallRadius, double bigRadius)
      : cloud(std::move(points)),
        r(smallRadius),
        R(bigRadius),
        volume(StpBv::build(cloud, {smallRadius, bigRadius})) {}
};

std::vector<Body> bodies(double R) {
  std::vector<Body> result;
  result.emplace_back(box(0.3, 0.2, 0.5), 0.01, R);
  result.emplace_back(plate(0.4, 0.6), 0.0, R);
  result.emplace_back(needle(0.8), 0.01, R);
  result.emplace_back(cylinder(0.15, 0.4), 0.005, R);
  result.emplace_back(geodesicSphere(0.2, 1), 0.01, R);
  result.emplace_back(randomHull(40, {0.3, 0.2, 0.25}, 7), 0.0, R);
  result.emplace_back(Cloud{Vector3d(0.1, 0, 0)}, 0.02, R);
  result.emplace_back(Cloud{Vector3d(0, 0, -0.2), Vector3d(0.1, 0, 0.2)}, 0.01, R);
  result.emplace_back(Cloud{Vector3d(0.2, 0, 0), Vector3d(-0.1, 0.2, 0), Vector3d(-0.1, -0.2, 0)}, 0.0, R);
  return result;
}

}  // namespace

TEST_CASE(
    "The distance agrees with the reference to 1e-13 m and the normal to 1e-10 rad for bodies of 1 m and R "
    "up "
    "to 100 m") {
  const double R = GENERATE(0.5, 1.0, 10.0, 100.0);
  const std::vector<Body> pool = bodies(R);
  Random random(11);
  double worstDistance = 0, worstNormal = 0, worstPoint = 0;
  for (int i = 0; i < 400; ++i) {
    const Body& a = pool[static_cast<std::size_t>(random.below(static_cast<int>(pool.size())))];
    const Body& b = pool[static_cast<std::size_t>(random.below(static_cast<int>(pool.size())))];
    const Isometry3d poseA = pose(random.rotation(), 0.5 * random.direction());
    const double tilt = random.below(2) ? 1.5 : std::pow(10.0, random.uniform(-12, -1));
    Isometry3d poseB =
        pose(random.rotation(tilt) * poseA.linear(), poseA.translation() + 2.0 * random.direction());
    const Distance far = distance(*a.volume, poseA, *b.volume, poseB);
    // Cores are at least a millimetre apart, because the normal of touching cores has no second digit to
    // compare.
    const double target = 0.001 - a.r - b.r + std::pow(10.0, random.uniform(-4, 0)) * random.below(4);
    poseB.translation() += (target - far.distance) * far.normal;

    const Distance d = distance(*a.volume, poseA, *b.volume, poseB);
    const ReferenceDistance reference =
        referenceDistance(referenceBody(a.cloud, a.r, R, poseA), referenceBody(b.cloud, b.r, R, poseB),
                          far.normal.cast<long double>());
    REQUIRE(reference.gap < 1e-15L);  // the reference proves itself
    REQUIRE(d.status == DistanceStatus::exact);
    const Vector3L n = d.normal.cast<long double>();
    worstDistance = std::max(worstDistance, static_cast<double>(std::abs(d.distance - reference.distance)));
    worstNormal = std::max(worstNormal, static_cast<double>(n.cross(reference.normal).norm()));
    REQUIRE(n.dot(reference.normal) > 0.9L);
    for (std::size_t k = 0; k < 2; ++k)
      worstPoint = std::max(
          worstPoint, static_cast<double>((d.point[k].cast<long double>() - reference.point[k]).norm()));
    CHECK(d.lower <= d.distance);
    CHECK(d.distance <= d.upper);
    CHECK((d.point[1] - d.point[0] - d.distance * d.normal).norm() < 1e-13 * std::max(1.0, R));
  }
  CAPTURE(R, worstDistance, worstNormal, worstPoint);
  CHECK(worstDistance < 1e-13);
  CHECK(worstNormal < 1e-10);
  CHECK(worstPoint <
        // The rounding of a unit vector moves a big sphere's point by R times that.
        1e-13 * std::max(1.0, R));
}
