// Motions through contact and through the depth of both margins: the sign is right, the distance is
// continuous, the normal turns no faster than docs/theory.md, 6 allows, and answers are inexact only at
// depths of more than r1 + r2.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/distance/distance.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr double kRoundoff = 2.2e-16, kMargin = 0.01;

struct Pair {
  const char* name;
  Cloud a, b;
  Matrix3d turn;  ///< rotation of the second body, which lies above the first
  Vector3d aside;
};

/// Pairs of bodies that meet face to face, rim to rim, edge to edge, corner to face and side to side.
std::vector<Pair> pairs() {
  const Matrix3d straight = Matrix3d::Identity();
  const Matrix3d onEdge = Eigen::AngleAxisd(M_PI / 4, Vector3d::UnitY()).toRotationMatrix();
  const Matrix3d onCorner = rotationBetween(Vector3d(1, 1, 1), -Vector3d::UnitZ());
  const Matrix3d lying = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()).toRotationMatrix();
  const Cloud cube = box(0.2, 0.2, 0.2), flat = plate(0.5, 0.5), ball = geodesicSphere(0.1, 2);
  return {{"cube, cube: face on face", cube, cube, straight, {0.03, 0.02, 0}},
          {"cube, cube: rim on rim", cube, cube, straight, {0.2, 0, 0}},
          {"cube, cube: edge on face", cube, cube, onEdge, {0.02, 0.03, 0}},
          {"cube, plate: face on face", cube, flat, straight, {0.1, 0.05, 0}},
          {"plate, cube: corner on face", flat, cube, onCorner, {0.05, 0.02, 0}},
          {"plate, plate", flat, flat, onEdge, {0.02, 0.01, 0}},
          {"geodesic, geodesic", ball, ball, straight, {0.01, 0.02, 0}},
          {"geodesic, plate", ball, flat, straight, {0.2, 0.1, 0}},
          {"needle, cylinder", needle(0.5), cylinder(0.1, 0.3), lying, {0, 0.02, 0}},
          {"cylinder, needle", cylinder(0.1, 0.3), needle(0.5), lying, {0.09, 0, 0}}};
}

struct Sweep {
  const StpBv &a, &b;
  double margins() const { return a.radii().r + b.radii().r; }
  double bigRadii() const { return a.radii().R + b.radii().R; }

  /// Moves `b` to `poseAt(t)` for t from -1 to 1, in steps that move no point of it further than `length` (m)
  /// and turn it by `angle` (rad).
  void run(const std::function<Isometry3d(double)>& poseAt, int steps, double length, double angle,
           bool warm) const {
    // A core point is accurate to some ulps of the big radii, a normal to that divided by what curves the
    // gap.
    const double rounding = 8 * kRoundoff * (bigRadii() + 2);
    PairCache cache;
    Distance last;
    double worstTurn = 0, worstStep = 0;
    for (int i = 0; i <= steps; ++i) {
      const Distance d =
          distance(a, Isometry3d::Identity(), b, poseAt(2.0 * i / steps - 1), warm ? &cache : nullptr);
      CAPTURE(i, d.distance);
      REQUIRE(d.status != DistanceStatus::invalid);
      if (d.distance > rounding - margins()) REQUIRE(d.status == DistanceStatus::exact);
      // Both bounds are rounded outward, for a sum of sizes and distances of about 4 m.
      if (d.status == DistanceStatus::exact) REQUIRE(d.upper - d.lower <= rounding + 3 * kGapRounding * 4);
      REQUIRE(d.lower <= d.distance);
      REQUIRE(d.distance <= d.upper);
      // The witness points are on the normal's line, and their signed distance is the answer's.
      const double off = (d.point[1] - d.point[0] - d.distance * d.normal).norm();
      REQUIRE(off <= rounding);
      if (i > 0) {
        worstStep = std::max(worstStep, std::abs(d.distance - last.distance) - length);
        const double core = std::min(d.distance, last.distance) + margins();
        if (core > 0) {
          const double turn = 2 * std::asin(std::min(1.0, 0.5 * (d.normal - last.normal).norm()));
          // A turn of one body by `angle` also carries the normal along.
          worstTurn = std::max(worstTurn, (turn - angle - 2 * rounding / core) * core / length);
        }
      }
      last = d;
    }
    CHECK(worstStep <= rounding);
    CHECK(worstTurn <= 1.0);
  }
};

}  // namespace

TEST_CASE(
    "A straight line through contact and past both margins: sign, continuity, turn of the normal, status") {
  const double R = GENERATE(1.0, 10.0);
  const bool warm = GENERATE(false, true);
  for (const Pair& pair : pairs()) {
    CAPTURE(pair.name, R, warm);
    const auto a = StpBv::build(pair.a, {kMargin, R}), b = StpBv::build(pair.b, {kMargin, R});
    const Sweep sweep{*a, *b};
    Isometry3d touching = pose(pair.turn, pair.aside + Vector3d(0, 0, 1));
    for (int i = 0; i < 60; ++i)  // moves down to contact, by at most the distance each time
      touching.translation().z() -= distance(*a, Isometry3d::Identity(), *b, touching).distance;
    REQUIRE(std::abs(distance(*a, Isometry3d::Identity(), *b, touching).distance) < 1e-13);
    for (const double half : {1.5 * sweep.margins(), 1e-3, 1e-6, 1e-9}) {
      CAPTURE(half);
      const auto down = [&](double t) {
        return pose(pair.turn, touching.translation() - Vector3d(0, 0, t * half));
      };
      const int steps = 300;
      sweep.run(down, steps, 2 * half / steps, 0, warm);
      // Before contact the bodies are apart, after it they overlap.
      for (const double t : {-1.0, -0.5, 0.5, 1.0}) {
        const Distance d = distance(*a, Isometry3d::Identity(), *b, down(t));
        CHECK((t < 0) == (d.distance > 0));
      }
    }
    // Passes the depth of both margins, where the search of overlapping cores takes over.
    Isometry3d deep = touching;
    for (int i = 0; i < 60; ++i) {
      const Distance d = distance(*a, Isometry3d::Identity(), *b, deep);
      deep.translation().z() -= (d.distance + sweep.margins()) / std::max(0.2, d.normal.z());
    }
    for (const double half : {1e-3, 1e-6, 1e-9}) {
      CAPTURE(half);
      const auto down = [&](double t) {
        return pose(pair.turn, deep.translation() - Vector3d(0, 0, t * half));
      };
      const int steps = 300;
      sweep.run(down, steps, 2 * half / steps, 0, warm);
      CHECK(distance(*a, Isometry3d::Identity(), *b, down(1)).distance < -sweep.margins());
      CHECK(distance(*a, Isometry3d::Identity(), *b, down(-1)).distance > -sweep.margins());
    }
  }
}

TEST_CASE("A rotation into contact and past both margins: continuity, turn of the normal, status") {
  const double R = GENERATE(1.0, 10.0);
  const bool warm = GENERATE(false, true);
  const double depth = GENERATE(0.0, 0.02);
  for (const Pair& pair : pairs()) {
    CAPTURE(pair.name, R, warm, depth);
    const auto a = StpBv::build(pair.a, {kMargin, R}), b = StpBv::build(pair.b, {kMargin, R});
    const Sweep sweep{*a, *b};
    Isometry3d at = pose(pair.turn, pair.aside + Vector3d(0, 0, 1));
    for (int i = 0; i < 60; ++i) {
      const Distance d = distance(*a, Isometry3d::Identity(), *b, at);
      at.translation().z() -= (d.distance + depth) / std::max(0.2, d.normal.z());
    }
    const Vector3d axis = Vector3d(0.6, 0.8, 0.1).normalized();
    for (const double half : {0.1, 1e-3, 1e-6, 1e-9}) {
      CAPTURE(half);
      const auto turned = [&](double t) {
        return pose(Eigen::AngleAxisd(t * half, axis).toRotationMatrix() * at.linear(), at.translation());
      };
      const int steps = 300;
      const double angle = 2 * half / steps;
      const double reach = 0.4;  // m, an upper bound on the distance of a body's points from its origin
      sweep.run(turned, steps, angle * reach, angle, warm);
    }
  }
}
