// First and second derivatives of an STP-BV's distance to every other body, compared with central differences
// where the distance is smooth, and with one-sided ones on both sides of the region boundaries.
#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/distance/distance.h"
#include "test/distance/derivatives.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr double kEpsilon = 2.2e-16;

/// The bodies that an STP-BV is paired with: every shape, and another STP-BV.
std::vector<std::string> others() {
  std::vector<std::string> names = boundedShapes();
  names.insert(names.end(), {"halfspace", "plane", "volume"});
  return names;
}

const std::vector<StpBv::Ptr>& volumes() {
  static const std::vector<StpBv::Ptr> all{
      StpBv::build(randomHull(20, {0.2, 0.15, 0.1}, 3), {0.01, 2}),
      StpBv::build(box(0.3, 0.2, 0.1), {0.02, 10}), StpBv::build(cylinder(0.1, 0.4, 12), {0.01, 1}),
      StpBv::build({{0, 0, -0.1}, {0, 0, 0.2}}, {0.02, 0.5}), StpBv::build({{0.1, 0, 0}}, {0.05, 1})};
  return all;
}

DerivativePair randomPair(const std::string& name, Random& random) {
  const auto any = [&] { return volumes()[static_cast<std::size_t>(random.below(5))]; };
  DerivativePair pair{any(), nullptr, {}};
  if (name == "volume")
    pair.other = any();
  else
    pair.shape = randomShape(name, random);
  return pair;
}

/// Finds poses at which the bodies are `gap` apart, in a random direction. False if it finds none.
bool placed(const DerivativePair& pair, double gap, Random& random, Poses& at) {
  at = {pose(random.rotation(), random.direction()), pose(random.rotation(), 2 * random.direction())};
  for (int i = 0; i < 30; ++i) {
    const Distance d = pair.ask(at);
    if (d.status == DistanceStatus::exact && std::abs(d.distance - gap) <= 0.02 * gap) return true;
    at[1].translation() += (gap - d.distance) * d.normal;
  }
  return false;
}

Twists randomTwists(Random& random) {
  Twists t;
  t << random.direction(), random.direction(), random.direction(), random.direction();
  return t;
}

/// Largest error of a difference of answers compared with a derivative, from the answers' rounding.
struct DerivativeRounding {
  DerivativeRounding(const DerivativePair& pair, const Distance& d, double h) {
    const double core = d.distance + pair.margins();
    distance = 16 * kEpsilon / h;  // numbers up to 4 m
    // An ulp of the normal moves the core's point by rho ulps. That changes the normal by the same divided by
    // the cores' distance.
    point = 16 * kEpsilon * (pair.rho() + 4) * (1 + 1 / core) / h;
  }
  double distance, point;
};

/// All rates of an answer along the twists, for comparison.
struct Rates {
  double speed, second;  ///< rates of the distance
  Vector3d normal, point[2];
};

Rates ratesOf(const Distance& d, const DistanceHessian& h, const Poses& at, const Twists& twists) {
  return {gradientOf(d, at).dot(twists),
          twists.dot(h.matrix * twists),
          h.normal * twists,
          {h.point[0] * twists, h.point[1] * twists}};
}

}  // namespace

TEST_CASE(
    "away from region boundaries gradient, Hessian and the velocities of normal and points are central "
    "differences") {
  Random random(17);
  for (const std::string& name : others()) {
    int compared = 0;
    for (int i = 0; i < 150; ++i) {
      CAPTURE(name, i);
      const DerivativePair pair = randomPair(name, random);
      const double gap = i % 3 ? 0.2 : -0.5 * pair.margins();
      Poses at;
      if (!placed(pair, gap, random, at)) continue;
      const Distance d = pair.ask(at);
      DistanceHessian h;
      REQUIRE(pair.second(at, d, h));
      CHECK(h.matrix == h.matrix.transpose());
      const Twists twists = randomTwists(random);
      const Rates rates = ratesOf(d, h, at, twists);

      // Two central differences, extrapolated: the error is of the fourth order in step divided by the cores'
      // distance.
      const double step = 1e-3 * (d.distance + pair.margins());
      Distance side[4];
      Twists g[4];
      bool smooth = true;
      constexpr double kAt[4] = {-2, -1, 1, 2};
      for (int k = 0; k < 4; ++k) {
        const Poses there = after(at, twists, kAt[k] * step);
        side[k] = pair.ask(there);
        g[k] = gradientOf(side[k], there);
        smooth = smooth && side[k].status == DistanceStatus::exact &&
                 pair.signature(there, side[k]) == pair.signature(at, d);
      }
      if (!smooth) continue;
      const auto central = [&](const auto& value) {
        return ((8 * (value(2) - value(1)) - (value(3) - value(0))) / (12 * step)).eval();
      };
      using Number = Eigen::Matrix<double, 1, 1>;
      const DerivativeRounding rounding(pair, d, step);
      // Truncation error: (1e-3)^4 of levers up to 3 m divided by the cores' distance, to the power of the
      // derivative.
      const double lever = 3 + 1 / (d.distance + pair.margins());
      const double speed = central([&](int k) { return Number(side[k].distance); })(0);
      CHECK(std::abs(speed - rates.speed) <= rounding.distance + 1e-11 * lever);
      const double second = central([&](int k) { return Number(g[k].dot(twists)); })(0);
      const double scale = 1 + pair.rho() * 1e-2 + h.matrix.cwiseAbs().maxCoeff();
      CHECK(std::abs(second - rates.second) <= 4 * rounding.point + 1e-10 * scale * lever);
      const Vector3d normal = central([&](int k) { return side[k].normal; });
      CHECK((normal - rates.normal).norm() <= 4 * rounding.point + 1e-10 * scale * lever);
      for (int p = 0; p < 2; ++p) {
        const Vector3d point = central([&](int k) { return side[k].point[static_cast<std::size_t>(p)]; });
        CHECK((point - rates.point[p]).norm() <=
              4 * rounding.point * (1 + pair.rho()) + 1e-10 * scale * lever);
      }
      ++compared;
    }
    CAPTURE(name, compared);
    CHECK(compared > 60);
  }
}

TEST_CASE(
    "at a region boundary the gradient is continuous and each side has its own one-sided second "
    "derivatives") {
  Random random(23);
  for (const std::string& name : others()) {
    int boundaries = 0, kinks = 0;
    for (int path = 0; path < 200; ++path) {
      const DerivativePair pair = randomPair(name, random);
      Poses start;
      if (!placed(pair, path % 3 ? 0.15 : -0.3 * pair.margins(), random, start)) continue;
      const Twists twists = randomTwists(random);
      const auto signatureAt = [&](double t) {
        const Poses at = after(start, twists, t);
        return pair.signature(at, pair.ask(at));
      };
      // Move along the path to the first change of a feature.
      const double stride = 0.02 * (pair.ask(start).distance + pair.margins());
      double low = 0, high = 0;
      const std::vector<int> before = signatureAt(0);
      for (int k = 1; k <= 60 && high == 0; ++k) {
        if (!(pair.ask(after(start, twists, k * stride)).distance > -0.5 * pair.margins())) break;
        if (signatureAt(k * stride) != before) low = (k - 1) * stride, high = k * stride;
      }
      if (high == 0) continue;
      while (high - low > 1e-15) {
        const double middle = 0.5 * (low + high);
        if (!(middle > low && middle < high)) break;
        (signatureAt(middle) == before ? low : high) = middle;
      }
      const std::vector<int> behind = signatureAt(high);
      CAPTURE(name, path, low, before, behind);
      const Poses below = after(start, twists, low), above = after(start, twists, high);
      const Distance under = pair.ask(below), over = pair.ask(above);
      REQUIRE(under.status == DistanceStatus::exact);
      REQUIRE(over.status == DistanceStatus::exact);
      const double core = over.distance + pair.margins();
      const DerivativeRounding exact(pair, over, 1);
      CHECK(std::abs(under.distance - over.distance) <= exact.distance + 4 * (high - low));
      CHECK((gradientOf(under, below) - gradientOf(over, above)).norm() <=
            8 * exact.point + 10 * (high - low) / core);

      double second[2];
      bool whole = true;
      for (int side = 0; side < 2 && whole; ++side) {
        CAPTURE(side);
        // From just beside the boundary, away from it: three equal steps, exact to the third order.
        const double sign = side ? 1 : -1, off = 1e-9 * core, step = 3e-4 * core;
        const double from = (side ? high : low) + sign * off;
        const Poses base = after(start, twists, from);
        const Distance d = pair.ask(base);
        DistanceHessian h;
        REQUIRE(pair.second(base, d, h));
        const Rates rates = ratesOf(d, h, base, twists);
        Distance there[5];
        Twists g[5];
        for (int k = 0; k < 5; ++k) {
          const Poses at = after(start, twists, from + k * sign * step);
          there[k] = pair.ask(at);
          g[k] = gradientOf(there[k], at);
          whole = whole && pair.signature(at, there[k]) == pair.signature(base, d);
        }
        if (!whole) break;
        const auto sided = [&](const auto& value) {
          return (sign * (-25 * value(0) + 48 * value(1) - 36 * value(2) + 16 * value(3) - 3 * value(4)) /
                  (12 * step))
              .eval();
        };
        using Number = Eigen::Matrix<double, 1, 1>;
        const DerivativeRounding rounding(pair, d, step);
        const double lever = 3 + 1 / core, scale = 1 + pair.rho() * 1e-2 + h.matrix.cwiseAbs().maxCoeff();
        const double speed = sided([&](int k) { return Number(there[k].distance); })(0);
        CHECK(std::abs(speed - rates.speed) <= 8 * rounding.distance + 1e-10 * lever);
        second[side] = sided([&](int k) { return Number(g[k].dot(twists)); })(0);
        CHECK(std::abs(second[side] - rates.second) <= 32 * rounding.point + 1e-9 * scale * lever);
        const Vector3d normal = sided([&](int k) { return there[k].normal; });
        CHECK((normal - rates.normal).norm() <= 32 * rounding.point + 1e-9 * scale * lever);
        for (int p = 0; p < 2; ++p) {
          const Vector3d point = sided([&](int k) { return there[k].point[static_cast<std::size_t>(p)]; });
          CHECK((point - rates.point[p]).norm() <=
                32 * rounding.point * (1 + pair.rho()) + 1e-9 * scale * lever);
        }
      }
      if (!whole) continue;
      ++boundaries;
      kinks += std::abs(second[1] - second[0]) > 1e-3;
    }
    CAPTURE(name, boundaries, kinks);
    CHECK(boundaries >= 20);
    CHECK(kinks >= 20);  // real boundaries, at which the second derivative jumps
  }
}

TEST_CASE(
    "balls in each other up to next to their centres: normal and points move as the line of centres does") {
  const Vector3d v(0.3, 1, -0.5);  // m/s, of the second ball's centre
  for (const double radius : {0.0, 0.03, 0.5})
    for (const double apart : {1e-3, 1e-6, 1e-9, 1e-11}) {
      CAPTURE(radius, apart);
      const Isometry3d here = at(0, 0, 0), there = at(apart, 0, 0);
      const Vector3d turn = Vector3d(0, v.y(), v.z()) / apart;
      const auto compare = [&](const auto& a, const auto& b) {
        const Distance d = distance(a, here, b, there);
        BodyTwists twists = BodyTwists::Zero();
        twists.segment<3>(6) = v;
        DistanceHessian h;
        DistanceRate moves;
        REQUIRE(hessian(a, here, b, there, d, h));
        REQUIRE(rate(a, here, b, there, d, twists, moves));
        // Rounding of the distance, relative to the remaining distance.
        const double rounding = 4 * kEpsilon * (0.25 + radius) / apart;
        CHECK((moves.normal - turn).norm() <= rounding * turn.norm());
        CHECK((h.normal * twists - turn).norm() <= rounding * turn.norm());
        CHECK(std::abs(twists.dot(h.matrix * twists) - turn.dot(v)) <= rounding * turn.dot(v));
        CHECK((moves.point[0] - 0.25 * turn).norm() <= rounding * (1 + 0.25 * turn.norm()));
        CHECK((moves.point[1] - v + radius * turn).norm() <= rounding * (1 + radius * turn.norm()));
      };
      const StpBv::Ptr a = StpBv::build({{0, 0, 0}}, {0.25, 10}), b = StpBv::build({{0, 0, 0}}, {radius, 10});
      compare(*a, *b);
      if (radius > 0) compare(Shape::sphere(0.25), Shape::sphere(radius));
    }
}
