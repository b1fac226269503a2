// Answers without a result: nothing in them may be old, or compare as clear.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "fcl_stpbv/adapter/continuous_collide.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/robot/batch.h"
#include "fcl_stpbv/robot/collision_checker.h"
#include "fcl_stpbv/robot/motion_check.h"
#include "test/reference/robots.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::VectorXd;

namespace {

constexpr double kLowest = std::numeric_limits<double>::lowest();

/// Two balls that slide towards each other.
struct Slide {
  std::shared_ptr<const RobotModel> model = std::make_shared<const RobotModel>(parseUrdf(
      robot(link("a", "<sphere radius=\"0.1\"/>") + link("b") + link("c", "<sphere radius=\"0.1\"/>") +
            joint("turn", "revolute", "a", "b") + joint("way", "prismatic", "b", "c")),
      "slide.urdf"));
  std::shared_ptr<const Kinematics> kinematics = std::make_shared<const Kinematics>(model);
  std::vector<CheckedPair> pairs{{0, 1, false}};

  /// With volumes instead of balls if `smooth` is true.
  std::shared_ptr<const RobotGeometry> geometry(bool smooth) const {
    RobotGeometry bodies = loadGeometry(*model);
    for (Body& body : bodies.bodies)
      if (smooth) body = smoothBody(body.link, body.name, StpBv::build({Eigen::Vector3d::Zero()}, {0.1, 1}));
    return std::make_shared<const RobotGeometry>(std::move(bodies));
  }
  VectorXd at(double way) const {
    VectorXd q = VectorXd::Zero(kinematics->size());
    q[kinematics->coordinate("way")] = way;
    return q;
  }
};

void checkNothing(const DistanceAnswer& answer) {
  const DistanceAnswer none;
  CHECK(answer.status == DistanceStatus::invalid);
  CHECK(answer.distance == -HUGE_VAL);
  CHECK(answer.lower == -HUGE_VAL);
  CHECK(answer.upper == HUGE_VAL);
  CHECK(answer.normal.isZero(0));
  CHECK((answer.points[0].isZero(0) && answer.points[1].isZero(0)));
  CHECK((answer.gradient[0].isZero(0) && answer.gradient[1].isZero(0)));
  CHECK(answer.patch == none.patch);
  CHECK(answer.element == none.element);
  CHECK_FALSE(answer.continuous);
}

void checkNothing(const RowAnswer& answer) {
  checkNothing(static_cast<const DistanceAnswer&>(answer));
  CHECK(std::isnan(answer.meshDistanceMost));
  CHECK(answer.normalVelocity.isZero(0));
  CHECK((answer.pointVelocity[0].isZero(0) && answer.pointVelocity[1].isZero(0)));
}

/// A smooth constraint on the second coordinate: its value, and its slope in `slope`.
ConstraintOptions smoothBy(double (*value)(double q, double& slope)) {
  ConstraintOptions options;
  options.smooth = {{"curve",
                     {1},
                     [value](const Eigen::Ref<const VectorXd>& q, double* gradient) {
                       double slope;
                       return value(q[1], gradient ? *gradient : slope);
                     },
                     {}}};
  return options;
}

}  // namespace

TEST_CASE(
    "An answer that nothing has filled says nothing, but before the first pair of a scene all is clear") {
  checkNothing(DistanceAnswer());
  checkNothing(RowAnswer());
  checkNothing(MotionAnswer().answer);
  DistanceData data;
  CHECK(data.result.distance == std::numeric_limits<double>::max());
  data.result = DistanceAnswer();
  data.clear();
  CHECK(data.result.distance == std::numeric_limits<double>::max());
}

TEST_CASE("A row without a result has no answer, old or made up") {
  const Slide slide;
  for (const bool smooth : {false, true}) {
    CAPTURE(smooth);
    ConstraintOptions options;
    options.influence = 0.5;
    options.smooth = {{"one", {}, [](const auto&, double*) { return 1.0; }, {}}};
    CollisionConstraints rows(slide.kinematics, slide.geometry(smooth), slide.pairs, options);
    RowRates rates = rows.makeRates();
    VectorXd d(2), values(rows.nonZeros());
    checkNothing(rows.answer(0));
    for (const double way : {0.8, std::nan(""), 1e200}) {
      CAPTURE(way);
      rows.evaluateValues(slide.at(0.3), VectorXd::Ones(2), rates, values);
      CHECK(rows.answer(0).distance == Approx(0.1));
      CHECK(rows.answer(0).status == DistanceStatus::exact);
      checkNothing(rows.answer(1));
      rows.evaluateValues(slide.at(way), VectorXd::Ones(2), rates, values);
      checkNothing(rows.answer(0));
      checkNothing(rows.answer(1));
      CHECK(rates.d[0] == (way == 0.8 ? 0.375 : kLowest));
      rows.evaluate(slide.at(0.3), d);
      rows.evaluate(slide.at(way), d);
      checkNothing(rows.answer(0));
    }
  }
}

TEST_CASE("A Hessian leaves no old answers to the rows that it does not ask") {
  const Slide slide;
  for (const bool smooth : {false, true}) {
    CollisionConstraints rows(slide.kinematics, slide.geometry(smooth), {{0, 1, false}, {1, 0, false}});
    VectorXd d(2), weights(2);
    weights << 0, 1;
    CollisionConstraints::SparseHessian lower = rows.makeHessian();
    rows.evaluate(slide.at(0.9), d);
    CHECK(rows.hessian(slide.at(0.3), weights, lower));
    checkNothing(rows.answer(0));
    CHECK(rows.answer(1).distance == Approx(0.1));
    Eigen::MatrixXd full(2, 2);
    rows.evaluate(slide.at(0.9), d);
    CHECK(rows.hessian(slide.at(0.3), 0, full));
    checkNothing(rows.answer(1));
    CHECK(rows.answer(0).distance == Approx(0.1));
  }
}

TEST_CASE("A smooth constraint without a value is a row without a distance") {
  const Slide slide;
  const ConstraintOptions options = smoothBy([](double q, double& slope) {
    slope = 0.5 / std::sqrt(q);
    return std::sqrt(q);
  });
  CollisionConstraints rows(slide.kinematics, slide.geometry(true), slide.pairs, options);
  const VectorXd q = slide.at(-0.5), v = VectorXd::Ones(2);
  RowRates rates = rows.makeRates();
  VectorXd d(2), values(rows.nonZeros()), product(2);
  CHECK(rows.evaluateValues(q, d, values));
  CHECK(d[1] == kLowest);
  CHECK(values[rows.rowStart()[1]] == 0);
  CHECK(rows.evaluateValues(q, v, rates, values));
  CHECK(rates.d[1] == kLowest);
  CHECK(values[rows.rowStart()[1]] == 0);
  CHECK(rates.speed[1] == 0);
  CHECK(rates.drift[1] == 0);
  CHECK(rows.hessianVector(q, v, v, product));
  CHECK(product.allFinite());
  ConstraintsBatch batch(rows, 1);
  Eigen::MatrixXd all(2, 1);
  CHECK(batch.evaluate(q, Sequence::independent, all));
  CHECK(all(1, 0) == kLowest);
  CHECK(rows.evaluateValues(slide.at(0.25), rates.d, values));
  CHECK(rates.d[1] == 0.5);
}

TEST_CASE("Where a smooth constraint ends, the missing side is not taken for a change of its gradient") {
  const Slide slide;
  const ConstraintOptions options = smoothBy([](double q, double& slope) {
    slope = 3;
    return q < 0 ? std::nan("") : 3 * q;
  });
  CollisionConstraints rows(slide.kinematics, slide.geometry(true), {}, options);
  const VectorXd v = VectorXd::Ones(2), weight = VectorXd::Ones(1);
  RowRates rates = rows.makeRates();
  VectorXd values(rows.nonZeros()), product(2);
  Eigen::MatrixXd full(2, 2);
  CollisionConstraints::SparseHessian lower = rows.makeHessian();
  for (const double q : {0.0, 1e-8, 0.1})
    for (const double sign : {1.0, -1.0}) {
      CHECK(rows.evaluateValues(slide.at(q), sign * v, rates, values));
      CHECK(rates.d[0] == 3 * q);
      CHECK(values[0] == 3);
      CHECK(rates.speed[0] == 3 * sign);
      CHECK(rates.drift[0] == 0);
      CHECK(rows.hessianVector(slide.at(q), weight, sign * v, product));
      CHECK(product.norm() == 0);
      CHECK(rows.hessian(slide.at(q), weight, lower));
      CHECK(lower.norm() == 0);
      CHECK(rows.hessian(slide.at(q), 0, full));
      CHECK(full.norm() == 0);
    }
}

TEST_CASE("A motion's answer and least distance are not clear where nothing is known") {
  const Slide slide;
  for (const bool smooth : {false, true}) {
    MotionCheck check(slide.kinematics, slide.geometry(smooth), slide.pairs);
    CollisionChecker checker(slide.kinematics, slide.geometry(smooth), slide.pairs);
    const VectorXd good = slide.at(0.3);
    for (const VectorXd& bad : {slide.at(std::nan("")), slide.at(1e200), VectorXd(VectorXd::Zero(3))}) {
      CAPTURE(smooth, bad.transpose());
      CHECK(check.answer(0, good).distance == Approx(0.1));
      checkNothing(check.answer(0, bad));
      CHECK(checker.minDistance(bad) == kLowest);
      for (const auto& [from, to] : {std::pair(good, bad), std::pair(bad, bad)}) {
        std::vector<Approach> best;
        CHECK_FALSE(check.closest(from, to, 1e-3, 0, best));
        REQUIRE(best.size() == 1);
        CHECK(best[0].distance == -HUGE_VAL);
      }
    }
  }
}
