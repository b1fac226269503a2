// The code of docs/robot.md and docs/posture.md, for the robot in data/hrp2_style. Run it in that folder.
#include <cstdio>

#include "docs/examples/reported.h"
#include "fcl_stpbv/posture/find_posture.h"
#include "fcl_stpbv/posture/task.h"
#include "fcl_stpbv/robot/batch.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/robot_model.h"
#include "fcl_stpbv/robot/srdf.h"

using namespace fcl_stpbv;

namespace {

/// A user-defined constraint: the first coordinate is at least -1.
class Mine : public PostureRows {
 public:
  Kind kind() const override { return Kind::atLeast; }
  int size() const override { return 1; }
  std::string name(int) const override { return "mine"; }
  void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values,
                Eigen::Ref<RowMatrix> jacobian) override {
    values[0] = at.x[0] + 1;
    jacobian(0, 0) = 1;
  }
};

int run() {
  // clang-format off
auto robot = std::make_shared<const RobotModel>(loadUrdf("hrp2_style.urdf"));
auto srdf  = std::make_shared<const Srdf>(loadSrdf("hrp2_style.srdf", *robot));
GeometryOptions options;
options.radii = {0.01, 10};                                        // r, R of every link
auto geometry   = std::make_shared<const RobotGeometry>(loadGeometry(*robot, options));
auto kinematics = std::make_shared<const Kinematics>(robot);       // or BaseMotion::floating
  // clang-format on

  RobotGeometry bodies = loadGeometry(*robot, options);
  // clang-format off
coverPrimitives(selfPairs(*robot, bodies, srdf.get()), bodies);    // bodies: a RobotGeometry, or one and that of a scene
  // clang-format on

  Eigen::VectorXd q = Eigen::VectorXd::Zero(kinematics->size());
  // clang-format off
CollisionConstraints constraints(kinematics, geometry, selfPairs(*robot, *geometry, srdf.get()));
auto jacobian = constraints.makeJacobian();          // sparse, its structure never changes
Eigen::VectorXd d(constraints.rows());
constraints.evaluate(q, d, jacobian);                // d(q), J(q)
  // clang-format on
  std::printf("%d pairs, closest %g m\n", static_cast<int>(d.size()), d.minCoeff());

  const Eigen::Index many = 100;
  const Eigen::MatrixXd samples = q.replicate(1, many), path = samples;
  Eigen::Array<bool, Eigen::Dynamic, 1> hits(many);
  Eigen::MatrixXd distances(constraints.rows(), many), values(constraints.nonZeros(), many);
  // clang-format off
CollisionChecker checker(kinematics, geometry, selfPairs(*robot, *geometry, srdf.get()), {}, 0.005);   // obstacles; margin 5 mm
checker.collides(q);                                 // yes or no
if (auto hit = checker.firstHit(q)) checker.name(hit->pair);   // of its two bodies; says so if q is no configuration
checker.minDistance(q);                              // least of all pairs

CheckerBatch batch(checker, 2);                      // two threads
batch.collides(samples, Sequence::independent, hits);          // one configuration a column
ConstraintsBatch rows(constraints, 2);
rows.evaluateValues(path, Sequence::path, distances, values);  // d and J along a path
  // clang-format on
  std::printf("%d of %d collide\n", static_cast<int>(hits.count()), static_cast<int>(many));

  auto mine = std::make_shared<Mine>();
  // clang-format off
auto fridge = std::make_shared<const RobotModel>(loadUrdf("../fridge/fridge.urdf"));
PostureScene scene{robot, geometry, srdf, obstaclesOf(fridge, loadGeometry(*fridge, options))};
PostureSetup setup = setUp(loadTask("../fridge/pick_can.json"), scene);
setup.problem->add(mine);                            // a constraint of your own, from PostureRows
Posture posture = findPosture(setup);                // throws Error only for a start of another size
  // clang-format on
  std::printf("%s\n", posture.feasible ? "found a posture" : "found none");
  return posture.feasible ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) { return reported(argc, argv, run); }
