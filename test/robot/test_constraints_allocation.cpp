// An evaluation allocates nothing after construction: this program counts every operator new.
#include <catch2/catch.hpp>

#include "fcl_stpbv/robot/batch.h"
#include "fcl_stpbv/robot/velocity_damper.h"
#include "test/reference/allocations.h"
#include "test/reference/robots.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

TEST_CASE(
    "distances, Jacobians, rates, Hessians, damper's rows and verdicts of a humanoid allocate nothing") {
  const TestRobot robot = robots()[0];
  LoadedRobot loaded = load(robot);
  const auto kinematics = std::make_shared<const Kinematics>(loaded.model);
  const auto geometry = std::make_shared<const RobotGeometry>(std::move(loaded.geometry));
  const Srdf srdf = loadSrdf(robot.srdf, *loaded.model);
  const std::vector<CheckedPair> pairs = selfPairs(*loaded.model, *geometry, &srdf);
  CollisionConstraints constraints(kinematics, geometry, pairs);
  CollisionChecker checker(kinematics, geometry, pairs, {}, 0.01);
  Eigen::VectorXd d(constraints.rows()), values(constraints.nonZeros()), q(constraints.columns()), out(q),
      v(q);
  Eigen::MatrixXd dense(constraints.rows(), constraints.columns());
  CollisionConstraints::SparseJacobian sparse = constraints.makeJacobian();
  v.setOnes();
  Random random(1);
  RowRates rates = constraints.makeRates();
  CollisionConstraints::SparseHessian lower = constraints.makeHessian();
  Eigen::MatrixXd full(constraints.columns(), constraints.columns());
  constraints.hessian(kinematics->neutral(), d.setOnes(), lower);  // makes room for the following calls
  DamperOptions options;
  options.all.influence = 0.3;
  VelocityDamper slow(constraints, options);
  options.level = DamperLevel::barrier;
  VelocityDamper barrier(constraints, options);
  const long before = allocations;
  for (int i = 0; i < 50; ++i) {
    for (Eigen::Index k = 0; k < q.size(); ++k)
      q[k] = random.uniform(kinematics->lower()[k], kinematics->upper()[k]);
    constraints.evaluate(q, d);
    constraints.evaluateValues(q, d, values);
    constraints.evaluate(q, d, sparse);
    constraints.evaluate(q, d, dense);
    constraints.hessianVector(q, d, v, out);
    constraints.hessian(q, d, lower);
    constraints.hessian(q, i, full);
    slow.update(q, v);
    barrier.update(q, v);
    constraints.evaluateValues(q, v, rates, values);
    constraints.evaluate(q, v, rates, sparse);
    constraints.evaluate(q, v, rates, dense);
    checker.collides(q);
    checker.allHits(q);
    checker.minDistance(q);
  }
  CHECK(allocations == before);
}

TEST_CASE("a batch in two threads allocates nothing") {
  const Problem p = problem(robots()[0]);
  ConstraintsBatch constraints(CollisionConstraints(p.kinematics, p.geometry, p.pairs), 2);
  CheckerBatch checker(CollisionChecker(p.kinematics, p.geometry, p.pairs), 2);
  Eigen::MatrixXd q(p.kinematics->size(), 200), d(p.pairs.size(), 200);
  Eigen::Array<bool, Eigen::Dynamic, 1> hit(200);
  Random random(2);
  for (Eigen::Index i = 0; i < 200; ++i) q.col(i) = randomConfiguration(*p.kinematics, random);
  const long before = allocations;
  constraints.evaluate(q, Sequence::independent, d);
  checker.collides(q, Sequence::independent, hit);
  CHECK(allocations == before);
}
