// Reduced volumes: conservative, within their budget, and with few vertices.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "test/reference/shapes.h"

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

TEST_CASE("Next to the smallest R the volume of all points serves where those of fewer cannot be built") {
  for (const Cloud& cloud : {box(0.2, 0.2, 0.2), box(0.2, 0.4, 1.0), box(0.6, 0.8, 1.0)}) {
    const double r = 0.01, R = std::nextafter(StpBv::smallestR(cloud, r), 10.0);
    const double own = overCover(*StpBv::build(cloud, {r, R})).max;
    for (const double budget : {own, 1.5 * own}) {
      StpBv::Ptr volume;
      REQUIRE_NOTHROW(volume = reduce(cloud, {r, R}, budget));
      CHECK(verify(*volume, cloud, r).ok);
    }
  }
}

TEST_CASE("A budget that no volume of these radii can keep is refused with what they give") {
  CHECK_THROWS_WITH(reduce(box(0.2, 0.3, 0.4), {0.01, 10}, 0.0101), Catch::Contains("all points give 0.01"));
}

namespace {

// Whether the volume of these vertices keeps the budget, when r grows until the volume covers the cloud with
// the margin.
bool keeps(const Cloud& cloud, const Cloud& vertices, const StpBvOptions& options, double budget) {
  StpBvOptions grown = options;
  while (grown.r <= budget && grown.R > StpBv::smallestR(vertices, grown.r)) {
    const StpBv::Ptr volume = StpBv::build(vertices, grown);
    double height = -1;
    for (const Vector3d& p : cloud) height = std::max(height, signedDistance(*volume, p) + options.r);
    if (height <= 0) return overCover(*volume, cloud).max <= budget;
    grown.r += height + 1e-15;
  }
  return false;
}

// The smallest number of the cloud's own points that is enough, by trying all subsets.
int fewest(const Cloud& cloud, const StpBvOptions& options, double budget) {
  int best = static_cast<int>(cloud.size());
  for (unsigned subset = 1; subset < 1u << cloud.size(); ++subset) {
    Cloud vertices;
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if (subset >> i & 1) vertices.push_back(cloud[i]);
    const int count = static_cast<int>(vertices.size());
    if (count < best && keeps(cloud, vertices, options, budget)) best = count;
  }
  return best;
}

}  // namespace

TEST_CASE("On small hulls a reduced volume has the fewest vertices in most cases and never two too many") {
  const StpBvOptions options{0.01, 10};
  int cases = 0, exact = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Cloud cloud = randomHull(8, {0.3, 0.2, 0.1}, seed);
    const double own = overCover(*StpBv::build(cloud, options), cloud).max;
    for (const double extra : {0.005, 0.02, 0.05, 0.1}) {
      const int found = reduce(cloud, options, own + extra)->vertexCount();
      const int best = fewest(cloud, options, own + extra);
      INFO("seed " << seed << ", budget " << own + extra);
      CHECK(found <= best + 1);
      exact += found <= best;  // a point or a segment that does not belong to the cloud may need fewer
      ++cases;
    }
  }
  CHECK(exact >= cases - 2);
}
