// Whole bodies hand over to their convex parts: the rows' values in between, and that nothing jumps.
#include <fcl/geometry/shape/box.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/batch.h"
#include "test/reference/robots.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

namespace {

constexpr double kHandOver = 0.12;

Body bodyAt(int link, const std::string& name, const Cloud& cloud, int partOf) {
  Body body = smoothBody(link, name, StpBv::build(cloud, {0.005, 3}));
  body.partOf = partOf;
  return body;
}

/// Both hands hold an L of two bars, and a box stands in front. So there are parts against parts, and parts
/// against a single body.
struct TwoHooks {
  Problem problem = fcl_stpbv::test::problem(robots()[0]);
  std::shared_ptr<RobotGeometry> geometry = std::make_shared<RobotGeometry>();
  std::vector<CheckedPair> parts{{1, 4, false}, {1, 5, false}, {2, 4, false},
                                 {2, 5, false}, {1, 0, true},  {2, 0, true}};
  std::vector<CheckedPair> whole{{0, 3, false}, {0, 0, true}};

  TwoHooks() {
    std::vector<int> hands{problem.model->link("LARM_LINK5"), problem.model->link("RARM_LINK5")};
    std::sort(hands.begin(), hands.end());  // bodies are in the order of the links
    for (const int hand : hands) {
      Cloud upright = box(0.04, 0.04, 0.24), across = box(0.2, 0.04, 0.04), all;
      for (Vector3d& p : across) p += Vector3d(0.08, 0, -0.1);
      all = upright;
      all.insert(all.end(), across.begin(), across.end());
      const int first = static_cast<int>(geometry->bodies.size());
      geometry->bodies.push_back(bodyAt(hand, "hook" + std::to_string(first), all, -1));
      geometry->bodies.back().parts = 2;
      geometry->bodies.push_back(bodyAt(hand, "upright", upright, first));
      geometry->bodies.push_back(bodyAt(hand, "across", across, first));
    }
  }

  /// Both arms stretched forward, where hooks and crate meet.
  VectorXd elbows() const {
    VectorXd q = problem.kinematics->neutral();
    for (const char* joint : {"LARM_JOINT0", "RARM_JOINT0"}) q[problem.kinematics->coordinate(joint)] -= 0.7;
    for (const char* joint : {"LARM_JOINT3", "RARM_JOINT3"}) q[problem.kinematics->coordinate(joint)] -= 1.2;
    return q;
  }
  VectorXd reaching(Random& random) const {
    return elbows() + 0.4 * randomConfiguration(*problem.kinematics, random);
  }

  std::unique_ptr<CollisionConstraints> rows(const std::vector<CheckedPair>& pairs,
                                             ConstraintOptions options = {}) const {
    const auto crate = std::make_shared<fcl::Boxd>(0.3, 0.6, 0.3);
    Kinematics::State state = problem.kinematics->makeState();
    problem.kinematics->forward(elbows(), state);
    const Eigen::Isometry3d& hand = state.link[static_cast<std::size_t>(geometry->bodies[0].link)];
    const fcl::CollisionObjectd object(crate, Eigen::Matrix3d::Identity(),
                                       hand.translation() + Vector3d(0.3, 0, 0));
    options.obstacles = {obstacleOf(object, "crate")};
    return std::make_unique<CollisionConstraints>(problem.kinematics, geometry, pairs, options);
  }
};

// The rows, with those of the whole bodies: 0 hooks, 1 to 4 their parts, 5 hook and crate, 6 and 7 its parts.
struct Group {
  int whole, first, last;
};
constexpr Group kGroups[] = {{0, 1, 5}, {5, 6, 8}};

}  // namespace

TEST_CASE(
    "whole bodies speak while they are far, their parts near, and never more than the parts' distance") {
  TwoHooks hooks;
  ConstraintOptions options;
  options.handOver = kHandOver;
  const auto rows = hooks.rows(hooks.parts, options), exact = hooks.rows(hooks.parts),
             whole = hooks.rows(hooks.whole);
  REQUIRE(rows->rows() == 8);
  CHECK(rows->name(0) == "hook0 - hook3");
  CHECK(rows->name(5) == "hook0 - crate");
  Random random(2);
  VectorXd d(8), dExact(6), dWhole(2);
  MatrixXd J(8, rows->columns()), jExact(6, rows->columns()), jWhole(2, rows->columns());
  int far = 0, near = 0, between = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const VectorXd q = hooks.reaching(random);
    rows->evaluate(q, d, J);
    exact->evaluate(q, dExact, jExact);
    whole->evaluate(q, dWhole, jWhole);
    for (int g = 0; g < 2; ++g) {
      const Group& group = kGroups[g];
      const double apart = dWhole[g], constant = 0.75 * kHandOver;
      double least = d[group.whole], truth = 1e9;
      for (int row = group.first; row < group.last; ++row) {
        const double own = dExact[row - 1 - g];
        // Rounding. Deeper than the margins, a depth is only as exact as the expanding polytope.
        if (apart > -0.004) CHECK(own >= apart - 1e-14);
        CHECK(d[row] <= own + 1e-14);
        if (apart <= kHandOver / 2 && own <= kHandOver / 2) {
          CHECK(d[row] == Approx(own).margin(1e-14));
          CHECK((J.row(row) - jExact.row(row - 1 - g)).norm() <= 1e-11);
        }
        if (apart >= kHandOver) {
          CHECK(d[row] == constant);
          CHECK(J.row(row).isZero(0));
          // Not queried, so nothing of an earlier query is left.
          CHECK(rows->answer(row).status == DistanceStatus::invalid);
          CHECK(rows->answer(row).lower == -std::numeric_limits<double>::infinity());
          CHECK(rows->answer(row).upper == std::numeric_limits<double>::infinity());
        }
        least = std::min(least, d[row]);
        truth = std::min(truth, own);
      }
      CHECK(least <= truth + 1e-14);  // never clear where the true distance is not
      CHECK(least >= std::min(truth, constant) - 0.05 * kHandOver);  // the largest loss by the bend
      if (apart >= kHandOver) {
        CHECK(d[group.whole] == Approx(apart).margin(1e-14));
        CHECK((J.row(group.whole) - jWhole.row(g)).norm() <= 1e-11);
        ++far;
      } else if (apart <= kHandOver / 2) {
        CHECK(d[group.whole] == Approx(constant).margin(1e-15));
        CHECK(J.row(group.whole).isZero(0));
        ++near;
      } else {
        ++between;
      }
    }
  }
  CHECK(far > 300);
  CHECK(near > 300);
  CHECK(between > 100);
}

TEST_CASE("through the hand-over no row and no gradient changes faster than its bound") {
  TwoHooks hooks;
  ConstraintOptions options;
  options.handOver = kHandOver;
  const auto rows = hooks.rows(hooks.parts, options);
  Random random(6);
  RowRates rates = rows->makeRates(), before = rates;
  MatrixXd J(8, rows->columns()), last = J;
  long through = 0, compared = 0;
  double tightest = 0;
  for (int sweep = 0; sweep < 12; ++sweep) {
    const VectorXd start = hooks.reaching(random), end = hooks.reaching(random);
    constexpr int kSteps = 4000;
    const VectorXd qd = end - start;  // velocity of a sweep that takes one second
    constexpr double step = 1.0 / kSteps;
    VectorXd bound = VectorXd::Zero(8), lastBound = bound;
    for (int k = 0; k <= kSteps; ++k) {
      rows->evaluate(start + k * step * qd, qd, rates, J);
      for (int row = 0; row < 8; ++row) {
        bound[row] = rates.d[row] < 0.002 ? INFINITY : rows->gradientRateBound(row);
        if (k == 0) continue;
        const double most = std::max(bound[row], lastBound[row]) * step;
        if (!std::isfinite(most)) continue;
        const double changed = (J.row(row) - last.row(row)).norm();
        // The speed is that of J. Its own change bounds the error of the trapezoid rule.
        CHECK(std::abs(rates.d[row] - before.d[row] - step * (rates.speed[row] + before.speed[row]) / 2) <=
              1.05 * most * step * qd.norm() / 4 + 1e-13);
        CHECK(changed <= 1.05 * most + 1e-9);  // the bound itself changes over a step
        if (most > 1e-6) tightest = std::max(tightest, changed / most);
        ++compared;
      }
      if (k > 0)
        for (const Group& group : kGroups)
          through += J.row(group.whole).isZero(0) != last.row(group.whole).isZero(0);
      before = rates;
      last = J;
      lastBound = bound;
    }
  }
  CHECK(through > 4);
  CHECK(compared > 100000);
  CHECK(tightest > 0.2);
}

TEST_CASE("hand-over: batches, single Hessians and a caller that goes back and forth give the same rows") {
  TwoHooks hooks;
  ConstraintOptions options;
  options.handOver = kHandOver;
  options.influence = 0.3;
  const auto rows = hooks.rows(hooks.parts, options);
  ConstraintsBatch batch(*hooks.rows(hooks.parts, options), 3);
  Random random(9);
  VectorXd d(8), other(8), along(rows->columns()), weights(8);
  MatrixXd full(rows->columns(), rows->columns());
  for (int trial = 0; trial < 100; ++trial) {
    const VectorXd q = hooks.reaching(random), v = randomDirection(q.size(), random);
    rows->evaluate(q, d);
    batch.evaluate(q, Sequence::independent, other);
    CHECK((d - other).norm() <= 1e-13);
    for (int row = 0; row < 8; ++row) {
      if (d[row] < 0.002) continue;  // deep rows have no Hessian to compare
      weights = VectorXd::Unit(8, row);
      rows->hessianVector(q, weights, v, along);
      rows->hessian(q, row, full);
      // Two closed forms, in different orders; differences if an answer has none.
      CHECK((full * v - along).norm() <= 1e-9 * (1 + along.norm()));
    }
  }
  options.handOver = 0;
  CHECK_THROWS_WITH(hooks.rows(hooks.parts, options), Catch::Contains("handOver"));
}
