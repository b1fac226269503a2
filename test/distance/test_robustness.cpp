// Extreme input that a query must handle.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/volume/patch_view.h"
#include "test/reference/reference.h"
#include "test/reference/shapes.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

const Isometry3d kOrigin = Isometry3d::Identity();

bool finiteAnswer(const Distance& d) {
  return std::isfinite(d.distance) && std::isfinite(d.lower) && std::isfinite(d.upper) &&
         d.normal.allFinite() && d.point[0].allFinite() && d.point[1].allFinite() &&
         std::abs(d.normal.norm() - 1) < 1e-14;
}

}  // namespace

TEST_CASE("Swapped arguments give the mirrored answer") {
  Random random(3);
  const double R = GENERATE(1.0, 10.0, 1000.0);
  const StpBv::Ptr a = StpBv::build(randomHull(50, {0.2, 0.1, 0.3}, 1), {0.01, R});
  const StpBv::Ptr b = StpBv::build(cylinder(0.1, 0.3), {0.005, R});
  for (int i = 0; i < 200; ++i) {
    const Isometry3d pa = pose(random.rotation(), random.direction());
    Isometry3d pb = pose(random.rotation(), 3 * random.direction());
    const Distance far = distance(*a, pa, *b, pb);
    pb.translation() += (random.uniform(-0.01, 0.5) - far.distance) * far.normal;
    const Distance d = distance(*a, pa, *b, pb), e = distance(*b, pb, *a, pa);
    REQUIRE(d.status == DistanceStatus::exact);
    REQUIRE(e.status == DistanceStatus::exact);
    CHECK(std::abs(d.distance - e.distance) < 1e-14);
    CHECK((d.normal + e.normal).norm() < 1e-12 * R);
    CHECK((d.point[0] - e.point[1]).norm() < 1e-13 * R);
    CHECK((d.point[1] - e.point[0]).norm() < 1e-13 * R);
  }
}

TEST_CASE("A remembered start never changes the answer") {
  Random random(8);
  const double R = GENERATE(1.0, 10.0, 1000.0);
  const StpBv::Ptr a = StpBv::build(geodesicSphere(0.2, 2), {0.01, R});
  const StpBv::Ptr b = StpBv::build(box(0.3, 0.2, 0.4), {0.01, R});
  PairCache cache;
  Vector3d centre(0.6, 0, 0);
  Matrix3d rotation = Matrix3d::Identity();
  for (int i = 0; i < 500; ++i) {
    rotation = random.rotation(i % 10 == 0 ? 1.0 : 0.01) * rotation;
    // Deep in some cases.
    centre = (centre + 0.01 * random.direction()).normalized() * random.uniform(0.2, 0.8);
    const Isometry3d pb = pose(rotation, centre);
    const Distance warm = distance(*a, kOrigin, *b, pb, &cache), cold = distance(*a, kOrigin, *b, pb);
    CHECK(warm.status == cold.status);
    CHECK(std::abs(warm.distance - cold.distance) < 1e-14);
    CHECK((warm.normal - cold.normal).norm() < 1e-12 * R);
  }
}

TEST_CASE("A cache filled with nonsense is harmless") {
  const StpBv::Ptr a = StpBv::build(box(0.3, 0.2, 0.5), {0.01, 10}),
                   b = StpBv::build(needle(0.5), {0.01, 10});
  const Isometry3d pb = at(0.5, 0.1, 0.2);
  const Distance cold = distance(*a, kOrigin, *b, pb);
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const std::vector<Vector3d> normals{Vector3d(nan, 0, 0),    Vector3d(inf, 0, 0), Vector3d(0, 0, 0),
                                      Vector3d(1e-300, 0, 0), Vector3d(-1, 0, 0),  Vector3d(0, 1e200, 0),
                                      Vector3d(0, 0, 1)};
  const std::vector<std::array<int, 2>> patches{
      {-1, -1}, {0, 0}, {1000000, 3}, {3, 1000000}, {-5, 7}, {2, -1000000}, {2147483647, -2147483647 - 1}};
  for (const Vector3d& n : normals)
    for (const auto& p : patches) {
      PairCache cache;
      cache.normal = n;
      cache.patch = p;
      const Distance d = distance(*a, kOrigin, *b, pb, &cache);
      CHECK(d.status == DistanceStatus::exact);
      CHECK(std::abs(d.distance - cold.distance) < 1e-15);
      CHECK((d.normal - cold.normal).norm() < 1e-12);
    }
}

TEST_CASE("A pose that is not a finite rotation and translation is reported, not answered") {
  const StpBv::Ptr a = StpBv::build(box(0.3, 0.2, 0.5), {0.01, 10});
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  std::vector<Isometry3d> bad(8, at(1, 0, 0));
  bad[0].translation().x() = nan;
  bad[1].translation().y() = inf;
  bad[2].linear()(1, 2) = nan;
  bad[3].linear()(0, 0) = -inf;
  bad[4].linear().setZero();
  bad[5].linear() *= 2.0;
  bad[6].translation().z() = 1e151;
  bad[7].translation().x() = 1e300;
  for (const Isometry3d& p : bad) {
    PairCache cache;
    cache.normal = Vector3d::UnitX();
    cache.patch = {1, 1};
    for (const Distance& d : {distance(*a, p, *a, kOrigin, &cache), distance(*a, kOrigin, *a, p, &cache),
                              distance(*a, p, *a, p, &cache)}) {
      CHECK(d.status == DistanceStatus::invalid);
      CHECK(std::string(toString(d.status)) == "invalid");
      CHECK(d.distance == -inf);
      CHECK(d.normal == Vector3d::Zero());
      CHECK(d.lower == -inf);
      CHECK(d.upper == inf);
    }
    CHECK(cache.normal == Vector3d::UnitX());
  }
}

TEST_CASE("Rotation matrices off by 1e-6 give the answer of a rotation next to them") {
  Random random(21);
  const StpBv::Ptr a = StpBv::build(box(0.3, 0.2, 0.5), {0.01, 10}),
                   b = StpBv::build(cylinder(0.1, 0.3), {0.0, 10});
  for (int i = 0; i < 100; ++i) {
    const Isometry3d pa = pose(random.rotation(), 0.3 * random.direction());
    const Isometry3d pb = pose(random.rotation(), pa.translation() + 0.9 * random.direction());
    Isometry3d qa = pa, qb = pb;
    for (int k = 0; k < 9; ++k) {
      qa.linear()(k / 3, k % 3) += random.uniform(-1e-6, 1e-6);
      qb.linear()(k / 3, k % 3) += random.uniform(-1e-6, 1e-6);
    }
    const Distance exact = distance(*a, pa, *b, pb), off = distance(*a, qa, *b, qb);
    CHECK(off.status == DistanceStatus::exact);
    CHECK(finiteAnswer(off));
    CHECK(std::abs(off.distance - exact.distance) < 5e-6);
  }
}

TEST_CASE("Far from the world's origin the answer is that of the same pair at the origin") {
  Random random(4);
  const double away = GENERATE(1e3, 1e6);
  const double R = GENERATE(1.0, 100.0, 1e6);
  const StpBv::Ptr a = StpBv::build(box(0.3, 0.2, 0.5), {0.01, R}),
                   b = StpBv::build(cylinder(0.1, 0.3), {0.0, R});
  for (int i = 0; i < 50; ++i) {
    // Translations that are exact at both places.
    const Vector3d offset = (away * random.direction()).array().round();
    const Vector3d apart = (0x1p20 * 0.6 * random.direction()).array().round() * 0x1p-20;
    const Matrix3d qa = random.rotation(), qb = random.rotation();
    const Distance near = distance(*a, pose(qa, Vector3d::Zero()), *b, pose(qb, apart));
    const Distance far = distance(*a, pose(qa, offset), *b, pose(qb, offset + apart));
    CHECK(far.status == near.status);
    CHECK(far.distance == near.distance);
    CHECK(far.normal == near.normal);
    CHECK((far.point[0] - offset - near.point[0]).norm() < 1e-15 * away);
    CHECK((far.point[1] - offset - near.point[1]).norm() < 1e-15 * away);
  }
}

TEST_CASE("A million metres apart the distance is exact to the rounding of that length") {
  const StpBv::Ptr a = StpBv::build(box(0.3, 0.2, 0.5), {0.01, 10});
  const Distance d = distance(*a, kOrigin, *a, at(1e6, 0, 0));
  CHECK(d.status == DistanceStatus::exact);
  // Faces bulge by R - sqrt(rho^2 - rc^2) beyond the box (docs/theory.md, 4).
  const double rho = 9.99, rc2 = 0.01 + 0.0625, bulge = 0.01 + rc2 / (rho + std::sqrt(rho * rho - rc2));
  CHECK(std::abs(d.distance - (1e6 - 0.3 - 2 * bulge)) < 1e-9);
}

TEST_CASE("Big radii from just above the smallest to a million metres are solved to rounding") {
  Random random(6);
  for (const Cloud& cloud : {box(0.3, 0.2, 0.5), cylinder(0.15, 0.4), randomHull(60, {0.2, 0.3, 0.1}, 4),
                             Cloud{Vector3d(0, 0, -0.2), Vector3d(0.1, 0, 0.2)}}) {
    const double smallest = StpBv::smallestR(cloud, 0.01);
    for (const double R : {smallest * (1 + 1e-9), smallest * (1 + 1e-6), smallest * 1.001, 1e3, 1e6}) {
      const StpBv::Ptr a = StpBv::build(cloud, {0.01, R}), b = StpBv::build(box(0.1, 0.2, 0.1), {0.0, R});
      // If many corners share a face's ball up to rounding, the support function is off by rounding times
      // this factor.
      const double rho = R - 0.01, ball = smallest - 0.01;
      const double support = 1e-16 * rho / std::sqrt((rho - ball) * (rho + ball));
      for (int i = 0; i < trials(40); ++i) {
        const Isometry3d pa = pose(random.rotation(), Vector3d::Zero());
        const Isometry3d pb = pose(random.rotation(), 0.7 * random.direction());
        const Distance d = distance(*a, pa, *b, pb);
        REQUIRE(d.status == DistanceStatus::exact);
        CHECK(d.upper - d.lower < 1e-13 + 1e-16 * R + support);
        const ReferenceDistance reference =
            referenceDistance(referenceBody(cloud, 0.01, R, pa),
                              referenceBody(box(0.1, 0.2, 0.1), 0.0, R, pb), d.normal.cast<long double>());
        const double error = static_cast<double>(std::abs(d.distance - reference.distance));
        CAPTURE(R, smallest, cloud.size(), error, static_cast<double>(reference.gap), d.distance);
        CHECK(error < 1e-13 + 1e-18 * R);
      }
    }
  }
}

TEST_CASE("Two spheres are exact at any depth, and coincident ones still have a unit normal") {
  const StpBv::Ptr a = StpBv::build({Vector3d(0, 0, 0)}, {0.1, 1}),
                   b = StpBv::build({Vector3d(0, 0, 0)}, {0.2, 5});
  for (const double x : {1.0, 0.3, 0.2, 1e-3, 1e-12, 0.0}) {
    const Distance d = distance(*a, kOrigin, *b, at(x, 0, 0));
    CHECK(d.status == DistanceStatus::exact);
    CHECK(d.distance == Approx(x - 0.3).margin(1e-16));
    CHECK(finiteAnswer(d));
    CHECK((d.point[1] - d.point[0] - d.distance * d.normal).norm() < 1e-15);
  }
}

TEST_CASE("Bodies deep in each other get a finite local answer that separates them") {
  const double R = GENERATE(1.0, 10.0, 100.0);
  const std::vector<Cloud> clouds{box(0.3, 0.2, 0.5), randomHull(50, {0.3, 0.3, 0.3}, 9), plate(0.4, 0.4),
                                  cylinder(0.1, 0.5)};
  Random random(13);
  int best = 0, all = 0;
  for (const Cloud& ca : clouds)
    for (const Cloud& cb : clouds) {
      const StpBv::Ptr a = StpBv::build(ca, {0.01, R}), b = StpBv::build(cb, {0.0, R});
      for (int i = 0; i < 4; ++i) {
        const Isometry3d pa = pose(random.rotation(), Vector3d::Zero());
        Isometry3d pb = pose(random.rotation(), i * 0.02 * random.direction());
        const Distance d = distance(*a, pa, *b, pb);
        REQUIRE(finiteAnswer(d));
        REQUIRE(d.status == DistanceStatus::local);
        const double rounded = 2 * kGapRounding * 2;  // outward, for a sum of sizes and distances of 2 m
        CHECK(d.upper <= -0.01 + 1e-15 + rounded);
        CHECK(d.lower <= d.upper);
        CHECK((d.lower <= d.distance && d.distance - d.lower <= rounded));
        // The answer is a true lower bound, a local maximum, and nearly always as good as the best of many
        // directions.
        const ReferenceBody ra = referenceBody(ca, 0.01, R, pa), rb = referenceBody(cb, 0.0, R, pb);
        const Vector3L n = d.normal.cast<long double>();
        CHECK(std::abs(static_cast<double>(referenceGap(ra, rb, n) - d.distance)) < 1e-13);
        for (int k = 0; k < 20; ++k) {
          const Vector3L nearby = (n + 1e-4L * random.direction().cast<long double>()).normalized();
          CHECK(static_cast<double>(referenceGap(ra, rb, nearby)) <= d.distance + 1e-13);
        }
        // No direction has a wider gap than the upper bound.
        CHECK(static_cast<double>(widestGapOverDirections(ra, rb, 1000)) <= d.upper + 1e-12);
        ++all;
        best += static_cast<double>(widestGapOverDirections(ra, rb, 1000)) <= d.distance + 1e-12;
        // The translation of the answer separates the bodies.
        pb.translation() += (1e-6 - d.distance) * d.normal;
        CHECK(distance(*a, pa, *b, pb).distance >= 1e-6 - 1e-13);
      }
    }
  CHECK(best == all);
}

TEST_CASE("Identical bodies in the same pose are answered") {
  for (const Cloud& cloud : {box(0.3, 0.2, 0.5), geodesicSphere(0.2, 1), plate(0.3, 0.3),
                             Cloud{Vector3d(0, 0, -0.2), Vector3d(0.1, 0, 0.2)}}) {
    const StpBv::Ptr a = StpBv::build(cloud, {0.01, 10});
    const Distance d = distance(*a, kOrigin, *a, kOrigin);
    CHECK(finiteAnswer(d));
    CHECK(d.status != DistanceStatus::invalid);
    CHECK(d.distance <= -0.02 + 1e-15);
  }
}

TEST_CASE("Without margins contact is exact, whatever touches whatever") {
  const double R = GENERATE(1.0, 100.0, 1e6);
  const StpBv::Ptr a = StpBv::build(box(0.2, 0.2, 0.2), {0.0, R}),
                   b = StpBv::build(geodesicSphere(0.1, 1), {0.0, R});
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    const Isometry3d pa = pose(random.rotation(), Vector3d::Zero());
    Isometry3d pb = pose(random.rotation(), random.direction());
    const Distance far = distance(*a, pa, *b, pb);
    pb.translation() -= far.distance * far.normal;
    const Distance d = distance(*a, pa, *b, pb);
    CHECK(finiteAnswer(d));
    CHECK(std::abs(d.distance) < 1e-14);
    CHECK(std::abs(d.upper) < 1e-14 + 1e-14 * R + 2 * kGapRounding * 3);
  }
}

TEST_CASE("The band of an edge 2 mm long at R = 1e6 m, 2e-9 rad wide, is found from any memory") {
  const StpBv::Ptr a = StpBv::build({Vector3d(0, 0, 0)}, {0.01, 1e6}),
                   b = StpBv::build(needle(0.8), {0.01, 1e6});
  Random random(4);
  for (int i = 0; i < 20000; ++i) {
    const int e = random.below(b->edgeCount());
    const StpBv::Edge& edge = b->edges()[static_cast<std::size_t>(e)];
    const Patch patch = b->patch(b->edgePatch(e));
    const double length = (b->vertices()[static_cast<std::size_t>(edge.vertex[0])] -
                           b->vertices()[static_cast<std::size_t>(edge.vertex[1])])
                              .norm();
    // A normal of this edge, and the point where it is the surface's normal.
    const double mix = random.uniform(0.01, 0.99);
    Vector3d n =
        mix * b->corner(edge.face[0], edge.vertex[0]) + (1 - mix) * b->corner(edge.face[1], edge.vertex[0]);
    n -= n.dot(patch.axis) * patch.axis;
    const double side = (random.below(2) ? 0.5 : -0.5) * (1 - std::pow(10.0, random.uniform(-6, 0)));
    n = (n.normalized() + side * length / b->radii().rho * patch.axis).normalized();
    const double apart = std::pow(10.0, random.uniform(-3, 0));
    Isometry3d pa = kOrigin;
    pa.translation() = corePoint(*b, b->edgePatch(e), n) + (apart + 0.02) * n;
    PairCache cache;
    cache.normal = random.rotation(random.below(2) ? 0.02 : 0.4) * -n;
    cache.patch = {0, b->owner(-cache.normal)};
    const Distance d = distance(*a, pa, *b, kOrigin, &cache);
    CHECK(d.status == DistanceStatus::exact);
    CHECK(std::abs(d.distance - apart) < 1e-14);  // a dozen operations with coordinates of 1 m
  }
}
