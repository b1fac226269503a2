// bound_soak BOXES ROBOT.urdf...: tests the bound of proofs on a robot of primitives and on these robots,
// with eight samples per box. Ends with status 1 if a distance is below its bound.
#include <cstdio>
#include <exception>
#include <limits>

#include "test/reference/arguments.h"
#include "test/robot/bound_trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

int main(int argc, char** argv) {
  const Arguments arguments(argc, argv, "[BOXES [ROBOT.urdf ...]]", std::numeric_limits<int>::max());
  const int boxes = arguments.number(1, 10000);
  const std::vector<std::string> robots = arguments.texts(2);
  Random random(1);
  long violations = 0;
  const auto run = [&](const char* name, const ProofScene& scene) {
    const BoundTrials trials = tryBounds(scene, movingPairs(scene), boxes, random);
    std::printf(
        "%-12s %ld samples, %ld violations, tightest %.3g m, %.0f %% of the bounds above half the distance\n",
        name, trials.samples, trials.violations, trials.tightest, 100 * trials.useful);
    violations += trials.violations;
  };
  try {
    run("primitives", primitiveScene());
    for (const std::string& urdf : robots) {
      const auto model = std::make_shared<const RobotModel>(loadUrdf(urdf));
      const auto geometry = std::make_shared<const RobotGeometry>(loadGeometry(*model));
      run(model->name.c_str(), proofScene(std::make_shared<const Kinematics>(model), geometry, {}, 0));
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bound_soak: %s\n", error.what());
    return 2;
  }
  return violations > 0;
}
