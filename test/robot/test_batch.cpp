// Batches give the same results as single configurations, for any number of threads.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/batch.h"
#include "fcl_stpbv/robot/motion_check.h"
#include "test/reference/robots.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

template <class Type>
struct Tag {
  using type = Type;
};

using Verdicts = Eigen::Array<bool, Eigen::Dynamic, 1>;

MatrixXd configurations(const Kinematics& kinematics, Sequence sequence, int count) {
  Random random(3);
  MatrixXd q(kinematics.size(), count);
  for (int i = 0; i < count; ++i)
    q.col(i) = sequence == Sequence::independent || i == 0
                   ? randomConfiguration(kinematics, random)
                   : VectorXd(q.col(i - 1) + 0.01 * randomDirection(q.rows(), random));
  return q;
}

}  // namespace

TEST_CASE("a batch's distances, Jacobians and verdicts are the same for one, two and five threads") {
  const Problem p = problem(robots()[0]);
  const CollisionConstraints rows(p.kinematics, p.geometry, p.pairs);
  const CollisionChecker checker(p.kinematics, p.geometry, p.pairs, {}, 0.005);
  for (const Sequence sequence : {Sequence::independent, Sequence::path}) {
    const int count = 300;
    const MatrixXd q = configurations(*p.kinematics, sequence, count);
    MatrixXd d(rows.rows(), count), values(rows.nonZeros(), count), otherD = d, otherValues = values;
    Verdicts hit(count), otherHit(count);
    VectorXd least(count), otherLeast(count);
    ConstraintsBatch one(rows, 1);
    CheckerBatch checkOne(checker, 1);
    CHECK(one.evaluateValues(q, sequence, d, values));
    checkOne.collides(q, sequence, hit);
    checkOne.minDistance(q, sequence, least);
    for (const int threads : {2, 5}) {
      ConstraintsBatch several(rows, threads);
      CheckerBatch checkSeveral(checker, threads);
      CHECK(several.evaluateValues(q, sequence, otherD, otherValues));
      checkSeveral.collides(q, sequence, otherHit);
      checkSeveral.minDistance(q, sequence, otherLeast);
      CHECK(otherD == d);  // bit by bit
      CHECK(otherValues == values);
      CHECK((otherHit == hit).all());
      CHECK(otherLeast == least);
    }
    CHECK(hit.any());
    CHECK((sequence == Sequence::path || !hit.all()));

    CollisionConstraints alone(p.kinematics, p.geometry, p.pairs);
    CollisionChecker aloneChecker = checker;
    VectorXd single(rows.rows());
    for (int i = 0; i < count; ++i) {
      alone.evaluate(q.col(i), single);
      for (Eigen::Index row = 0; row < single.size(); ++row)
        if (alone.answer(static_cast<int>(row)).status == DistanceStatus::exact)
          CHECK(d(row, i) == Approx(single[row]).margin(1e-13));  // because the starts differ
      CHECK(hit[i] == aloneChecker.collides(q.col(i)));
    }
  }
}

TEST_CASE("in a batch a configuration that is not finite is not clear and leaves the others alone") {
  const Problem p = problem(robots()[0]);
  ConstraintsBatch batch(CollisionConstraints(p.kinematics, p.geometry, p.pairs), 2);
  CheckerBatch checker(CollisionChecker(p.kinematics, p.geometry, p.pairs), 2);
  MatrixXd q = configurations(*p.kinematics, Sequence::independent, 40), d(p.pairs.size(), 40), whole = d;
  Verdicts hit(40), wholeHit(40);
  REQUIRE(batch.evaluate(q, Sequence::independent, whole));
  checker.collides(q, Sequence::independent, wholeHit);
  q(3, 17) = std::nan("");
  CHECK_FALSE(batch.evaluate(q, Sequence::independent, d));
  checker.collides(q, Sequence::independent, hit);
  CHECK(hit[17]);
  CHECK((d.col(17).array() == std::numeric_limits<double>::lowest()).all());
  for (int i = 0; i < 40; ++i)
    if (i != 17) CHECK((hit[i] == wholeHit[i] && d.col(i) == whole.col(i)));
}

TEST_CASE("a batch's smooth constraints have their rows too") {
  const Problem p = problem(robots()[0]);
  ConstraintOptions options;
  SmoothConstraint sum;
  sum.name = "sum";
  sum.coordinates = {1, 2};
  sum.value = [](const Eigen::Ref<const VectorXd>& q, double* gradient) {
    if (gradient) gradient[0] = gradient[1] = 1;
    return q[1] + q[2];
  };
  options.smooth.push_back(sum);
  const CollisionConstraints rows(p.kinematics, p.geometry, p.pairs, options);
  ConstraintsBatch batch(rows, 2);
  const MatrixXd q = configurations(*p.kinematics, Sequence::path, 100);
  MatrixXd d(rows.rows(), 100), values(rows.nonZeros(), 100);
  REQUIRE(batch.evaluateValues(q, Sequence::path, d, values));
  for (int i = 0; i < 100; ++i) CHECK(d(rows.rows() - 1, i) == q(1, i) + q(2, i));
  CHECK((values.bottomRows(2).array() == 1).all());
}

TEST_CASE("what checks a robot can be moved, and replaced by another one") {
  const auto movable = [](auto... type) {
    return ((std::is_nothrow_move_constructible_v<typename decltype(type)::type> &&
             std::is_nothrow_move_assignable_v<typename decltype(type)::type>)&&...);
  };
  CHECK(movable(Tag<CollisionChecker>(), Tag<MotionCheck>(), Tag<ConstraintsBatch>(), Tag<CheckerBatch>(),
                Tag<LinkParts>()));
  const Problem first = problem(robots()[0]), second = problem(robots()[1]);
  CollisionChecker checker(first.kinematics, first.geometry, first.pairs);
  CheckerBatch batch(checker, 2);
  CollisionChecker other(second.kinematics, second.geometry, second.pairs);
  batch = CheckerBatch(other, 3);
  const MatrixXd q = configurations(*second.kinematics, Sequence::independent, 100);
  Verdicts hit(q.cols());
  batch.collides(q, Sequence::independent, hit);
  checker = std::move(other);
  for (Eigen::Index i = 0; i < q.cols(); ++i) CHECK(checker.collides(q.col(i)) == hit[i]);
}

TEST_CASE("matrices of a wrong size and no threads are refused") {
  const Problem p = problem(robots()[0]);
  const CollisionConstraints rows(p.kinematics, p.geometry, p.pairs);
  const CollisionChecker checker(p.kinematics, p.geometry, p.pairs);
  CHECK_THROWS_AS(ConstraintsBatch(rows, 0), Error);
  CHECK_THROWS_AS(CheckerBatch(checker, -1), Error);
  ConstraintsBatch batch(rows, 1);
  CheckerBatch check(checker, 1);
  MatrixXd q(rows.columns(), 5), d(rows.rows(), 4), right(rows.rows(), 5);
  MatrixXd transposed = q.transpose();
  Verdicts hit(4);
  q.setZero();
  CHECK_THROWS_AS(batch.evaluate(q, Sequence::path, d), Error);
  CHECK_THROWS_AS(batch.evaluate(transposed, Sequence::path, right), Error);
  CHECK_THROWS_AS(check.collides(q, Sequence::path, hit), Error);
}
