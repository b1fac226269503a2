// The bounds of an answer contain the true value exactly as they are, and poses are checked one by one.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "fcl_stpbv/distance/distance.h"
#include "test/distance/enclosure.h"
#include "test/reference/reference.h"
#include "test/reference/shape_reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

Cloud scaled(Cloud cloud, double scale) {
  for (Vector3d& p : cloud) p *= scale;
  return cloud;
}

/// The pair with the first body's origin as the world's origin, for long double. Far from the world's origin
/// only the difference of the origins matters, and it is exact there.
Isometry3d seenFrom(const Isometry3d& a, Isometry3d b) {
  b.translation() -= a.translation();
  return b;
}

Isometry3d turnOnly(const Isometry3d& a) { return pose(a.linear(), Vector3d::Zero()); }

/// Checks both bounds against the true value, which is known to `slack`.
void checkHolds(const Distance& d, long double truth, long double alongNormal, long double slack) {
  CHECK(d.lower <= truth + slack);
  CHECK(d.upper >= truth - slack);
  CHECK(d.lower <= alongNormal + slack);
  CHECK((d.lower <= d.distance && d.distance <= d.upper));
}

/// Checks that the bounds contain the true value. @returns true if that is known to a tenth of their width.
template <class Real>
bool holds(const Distance& d, const Enclosure<Real>& truth) {
  CHECK(truth.holdsLower(d.lower));
  CHECK(truth.holdsUpper(d.upper));
  CHECK((d.lower <= d.distance && d.distance <= d.upper));
  return truth.width() <= 0.1 * (d.upper - d.lower);
}

}  // namespace

TEST_CASE(
    "lower <= truth <= upper for two volumes of any scale, without margin, with a huge R, far from the "
    "origin") {
  Random random(17);
  int exact = 0, known = 0;
  for (const double scale : {1e-6, 1e-2, 1.0, 1e6})
    for (const double R : {0.6, 10.0, 1e4, 1e8})
      for (const double r : {0.0, 0.01}) {
        const Cloud cloudA = scaled(randomHull(30, {0.2, 0.1, 0.3}, 1), scale),
                    cloudB = scaled(cylinder(0.1, 0.3), scale);
        const StpBv::Ptr a = StpBv::build(cloudA, {r * scale, R * scale}),
                         b = StpBv::build(cloudB, {0.0, R * scale});
        for (int i = 0; i < 40; ++i) {
          const Vector3d away =
              i % 4 == 0 ? Vector3d(1e4 * random.direction()) : Vector3d(scale * random.direction());
          const Isometry3d pa = pose(random.rotation(), away);
          Isometry3d pb = pose(random.rotation(), away + 2 * scale * random.direction());
          const Distance far = distance(*a, pa, *b, pb);
          const double gap = random.below(3) ? scale * std::pow(10, -random.uniform(0, 9)) : -0.5 * r * scale;
          pb.translation() += (gap - far.distance) * far.normal;
          const Distance d = distance(*a, pa, *b, pb), e = distance(*b, pb, *a, pa);
          if (d.status != DistanceStatus::exact)
            continue;  // 10 km away, a pair of micrometres may end up in any position
          CAPTURE(scale, R, r, i);
          const double fine = 0.02 * (d.upper - d.lower);
          const Placed x{cloudA, r * scale, R * scale, pa}, y{cloudB, 0.0, R * scale, pb};
          // A search in 113 bits takes long. Along the normal alone, the true value is nearly always known as
          // well.
          if (roundings<long double>(2 * R * scale + 4 * scale) <= fine)
            known += holds(d, enclose<long double>(d, x, y, fine, true));
          else
            known += holds(d, enclose<Quad>(d, x, y, fine, i % 20 == 0));
          ++exact;
          CHECK((e.lower <= d.upper && d.lower <= e.upper));
        }
      }
  CHECK(known >= 0.85 * exact);  // for the rest, the true value is known less accurately
}

TEST_CASE(
    "lower <= truth <= upper next to the smallest R, where a face's many corners are on its ball to "
    "rounding") {
  Random random(29);
  const Cloud rod = needle(0.5);
  const StpBv::Ptr other = StpBv::build(rod, {0.0, 1.0});
  int known = 0, all = 0;
  for (const Cloud& flat :
       {plate(0.9, 0.6), Cloud{{-0.9, -0.6, 0}, {0.9, -0.6, 0}, {0.9, 0.6, 0}, {-0.9, 0.6, 0}},
        cylinder(0.3, 0.1), cylinder(0.1, 0.4)})
    for (const double above : {1e-10, 1e-9, 1e-7, 1e-4})
      for (int i = 0; i < 6; ++i) {
        const Isometry3d turn = pose(random.rotation(), random.direction());
        Cloud cloud = flat;
        for (Vector3d& p : cloud) p = turn * p;
        const double R = StpBv::smallestR(cloud, 0.0) + above;
        const StpBv::Ptr volume = StpBv::build(cloud, {0.0, R});
        const Isometry3d pa = Isometry3d::Identity(),
                         pb = pose(random.rotation(), turn.translation() + 3 * (turn.linear().col(2) +
                                                                                0.1 * random.direction()));
        CAPTURE(flat.size(), above, i);
        const Distance d = distance(*volume, pa, *other, pb);
        REQUIRE(d.status == DistanceStatus::exact);
        known += holds(
            d, enclose<Quad>(d, {cloud, 0.0, R, pa}, {rod, 0.0, 1.0, pb}, 0.02 * (d.upper - d.lower), true));
        ++all;
        const Distance point = distance(*volume, pa, Vector3d(pb.translation()));
        holds(point, enclose<Quad>(point, {cloud, 0.0, R, pa}, {Cloud{pb.translation()}, 0.0, 1.0, pa}, 1e-17,
                                   true));
      }
  CHECK(known == all);
}

TEST_CASE("lower <= truth <= upper for a volume and each shape, and for each two shapes") {
  Random random(23);
  const Cloud cloud = box(0.3, 0.2, 0.1);
  const StpBv::Ptr volume = StpBv::build(cloud, {0.01, 10});
  for (const std::string& first : boundedShapes())
    for (const std::string& second : boundedShapes())
      for (int i = 0; i < 12; ++i) {
        CAPTURE(first, second, i);
        const TestShape p = randomShape(first, random), q = randomShape(second, random);
        const Isometry3d pa = pose(random.rotation(), random.direction());
        Isometry3d pb = pose(random.rotation(), pa.translation() + 3 * random.direction());
        const double gap = std::pow(10, -random.uniform(0, 6));
        for (int k = 0; k < 3; ++k) {
          const Distance far = distance(p.shape, pa, q.shape, pb);
          pb.translation() += (gap - far.distance) * far.normal;
        }
        const Distance d = distance(p.shape, pa, q.shape, pb), e = distance(q.shape, pb, p.shape, pa);
        const ReferenceShape x = p.posed(turnOnly(pa)), y = q.posed(seenFrom(pa, pb));
        const Vector3L n = d.normal.cast<long double>().normalized();
        // When the reference stops halving, the last digits of a long double are uncertain.
        constexpr long double kReference = 2e-17L;
        checkHolds(d, referenceDistance(x, y, n).distance, referenceGap(x, y, n), kReference);
        CHECK((e.lower == d.lower && e.upper == d.upper && e.distance == d.distance));
        CHECK(d.status == DistanceStatus::exact);
        CHECK(std::abs(static_cast<double>(d.distance - referenceDistance(x, y, n).distance)) <= 1e-14);

        const Distance v = distance(*volume, pa, q.shape, pb);
        if (v.status != DistanceStatus::exact) continue;
        const ReferenceBody body = referenceBody(cloud, 0.01, 10, turnOnly(pa));
        const Vector3L m = v.normal.cast<long double>().normalized();
        checkHolds(v, referenceDistance(body, y, m).distance, referenceDistance(body, y, m).distance,
                   kReference);
      }
}

TEST_CASE(
    "two shapes aligned or nearly so, flat, tiny or almost touching: the normal's gap is the distance") {
  Random random(24);
  int exact = 0, all = 0;
  for (int i = 0; i < 1500; ++i) {
    const auto kind = [&] { return boundedShapes()[static_cast<std::size_t>(random.below(8))]; };
    TestShape p = randomShape(kind(), random), q = randomShape(kind(), random);
    const double scale = random.below(2) ? 1.0 : random.below(2) ? 1e-3 : 1e3;
    if (p.shape.kind == ShapeKind::cylinder || p.shape.kind == ShapeKind::cone) {
      p.shape = p.shape.kind == ShapeKind::cone
                    ? Shape::coneOf(scale * p.shape.radius, 1e-2 * p.shape.half)
                    : Shape::cylinderOf(scale * p.shape.radius, scale * p.shape.half);
    }
    Matrix3d turn = Matrix3d::Identity();
    for (int k = 0; k < 3; ++k)
      turn = Eigen::AngleAxisd(0.5 * M_PI * random.below(4), Vector3d::Unit(random.below(3)))
                 .toRotationMatrix() *
             turn;
    if (random.below(2)) turn = random.rotation(std::pow(10, -random.uniform(1, 13))) * turn;
    const double size = p.shape.reach + q.shape.reach + p.shape.margin + q.shape.margin;
    const Isometry3d pa =
        pose(random.below(2) ? Matrix3d(Matrix3d::Identity()) : random.rotation(), {0, 0, 0});
    Isometry3d pb = pa * pose(turn, 2 * size * Vector3d::Unit(random.below(3)) +
                                        0.3 * random.below(2) * size * random.direction());
    const double gap = std::pow(10, -random.uniform(1, 12)) * std::min(1.0, size);
    for (int k = 0; k < 3; ++k) {
      const Distance far = distance(p.shape, pa, q.shape, pb);
      pb.translation() += (gap - far.distance) * far.normal;
    }
    const Distance d = distance(p.shape, pa, q.shape, pb);
    CAPTURE(i, p.name, q.name, gap, d.distance);
    const ReferenceShape x = p.posed(pa), y = q.posed(pb);
    const Vector3L n = d.normal.cast<long double>();
    const double coordinates = size + pb.translation().norm(), rounding = 4e-15 * coordinates;
    REQUIRE(std::abs(d.normal.norm() - 1) <= 1e-15);
    REQUIRE((d.lower <= d.distance && d.distance <= d.upper));
    REQUIRE(static_cast<double>(referenceGap(x, y, n)) <= d.upper + rounding);
    ++all;
    if (d.status != DistanceStatus::exact) continue;  // edges that are parallel to 1e-12
    ++exact;
    CHECK(std::abs(static_cast<double>(referenceGap(x, y, n)) - d.distance) <= rounding);
    CHECK((d.point[1] - d.point[0]).norm() >= d.distance - rounding);
  }
  CHECK(exact >= 0.98 * all);
}

TEST_CASE("Each pose within 1e-6 of a rotation is taken for the nearest rotation, by itself") {
  Random random(31);
  const StpBv::Ptr a = StpBv::build(box(0.3, 0.2, 0.5), {0.01, 10}),
                   b = StpBv::build(cylinder(0.1, 0.3), {0.0, 10});
  const Shape shape = Shape::coneOf(0.1, 0.3), other = Shape::boxOf({0.2, 0.3, 0.1});
  for (int i = 0; i < 200; ++i) {
    Isometry3d pa = pose(random.rotation(), 0.3 * random.direction());
    Isometry3d pb = pose(random.rotation(), pa.translation() + 0.9 * random.direction());
    for (int k = 0; k < 9; ++k) {
      pa.linear()(k / 3, k % 3) += random.uniform(-1e-6, 1e-6);
      pb.linear()(k / 3, k % 3) += random.uniform(-1e-6, 1e-6);
    }
    const Isometry3d qa = pose(nearestRotation(pa.linear()).cast<double>(), pa.translation()),
                     qb = pose(nearestRotation(pb.linear()).cast<double>(), pb.translation());
    const auto check = [](const Distance& d, const Distance& e) {
      CHECK(d.status == e.status);
      CHECK(std::abs(d.distance - e.distance) <= 1e-14);
      CHECK((d.normal - e.normal).norm() <= 1e-11);
    };
    check(distance(*a, pa, *b, pb), distance(*a, qa, *b, qb));
    check(distance(*a, pa, shape, pb), distance(*a, qa, shape, qb));
    check(distance(other, pa, shape, pb), distance(other, qa, shape, qb));
  }
}

TEST_CASE("A pair without an answer leaves the last answer in its cache, in either order of the bodies") {
  const StpBv::Ptr a = StpBv::build(box(0.3, 0.2, 0.5), {0.01, 10});
  const Shape shape = Shape::coneOf(0.1, 0.3);
  const Isometry3d here = Isometry3d::Identity(), there = pose(Matrix3d::Identity(), {1, 0, 0}),
                   bad = pose(2.0 * Matrix3d::Identity(), {1, 0, 0});
  const auto check = [&](const auto& first, const auto& second) {
    PairCache cache;
    distance(first, here, second, there, &cache);
    const PairCache last = cache;
    CHECK(last.normal.norm() == Approx(1));
    CHECK(distance(first, here, second, bad, &cache).status == DistanceStatus::invalid);
    CHECK((cache.normal == last.normal && cache.patch == last.patch));
  };
  check(*a, *a);
  check(*a, shape);
  check(shape, *a);
}

TEST_CASE("A pose that is stretched, sheared or mirrored has no answer, whatever the other pose is") {
  const StpBv::Ptr a = StpBv::build(box(0.3, 0.2, 0.5), {0.01, 10});
  const Shape shape = Shape::coneOf(0.1, 0.3), other = Shape::boxOf({0.2, 0.3, 0.1});
  std::vector<Matrix3d> bad(7, Matrix3d::Identity());
  bad[0] *= 2.0;
  bad[1] *= 0.5;
  bad[2](0, 1) = 1e-3;
  bad[3](2, 2) = -1.0;
  bad[4] *= -1.0;
  bad[5] *= 1.0 + 1e-5;
  bad[6].setZero();
  const Isometry3d good = pose(Matrix3d::Identity(), {1, 0, 0});
  for (const Matrix3d& first : bad)
    for (const Matrix3d& second : bad) {
      const Isometry3d pa = pose(first, Vector3d::Zero()), pb = pose(second, {1, 0, 0});
      for (const auto& [x, y] : {std::make_pair(pa, good), std::make_pair(good, pa), std::make_pair(pa, pb)})
        for (const Distance& d : {distance(*a, x, *a, y), distance(*a, x, shape, y),
                                  distance(shape, x, *a, y), distance(shape, x, other, y)})
          CHECK(d.status == DistanceStatus::invalid);
    }
}
