// The paper's mapping from closest features of polyhedra to patches (IV.B): how often it names the patches of
// the solver's answer, for bodies near each other and far apart. Overlapping bodies have no features to map.
#include <catch2/catch.hpp>

#include "fcl_stpbv/adapter/feature_map.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

/// Maps features of random pairs, with centres `near` to `far` enclosing radii apart, and counts the results.
MappingCounts countOver(const Cloud& cloud, double near, double far, int queries) {
  const StpBvGeometry g(StpBv::build(cloud, {0.01, 10.0}));
  const double radius = g.volume().enclosingRadius();
  Random random(17);
  MappingCounts counts;
  for (int i = 0; i < queries; ++i) {
    const Eigen::Isometry3d poseA = pose(random.rotation(), random.direction());
    const Eigen::Isometry3d poseB = pose(
        random.rotation(), poseA.translation() + radius * random.uniform(near, far) * random.direction());
    const PolyhedralWitness w = polyhedralWitness(g.hull(), poseA, g.hull(), poseB);
    const std::array<int, 2> mapped = mapFeatures(g, poseA, g, poseB, w);
    PairCache start{w.direction, mapped};
    const Distance d = distance(g.volume(), poseA, g.volume(), poseB, &start);
    REQUIRE(d.status != DistanceStatus::invalid);
    countMapping(g.volume(), poseA, g.volume(), poseB, mapped, d, counts);
  }
  return counts;
}

}  // namespace

TEST_CASE("mapped features are right in all but one of a hundred queries, and then a neighbour is") {
  for (const Cloud& cloud :
       {geodesicSphere(0.2, 2), box(0.2, 0.3, 0.4), randomHull(200, {0.2, 0.2, 0.2}, 3)}) {
    const MappingCounts near = countOver(cloud, 1.9, 3.8, 5000), far = countOver(cloud, 3.8, 19, 5000);
    CHECK(near.total() == 5000);
    CHECK(near.right >= 4850);
    CHECK(near.farther <= 15);
    CHECK(far.right >= 4950);
    CHECK(far.farther <= 5);
  }
}

TEST_CASE("overlapping polyhedra have no features to map") {
  const StpBvGeometry g(StpBv::build(box(0.2, 0.2, 0.2)));
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity(),
                          near = pose(Eigen::Matrix3d::Identity(), {0.1, 0.05, 0});
  const PolyhedralWitness w = polyhedralWitness(g.hull(), here, g.hull(), near);
  CHECK(w.verdict == PolyhedralWitness::Verdict::overlapping);
  CHECK(mapFeatures(g, here, g, near, w) == std::array{-1, -1});
  MappingCounts counts;
  countMapping(g.volume(), here, g.volume(), near, {-1, -1}, distance(g.volume(), here, g.volume(), near),
               counts);
  CHECK(counts.unmapped == 1);
}
