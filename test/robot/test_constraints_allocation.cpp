// An evaluation allocates nothing after construction: this program counts every operator new.
#include <catch2/catch.hpp>

#include "fcl_stpbv/robot/constraints.h"
#include "test/reference/allocations.h"
#include "test/reference/robots.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

TEST_CASE(
    "distances, Jacobians, rates and Hessian products of a humanoid allocate nothing, with threads or "
    "without") {
  const TestRobot robot = robots()[0];
  LoadedRobot loaded = load(robot);
  const auto kinematics = std::make_shared<const Kinematics>(loaded.model);
  const auto geometry = std::make_shared<const RobotGeometry>(std::move(loaded.geometry));
  const Srdf srdf = loadSrdf(robot.srdf, *loaded.model);
  for (const int threads : {1, 2}) {
    ConstraintOptions options;
    options.threads = threads;
    CollisionConstraints constraints(kinematics, geometry, selfPairs(*loaded.model, *geometry, &srdf),
                                     options);
    Eigen::VectorXd d(constraints.rows()), values(constraints.nonZeros()), q(constraints.columns()), out(q),
        v(q);
    Eigen::MatrixXd dense(constraints.rows(), constraints.columns());
    CollisionConstraints::SparseJacobian sparse = constraints.makeJacobian();
    v.setOnes();
    Random random(1);
    RowRates rates = constraints.makeRates();
    const long before = allocations;
    for (int i = 0; i < 50; ++i) {
      for (Eigen::Index k = 0; k < q.size(); ++k)
        q[k] = random.uniform(kinematics->lower()[k], kinematics->upper()[k]);
      constraints.evaluate(q, d);
      constraints.evaluateValues(q, d, values);
      constraints.evaluate(q, d, sparse);
      constraints.evaluate(q, d, dense);
      constraints.hessianVector(q, d, v, out);
      constraints.evaluateValues(q, v, rates, values);
      constraints.evaluate(q, v, rates, sparse);
      constraints.evaluate(q, v, rates, dense);
    }
    CHECK(allocations == before);
  }
}
