// bound_soak BOXES ROBOT.urdf...: the bound of proofs on a robot of primitives and on these, eight samples a
// box; ends with 1 if a distance is below its bound.
#include <cstdio>
#include <cstdlib>

#include "test/robot/bound_trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

int main(int argc, char** argv) {
  const int boxes = argc > 1 ? std::atoi(argv[1]) : 10000;
  Random random(1);
  long violations = 0;
  const auto run = [&](const char* name, const ProofScene& scene) {
    const BoundTrials trials = tryBounds(scene, movingPairs(scene), boxes, random);
    std::printf(
        "%-12s %ld samples, %ld violations, tightest %.3g m, %.0f %% of the bounds above half the distance\n",
        name, trials.samples, trials.violations, trials.tightest, 100 * trials.useful);
    violations += trials.violations;
  };
  run("primitives", primitiveScene());
  for (int i = 2; i < argc; ++i) {
    const auto model = std::make_shared<const RobotModel>(loadUrdf(argv[i]));
    const auto geometry = std::make_shared<const RobotGeometry>(loadGeometry(*model));
    run(model->name.c_str(), proofScene(std::make_shared<const Kinematics>(model), geometry, {}, 0));
  }
  return violations > 0;
}
