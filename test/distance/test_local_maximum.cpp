// What arcs, segments and caps around a maximum prove, compared with the supports of such sets in all
// directions. Also tests that EPA of an STP-BV and a simple shape needs few steps with this proof.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "fcl_stpbv/convex/local_maximum.h"
#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shape_reference.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// An arc along `d` through the point with the outward normal `up`; a cap if `round`, straight if endless.
struct Piece {
  Vector3d d;
  double radius, before, after;  // angles to its ends (rad); for a segment the lengths (m)
  bool round;

  /// How much further than the point alone it reaches along the unit vector `m`.
  double gain(const Vector3d& up, const Vector3d& m) const {
    const Vector3d across = m - m.dot(up) * up;
    const double x = round ? across.norm() : d.dot(m), z = up.dot(m);
    if (std::isinf(radius)) return std::max(after * x, -before * x);
    const double angle = std::clamp(std::atan2(x, z), -before, after), half = std::sin(0.5 * angle);
    return radius * (std::sin(angle) * x - 2.0 * half * half * z);
  }
};

/// The Minkowski sum of a point and a few pieces through it.
struct PiecesAround {
  Vector3d n;
  double depth;
  std::vector<Piece> pieces;
  LocalMaximum local;

  explicit PiecesAround(Random& some)
      : n(some.direction()), depth(std::pow(10.0, some.uniform(-3, 0))), local(n, depth) {
    const Vector3d e = n.unitOrthogonal(), f = n.cross(e);
    const int count = 1 + some.below(3);
    for (int i = 0; i < count; ++i) {
      const double turn = some.uniform(0, 2 * M_PI), radius = depth * std::pow(10.0, some.uniform(-0.7, 2)),
                   least = std::pow(10.0, some.uniform(-3, 0)), most = least * some.uniform(1, 1.5);
      const bool first = some.below(2) == 0, round = some.below(4) == 0, straight = some.below(3) == 0;
      Piece p{std::cos(turn) * e + std::sin(turn) * f, radius, first ? least : most, first ? most : least,
              round};
      if (straight) {
        const double length = depth * least;
        p.radius = LocalMaximum::kEndless, p.before = length;
        p.after = round || first ? length : 2 * length;
        round ? local.addDisc(length) : local.addSegment(p.d, length);
      } else if (round) {
        p.before = p.after = least;
        local.addCap(radius, radius * std::sin(least));
      } else {
        local.addArc(p.d, radius, radius * std::sin(least));
      }
      pieces.push_back(p);
    }
  }

  double support(const Vector3d& m) const {
    double sum = -depth * n.dot(m);
    for (const Piece& p : pieces) sum += p.gain(-n, m);
    return sum;
  }

  Vector3d tilted(double angle, Random& some) const {
    const Vector3d any = some.direction(), e = (any - any.dot(n) * n).normalized();
    return -std::cos(angle) * n + std::sin(angle) * e;
  }
};

}  // namespace

TEST_CASE("Within the angle that a local maximum holds for, no direction leads out sooner") {
  Random some(11);
  int held = 0, refuted = 0;
  for (int i = 0; i < 4000; ++i) {
    const PiecesAround around(some);
    const double most = std::pow(10.0, some.uniform(-3, -0.11));
    const bool holds = around.local.holdsWithin(std::sin(most), std::cos(most));
    double least = around.depth;
    for (int k = 0; k < 300; ++k) {
      const double angle = k % 3 == 0 ? most : most * std::pow(10.0, some.uniform(-4, 0));
      least = std::min(least, around.support(around.tilted(angle, some)));
    }
    CAPTURE(i, most, around.depth, around.pieces.size());
    if (holds) REQUIRE(least >= around.depth * (1 - 1e-15));  // an ulp or two of the depth
    held += holds;
    refuted += least < around.depth * (1 - 1e-9);
  }
  CHECK(held > 1000);
  CHECK(refuted > 1000);  // for some of the sets the proof does not hold
}

TEST_CASE("A local maximum that holds beyond a plane has all of the ball's points there covered") {
  Random some(12);
  int held = 0, refuted = 0;
  for (int i = 0; i < 4000; ++i) {
    const PiecesAround around(some);
    const double tilt = std::pow(10.0, some.uniform(-3, -0.2)), low = std::pow(10.0, some.uniform(-6, -0.6));
    const Vector3d m = around.tilted(tilt, some);
    const double distance = around.depth * (1 - low);
    const bool holds = around.local.holdsBeyond(m, distance);
    double least = around.depth;
    for (int k = 0; k < 300; ++k) {
      // On the ball and beyond the plane: at angles from `m` up to the one whose cosine is 1 - low.
      const double angle = std::acos(1 - low) * (k % 3 == 0 ? 1.0 : std::sqrt(some.uniform(0, 1)));
      const Vector3d any = some.direction(), e = (any - any.dot(m) * m).normalized();
      least = std::min(least, around.support((std::cos(angle) * m + std::sin(angle) * e).normalized()));
    }
    CAPTURE(i, tilt, low, around.depth);
    if (holds) REQUIRE(least >= around.depth * (1 - 1e-15));
    held += holds;
    refuted += least < around.depth * (1 - 1e-9);
  }
  CHECK(held > 500);
  CHECK(refuted > 500);
}

TEST_CASE("A direction that is not across the normal is left out") {
  LocalMaximum local(Vector3d::UnitX(), 0.1);
  local.addArc(Vector3d(1e-6, 1, 0), 10, 10);
  local.addArc(Vector3d(0, 0, std::nan("")), 10, 10);
  CHECK_FALSE(local.holdsWithin(1e-3, std::sqrt(1 - 1e-6)));
  local.addCap(1, 1);
  CHECK(local.holdsWithin(1e-3, std::sqrt(1 - 1e-6)));
  CHECK_FALSE(LocalMaximum().holdsBeyond(Vector3d::UnitX(), 1.0));
}

TEST_CASE("An STP-BV and a simple shape deep in each other take few steps, and their bounds agree") {
  struct Bound {
    const char* name;
    Shape shape;
    double pairs;  // average number of Newton's steps, support points and ways out of faces' balls
    /// Share of answers whose bounds differ by more than rounding. If rounding leans a cone's generator
    /// against the normal, the generator is left out of the proof: 3 to 5 of 399, depending on the compiler's
    /// rounding.
    double bounded;
  };
  const std::vector<Bound> bounds{{"cylinder", Shape::cylinderOf(0.1, 0.4), 54, 0.01},
                                  {"cone", Shape::coneOf(0.1, 0.4), 28, 0.03},
                                  {"ellipsoid", Shape::ellipsoidOf({0.1, 0.15, 0.2}), 64, 0.15}};
  Random some(13);
  for (const Cloud& cloud : {geodesicSphere(0.2, 2), box(0.2, 0.3, 0.4)}) {
    const StpBv::Ptr volume = StpBv::build(cloud, {0.01, 10});
    for (const Bound& bound : bounds) {
      int deep = 0, bounded = 0;
      double pairs = 0;
      for (int i = 0; i < 400; ++i) {
        const Vector3d off = some.uniform(0.1, 0.25) * some.direction();
        const Isometry3d at = pose(some.rotation(), off);
        const Distance d = distance(*volume, Isometry3d::Identity(), bound.shape, at, nullptr);
        REQUIRE(d.lower <= d.distance);
        REQUIRE(d.distance <= d.upper);
        if (d.status != DistanceStatus::local) continue;
        ++deep;
        pairs += d.patchPairs;
        bounded += d.upper - d.lower > 1e-12;
        // No direction is a shorter way out.
        for (int k = 0; k < 100; ++k) {
          const double tilt = std::pow(10.0, some.uniform(-4, 0));
          const Vector3d n = (d.normal + tilt * some.direction()).normalized();
          const double out =
              volume->support(n) - off.dot(n) +
              bound.shape.support(at.linear().transpose() * -n).dot(at.linear().transpose() * -n);
          REQUIRE(-out <= d.upper);
        }
      }
      CAPTURE(bound.name, pairs / deep, deep, bounded);
      CHECK(deep > 200);
      CHECK(pairs / deep <= bound.pairs);
      CHECK(bounded <= bound.bounded * deep);
    }
  }
}

TEST_CASE("Bodies of revolution deep in each other with parallel axes: an apex is no flat end") {
  Random some(14);
  int deep = 0;
  for (int i = 0; i < 3000; ++i) {
    const char* const kinds[] = {"cone", "cylinder", "box", "ellipsoid", "capsule", "sphere"};
    TestShape one = randomShape(kinds[some.below(2)], some), other = randomShape(kinds[some.below(6)], some);
    if (some.below(2)) one = {"cone", Shape::coneOf(some.uniform(0.5, 2), some.uniform(0.1, 0.8)), {}};
    const Eigen::Matrix3d turn = some.rotation();
    Eigen::Matrix3d upright = Eigen::AngleAxisd(some.uniform(0, 7), Vector3d::UnitZ()).toRotationMatrix();
    if (some.below(2)) upright.rightCols<2>() *= -1;
    const Vector3d off(some.below(2) ? 0 : some.uniform(-0.1, 0.1), 0, some.uniform(-0.2, 0.2));
    const Isometry3d at = pose(turn, some.direction()), there = at * pose(upright, off);
    const Distance d = distance(one.shape, at, other.shape, there);
    if (!(d.distance < -one.shape.margin - other.shape.margin)) continue;
    ++deep;
    CAPTURE(i, one.name, other.name, d.distance);
    const ReferenceShape a = one.posed(at), b = other.posed(there);
    const auto gap = [&](const Vector3d& n) {
      return static_cast<double>(referenceGap(a, b, n.cast<long double>().normalized()));
    };
    for (int k = 0; k < 200; ++k) {
      const double tilt = 3.141592653589793 * k / 200, round = some.uniform(0, 7);
      const Vector3d n(std::sin(tilt) * std::cos(round), std::sin(tilt) * std::sin(round), std::cos(tilt));
      REQUIRE(gap(turn * n) <= d.upper);
    }
    for (const double tilt : {1e-1, 1e-2, 1e-3, 1e-4})
      for (int k = 0; k < 8; ++k) REQUIRE(gap(d.normal + tilt * some.direction()) <= d.upper);
    REQUIRE(std::abs(gap(d.normal) - d.distance) <= 1e-14 * 4);
  }
  CHECK(deep > 1500);
}
