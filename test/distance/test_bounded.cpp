// Answers that are not solved to rounding: which extremes are needed for them, and that their bounds hold.
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/reference.h"
#include "test/reference/shapes.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct Covered {
  Cloud cloud;
  StpBvOptions radii;
  StpBv::Ptr volume;
};

Covered make(Cloud cloud, double r, double R) {
  const StpBvOptions radii{r, R};
  StpBv::Ptr volume = StpBv::build(cloud, radii);
  return {std::move(cloud), radii, std::move(volume)};
}

struct Outcome {
  int exact = 0, bounded = 0;
  double widest = 0;  // width between the bounds (m)
};

// Checks pairs at gaps of the cores from 1 m down to 1e-18 m, at turns of all sizes, against the long double
// reference.
Outcome check(const std::vector<Covered>& first, const std::vector<Covered>& second, int count) {
  Random random(1);
  Outcome outcome;
  for (int i = 0; i < count; ++i) {
    const Covered& a = first[static_cast<std::size_t>(random.below(static_cast<int>(first.size())))];
    const Covered& b = second[static_cast<std::size_t>(random.below(static_cast<int>(second.size())))];
    const Vector3d towards = random.below(2) ? random.direction() : Vector3d(Vector3d::Unit(random.below(3)));
    Isometry3d at = pose(Eigen::Matrix3d::Identity(), 2 * towards);
    const int turn = random.below(3);
    if (turn == 1) at.linear() = random.rotation(std::pow(10, -random.uniform(1, 16)));
    if (turn == 2) at.linear() = random.rotation();
    const double gap = std::pow(10, -random.uniform(0, 18)) - a.radii.r - b.radii.r;
    for (int round = 0; round < 4; ++round) {
      const Distance d = distance(*a.volume, Isometry3d::Identity(), *b.volume, at);
      at.translation() += (gap - d.distance) * d.normal;
    }
    PairCache cache;
    if (random.below(2)) cache.normal = random.direction();
    const Distance d = distance(*a.volume, Isometry3d::Identity(), *b.volume, at, &cache);
    CHECK((d.lower <= d.distance && d.distance <= d.upper));
    if (d.status != DistanceStatus::exact && d.status != DistanceStatus::bounded) continue;
    ++(d.status == DistanceStatus::exact ? outcome.exact : outcome.bounded);
    outcome.widest = std::max(outcome.widest, d.upper - d.lower);
    // The other exact answers are tested elsewhere.
    if (d.status == DistanceStatus::exact && i % 20 != 0) continue;
    CAPTURE(i, a.cloud.size(), a.radii.R, b.cloud.size(), b.radii.R);
    const ReferenceBody x = referenceBody(a.cloud, a.radii.r, a.radii.R),
                        y = referenceBody(b.cloud, b.radii.r, b.radii.R, at);
    const ReferenceDistance truth = referenceDistance(x, y, d.normal.cast<long double>());
    // A few roundings of the placed points in double, and the reference's own rounding of R in long double.
    const long double rounding = 4e-15L + 1e-18L * static_cast<long double>(a.radii.R + b.radii.R);
    CHECK(d.lower <= referenceGap(x, y, d.normal.cast<long double>().normalized()) + rounding);
    if (!std::isfinite(truth.distance))
      continue;  // the cores touch to rounding, so the reference finds no gap between them
    CHECK(d.lower <= truth.distance + truth.gap + rounding);
    CHECK(d.upper >= truth.distance - rounding);
  }
  return outcome;
}

}  // namespace

TEST_CASE(
    "Where regions of normals are as narrow as rounding an answer may be bounded, and the bounds hold") {
  const Cloud speck = box(1e-4, 1e-4, 1e-4);  // at R = 1e10 m the regions of its faces are 1e-14 rad wide
  const std::vector<Covered> narrow{make(speck, 0, 1e10), make(speck, 1e-3, 1e10), make(speck, 0.01, 1e8)};
  const std::vector<Covered> others{make(box(0.2, 0.3, 0.4), 0, 10),    make(plate(0.3, 0.2), 0, 0.2),
                                    make(needle(0.5), 1e-3, 0.26),      make(cylinder(0.1, 0.3), 0.01, 1),
                                    make(geodesicSphere(0.2, 1), 0, 1), make({{0, 0, 0}}, 1e-3, 10)};
  const Outcome outcome = check(narrow, others, 6000);
  INFO(outcome.exact << " exact, " << outcome.bounded << " bounded, by up to " << outcome.widest << " m");
  CHECK(outcome.exact > 5000);
  CHECK(outcome.bounded > 0);    // otherwise the test would check nothing
  CHECK(outcome.widest < 2e-4);  // the speck's own size
}

TEST_CASE("Up to R = 1e6 m no answer is bounded: boxes, plates, flat clouds and near-duplicates at any gap") {
  Cloud twins = box(0.2, 0.2, 0.2);
  Random random(2);
  for (std::size_t i = 0; i < 8; ++i) twins.push_back(twins[i] + 1e-8 * random.direction());
  Cloud flat = randomHull(30, {0.3, 0.2, 0.1}, 5);
  for (Vector3d& p : flat) p.z() = 0;
  std::vector<Covered> all;
  for (const Cloud& cloud :
       {twins, flat, box(0.2, 0.3, 0.4), plate(0.3, 0.2), needle(0.5), geodesicSphere(0.2, 1)})
    for (const double r : {0.0, 0.01})
      for (const double R : {1.2 * StpBv::smallestR(cloud, r), 10.0, 1e3, 1e6})
        all.push_back(make(cloud, r, R));
  const Outcome outcome = check(all, all, trials(20000));
  CHECK(outcome.exact > trials(15000));
  CHECK(outcome.bounded == 0);
}
