// Two capsules: closed form, compared with the nearest points of two segments in long double, which are
// computed from ends and lines by other formulas.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shape_reference.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

struct SegmentL {
  Vector3L from, to;

  Vector3L at(long double t) const { return from + t * (to - from); }
  long double distance(const Vector3L& x) const {
    const Vector3L e = to - from;
    const long double squared = e.squaredNorm(), t = squared > 0 ? e.dot(x - from) / squared : 0;
    return (x - at(std::clamp(t, 0.0L, 1.0L))).norm();
  }
};

SegmentL segment(const Shape& capsule, const Isometry3d& pose) {
  const Vector3L axis = static_cast<long double>(capsule.half) * pose.linear().col(2).cast<long double>(),
                 middle = pose.translation().cast<long double>();
  return {middle - axis, middle + axis};
}

// The least distance is that of an end of one segment from the other, or that of two inner points where both
// lines are nearest.
long double leastDistance(const SegmentL& a, const SegmentL& b) {
  long double least = std::min({a.distance(b.from), a.distance(b.to), b.distance(a.from), b.distance(a.to)});
  const Vector3L u = a.to - a.from, v = b.to - b.from, n = u.cross(v), d = b.from - a.from;
  const long double squared = n.squaredNorm();
  if (!(squared > 0)) return least;
  const long double s = d.cross(v).dot(n) / squared, t = d.cross(u).dot(n) / squared;
  // For lines that are nearly parallel, s and t are less accurate than the distance of the lines, so one
  // point is projected again.
  if (s > 0 && s < 1 && t > 0 && t < 1) least = std::min(least, a.distance(b.at(t)));
  return least;
}

// The pose of one capsule in the other one's frame: across it, level with it or nearly so, behind its end, or
// in one line with it; near or far.
Isometry3d placeBeside(const Shape& a, const Shape& b, Random& random) {
  const double tilt = random.below(3) ? std::pow(10.0, random.uniform(-17, 0)) : 0.0;
  const Eigen::Matrix3d level =
      Eigen::AngleAxisd(tilt, Vector3d(1, random.uniform(-1, 1), 0).normalized()).toRotationMatrix();
  const Eigen::Matrix3d turned = random.below(2) ? level : random.rotation();
  const double apart = std::pow(10.0, random.uniform(-13, 0.5));
  const Vector3d across = apart * Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), 0).normalized();
  switch (random.below(4)) {
    case 0:
      return pose(turned, across + Vector3d(0, 0, random.uniform(-1, 1) * (a.half + b.half)));
    case 1:
      return pose(turned, Vector3d(0, 0, a.half + apart + b.half));  // behind the end
    case 2:                                                          // an end of one at a point of the other
      return pose(turned, across + Vector3d(0, 0, random.uniform(-1, 1) * a.half) + b.half * turned.col(2));
    default:
      return pose(turned, across);
  }
}

}  // namespace

TEST_CASE("Two capsules are exact wherever they are and however they are turned") {
  Random random(21);
  int apart = 0;
  for (int i = 0; i < trials(4000); ++i) {
    CAPTURE(i);
    const auto length = [&] { return random.below(8) ? std::pow(10.0, random.uniform(-4, 0.3)) : 0.0; };
    const Shape a = Shape::capsule(random.uniform(0, 0.2), length()),
                b = Shape::capsule(random.below(4) ? random.uniform(0, 0.2) : 0.0, length());
    const Isometry3d first = random.below(2) ? pose(random.rotation(), random.direction())
                                             : Isometry3d(Isometry3d::Identity()),
                     second = first * placeBeside(a, b, random);
    const SegmentL inner[2]{segment(a, first), segment(b, second)};
    const double margins = a.margin + b.margin;
    const double truth = static_cast<double>(leastDistance(inner[0], inner[1])) - margins;
    // A dozen operations with poses and points of about 5 m.
    const double rounding = 16 * 2.2e-16 * 5;
    if (truth + margins < 4 * rounding) continue;  // cores that meet are not handled by this formula
    const Distance found = distance(a, first, b, second);
    REQUIRE(found.lower <= truth);
    REQUIRE(truth <= found.upper);
    // If cores almost touch, the error of the normal is rounding of the size divided by the gap. A few
    // answers are `bounded` there, and "not farther" is reported slightly early.
    const bool touching = truth + margins < 1e-7;
    if (touching && found.status == DistanceStatus::bounded) continue;
    REQUIRE(found.status == DistanceStatus::exact);
    CHECK(std::abs(found.distance - truth) <= rounding);
    const Vector3d way = found.point[1] - found.point[0];
    CHECK((way - found.distance * found.normal).norm() <= rounding);
    const double margin[2]{a.margin, b.margin};
    for (int k = 0; k < 2; ++k) {
      const Vector3d core = found.point[k] + (k == 0 ? -margin[k] : margin[k]) * found.normal;
      CHECK(static_cast<double>(inner[k].distance(core.cast<long double>())) <= rounding);
    }
    const Distance other = distance(b, second, a, first);
    CHECK(other.distance == found.distance);
    CHECK(other.normal == -found.normal);
    CHECK(other.point[0] == found.point[1]);
    if (!touching) CHECK(isFartherThan(found.lower - rounding, a, first, b, second));
    CHECK_FALSE(isFartherThan(found.upper, a, first, b, second));
    ++apart;
  }
  CHECK(apart > trials(4000) * 9 / 10);
}
