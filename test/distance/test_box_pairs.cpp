// Two overlapping boxes by separating axes, compared with supports in long double along all candidates for
// the least overlap and many other directions.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shape_reference.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// A box, a cube, a plate of 1 mm, a needle, or a box without thickness.
TestShape someBox(Random& random) {
  TestShape shape = randomShape("box", random);
  Vector3d& half = shape.shape.size;
  switch (random.below(6)) {
    case 0:
      half.setConstant(half.x());
      break;
    case 1:
      half[random.below(3)] = 5e-4;
      break;
    case 2:
      half.y() = half.z() = 1e-3;
      break;
    case 3:
      half[random.below(3)] = 0.0;
      break;
  }
  *shape.vertices = box(2.0 * half.x(), 2.0 * half.y(), 2.0 * half.z());
  shape.shape = Shape::boxOf(2.0 * half);
  return shape;
}

/// Turned at random, by quarter turns, or off one of these by 1e-17 to 1e-2 rad.
Matrix3d someTurn(Random& random) {
  if (random.below(3) == 0) return random.rotation();
  Matrix3d turn = Matrix3d::Identity();
  for (int i = random.below(3); i > 0; --i) turn.col(i).swap(turn.col(i - 1)), turn.col(i) *= -1.0;
  return random.below(3) == 0 ? turn
                              : Matrix3d(turn * random.rotation(std::pow(10.0, random.uniform(-17, -2))));
}

}  // namespace

TEST_CASE("Two boxes have the distance or depth that supports give, also with level faces and edges") {
  Random random(3);
  int deep = 0, exact = 0, beside = 0, outsideOne = 0;
  for (int i = 0; i < 4000; ++i) {
    CAPTURE(i);
    const TestShape one = someBox(random), same = someBox(random), &other = random.below(8) ? same : one;
    const Isometry3d at = pose(random.rotation(), random.direction());
    const Isometry3d there =
        at * pose(someTurn(random),
                  random.uniform(0, random.below(2) ? 0.1 : 0.5) *
                      (random.below(2) ? Vector3d::Unit(random.below(3)) : Vector3d(random.direction())));
    const Distance found = distance(one.shape, at, other.shape, there);
    deep += found.distance < 0.0;
    exact += found.status == DistanceStatus::exact;
    // Poses, normals and lengths are accurate to a few roundings of about 3 m.
    const double rounding = found.upper - found.lower + 32 * 2.2e-16 * 3;
    CHECK(found.upper - found.lower < (found.status == DistanceStatus::exact ? 1e-12 : 1e-8));
    const ReferenceShape a = one.posed(at), b = other.posed(there);
    const auto gap = [&](const Vector3L& n) { return static_cast<double>(referenceGap(a, b, n)); };
    CHECK(std::abs(gap(found.normal.cast<long double>().normalized()) - found.distance) <= rounding);
    std::vector<Vector3L> axes;
    for (int k = 0; k < 3; ++k) {
      axes.push_back(at.linear().col(k).cast<long double>());
      axes.push_back(there.linear().col(k).cast<long double>());
      for (int l = 0; l < 3; ++l) {
        const Vector3L first = at.linear().col(k).cast<long double>(),
                       across = first.cross(Vector3L(there.linear().col(l).cast<long double>()));
        if (across.norm() > 1e-12L) axes.push_back(across);
      }
    }
    for (int k = 0; k < 50; ++k) axes.push_back(random.direction().cast<long double>());
    double widest = -1e300;
    for (const Vector3L& axis : axes)
      widest = std::max({widest, gap(axis.normalized()), gap(-axis.normalized())});
    CHECK(widest <= found.upper + rounding);

    const Vector3d opposite = found.point[1] - found.point[0] - found.distance * found.normal;
    beside += opposite.norm() > rounding;
    CHECK(opposite.norm() <= (found.distance < 0.0 ? rounding : 1e-7));
    for (const bool first : {true, false}) {  // each point must be in its own box
      const Vector3d local = (first ? at : there).inverse() * found.point[first ? 0 : 1];
      const Vector3d outside = local.cwiseAbs() - (first ? one : other).shape.size;
      outsideOne += outside.maxCoeff() > rounding;
      CHECK(outside.maxCoeff() <= 1e-9);
    }
    const Distance swapped = distance(other.shape, there, one.shape, at);
    CHECK(swapped.distance == found.distance);
    CHECK(swapped.normal == -found.normal);
    CHECK(isFartherThan(0.0, one.shape, at, other.shape, there) == (found.lower > 0.0));
    CHECK(isFartherThan(found.lower - rounding, one.shape, at, other.shape, there));
    CHECK_FALSE(isFartherThan(found.upper, one.shape, at, other.shape, there));
  }
  CHECK(deep > 1500);
  // These are left to GJK and EPA: edges next to each other, 1e-15 to 1e-5 rad from parallel.
  CHECK(exact > 0.997 * 4000);
  CHECK(beside < 0.003 * 4000);
  CHECK(outsideOne < 0.003 * 4000);
}
