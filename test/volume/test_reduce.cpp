// Reduced volumes: conservative, within their budget, and of few vertices.
#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/reduce.h"
#include "fcl_stpbv/volume/verify.h"
#include "test/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

TEST_CASE("A reduced volume keeps the margin over all points and the over-cover within its budget") {
  for (const Cloud& cloud : {box(0.2, 0.3, 0.4), cylinder(0.05, 0.4), geodesicSphere(0.2, 2),
                             randomHull(200, {0.3, 0.2, 0.1}, 4)}) {
    const StpBvOptions options{0.01, 10};
    const double own = overCover(*StpBv::build(cloud, options), cloud).max;
    int last = 1000000;
    for (const double budget : {own, own + 0.002, own + 0.005, own + 0.02, 0.5}) {
      const StpBv::Ptr volume = reduce(cloud, options, budget);
      const Verification check = verify(*volume, cloud, options.r);
      INFO(cloud.size() << " points, budget " << budget << ", " << volume->vertexCount()
                        << " vertices: " << check.message);
      CHECK(check.ok);
      CHECK(overCover(*volume, cloud).max <= budget);
      CHECK(volume->vertexCount() <= last);
      last = volume->vertexCount();
    }
    CHECK(last == 1);
  }
}

TEST_CASE("A point or a segment takes the place of a hull where it fits") {
  CHECK(reduce(geodesicSphere(0.2, 3), {0.01, 10}, 0.013)->vertexCount() == 1);
  CHECK(reduce(cylinder(0.02, 0.4), {0.01, 10}, 0.03)->vertexCount() == 2);
}

TEST_CASE("A budget that no volume of these radii can keep is refused with what they give") {
  CHECK_THROWS_WITH(reduce(box(0.2, 0.3, 0.4), {0.01, 10}, 0.0101), Catch::Contains("all points give 0.01"));
}
