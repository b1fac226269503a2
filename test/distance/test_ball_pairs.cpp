// A ball next to and inside each simple shape with few features: closed form, compared with supports in long
// double that share no code with it.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shape_reference.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// A place in the shape's frame where several ways out are equally long, or where the surface is at the
/// distance `off` (m).
Vector3d specialPlace(const Shape& s, Random& random, double off) {
  const Vector3d half =
      s.kind == ShapeKind::box ? s.size : Vector3d(s.radius + 0.01, s.radius + 0.01, s.half + 0.01);
  Vector3d x = random.uniform(0, 1.2) * half.cwiseProduct(random.direction());
  switch (random.below(6)) {
    case 0:
      return off * random.direction();  // the middle
    case 1:
      return {0, 0, x.z()};  // on the axis
    case 2: {                // equally far from several faces
      const double d = random.uniform(0, half.minCoeff());
      return half - Vector3d(d, d, d);
    }
    case 3: {  // next to a face, an end or a side
      const int i = random.below(3);
      if (i == 2 || s.kind == ShapeKind::box) return x[i] = std::copysign(half[i], x[i]) + off, x;
      const double across = std::hypot(x.x(), x.y()), scale = (s.radius + off) / across;
      return {scale * x.x(), scale * x.y(), x.z()};
    }
    case 4:
      return Vector3d(half.x() + off, off, s.kind == ShapeKind::box ? half.z() : -s.half);  // an edge or rim
    default:
      return x;
  }
}

}  // namespace

TEST_CASE("A ball and a shape of few features are exact wherever the ball's centre is") {
  Random random(5);
  int inside = 0, cases = 0;
  for (const char* name : {"sphere", "capsule", "box", "triangle", "cylinder", "cone"})
    for (int i = 0; i < trials(400); ++i) {
      CAPTURE(name, i);
      const TestShape shape = randomShape(name, random), ball = randomShape("sphere", random);
      TestShape centre = ball;
      centre.shape.margin = 0.0;
      const double off = random.below(3) ? std::pow(10.0, random.uniform(-19, -2)) : 0.0;
      const Isometry3d at = pose(random.below(2) ? random.rotation() : Eigen::Matrix3d::Identity(),
                                 random.below(2) ? Vector3d(random.direction()) : Vector3d(0, 0, 0));
      const Vector3d place = at * specialPlace(shape.shape, random, random.below(2) ? off : -off);
      const Isometry3d there = pose(random.rotation(), place);
      const Distance found = distance(ball.shape, there, shape.shape, at);
      REQUIRE(found.status == DistanceStatus::exact);
      const ReferenceShape a = ball.posed(there), b = shape.posed(at);
      // Poses, normals and lengths are accurate to a few roundings of about 4 m.
      const double rounding = found.upper - found.lower + 32 * 2.2e-16 * 4;
      CHECK(found.upper - found.lower < 1e-12);
      const Vector3L n = found.normal.cast<long double>().normalized();
      CHECK(std::abs(static_cast<double>(referenceGap(a, b, n)) - found.distance) <= rounding);
      CHECK(static_cast<double>(widestGapOverDirections(a, b, 100)) <= found.upper + rounding);
      const Vector3d along = found.point[1] - found.point[0] - found.distance * found.normal;
      CHECK(along.norm() <= rounding);
      // The shape's point is on the shape: no direction separates the point from the shape.
      const ReferenceShape point = centre.posed(pose(Eigen::Matrix3d::Identity(), found.point[1]));
      CHECK(static_cast<double>(widestGapOverDirections(point, b, 100)) <= rounding);

      const Distance other = distance(shape.shape, at, ball.shape, there);
      CHECK(other.distance == found.distance);
      CHECK(other.normal == -found.normal);
      CHECK(other.point[0] == found.point[1]);
      CHECK(isFartherThan(found.lower - rounding, ball.shape, there, shape.shape, at));
      CHECK_FALSE(isFartherThan(found.upper, ball.shape, there, shape.shape, at));
      inside += found.distance < -ball.shape.margin - shape.shape.margin;
      ++cases;
    }
  CHECK(inside > cases / 10);
}
