// Questions about the HRP-2-style robot whose instructions are counted: robot_queries CONFIGURATIONS
#include <cstdio>

#include "fcl_stpbv/robot/batch.h"
#include "test/reference/arguments.h"
#include "test/reference/counted.h"
#include "test/reference/random_walk.h"
#include "test/reference/robots.h"
#include "test/reference/source_folder.h"

using namespace fcl_stpbv;
using Eigen::MatrixXd;

int main(int argc, char** argv) {
  const int count = test::Arguments(argc, argv, "[CONFIGURATIONS]", 1).number(1, 320);
  const std::string file = test::sourceFolder() + "/data/hrp2_style/hrp2_style";
  const test::Problem robot = test::problem({"hrp2_style", file + ".urdf", file + ".srdf", {}});
  const MatrixXd small = test::randomWalk(*robot.kinematics, test::kSmallStep, count),
                 random = test::randomWalk(*robot.kinematics, test::kRandomStep, count);
  CollisionConstraints rows(robot.kinematics, robot.geometry, robot.pairs);
  CollisionChecker checker(robot.kinematics, robot.geometry, robot.pairs);
  ConstraintsBatch rowsBatch(rows, 1);
  CheckerBatch checkerBatch(checker, 1);
  MatrixXd d(rows.rows(), count), values(rows.nonZeros(), count);
  Eigen::Array<bool, Eigen::Dynamic, 1> hit(count);

  const auto evaluate = [&](const MatrixXd& q) {
    for (Eigen::Index i = 0; i < count; ++i) rows.evaluateValues(q.col(i), d.col(i), values.col(i));
  };
  const auto check = [&](const MatrixXd& q) {
    for (Eigen::Index i = 0; i < count; ++i) hit[i] = checker.collides(q.col(i));
  };
  test::counted("rows", [&] { evaluate(small); });
  test::counted("small", [&] { check(small); });
  test::counted("random", [&] { check(random); });
  test::counted("rows_batch", [&] { rowsBatch.evaluateValues(small, Sequence::path, d, values); });
  test::counted("batch", [&] { checkerBatch.collides(random, Sequence::independent, hit); });
  std::printf("%.17g %d\n", d.sum() + values.sum(), static_cast<int>(hit.count()));
  return 0;
}
