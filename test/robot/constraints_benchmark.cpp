// Time of d(q) and J(q) of all self pairs of a robot: median and 99th percentile over random walks.
//   constraints_benchmark ROBOT.urdf [ROBOT.srdf] [PACKAGE_PATH]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>

#include "fcl_stpbv/robot/constraints.h"
#include "test/shapes.h"

using namespace fcl_stpbv;

namespace {

// Each configuration is `step` of the joints' ranges away from the last one.
void measure(CollisionConstraints& constraints, const Kinematics& kinematics, double step, const char* what) {
  test::Random random(1);
  Eigen::VectorXd d(constraints.rows()), values(constraints.nonZeros()), q = kinematics.neutral();
  std::vector<double> times;
  for (int i = 0; i < 3000; ++i) {
    for (int k = 0; k < q.size(); ++k) {
      const double range = kinematics.upper()[k] - kinematics.lower()[k];
      q[k] = std::clamp(q[k] + step * range * random.uniform(-1, 1), kinematics.lower()[k],
                        kinematics.upper()[k]);
    }
    const auto start = std::chrono::steady_clock::now();
    constraints.evaluateValues(q, d, values);
    times.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  std::printf("%-28s %6d pairs, median %8.1f us, 99 %% %8.1f us, %6.0f ns a pair\n", what, constraints.rows(),
              times[times.size() / 2], times[times.size() * 99 / 100],
              times[times.size() / 2] * 1e3 / constraints.rows());
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 2) {
    std::fprintf(stderr, "constraints_benchmark ROBOT.urdf [ROBOT.srdf] [PACKAGE_PATH]\n");
    return 2;
  }
  const auto model = std::make_shared<const RobotModel>(loadUrdf(argv[1]));
  GeometryOptions options;
  if (argc > 3) options.packagePath = {argv[3]};
  const auto geometry = std::make_shared<const RobotGeometry>(loadGeometry(*model, options));
  const auto kinematics = std::make_shared<const Kinematics>(model);
  Srdf srdf;
  const bool given = argc > 2 && argv[2][0] != '\0';
  if (given) srdf = loadSrdf(argv[2], *model);
  const std::vector<CheckedPair> pairs = selfPairs(*model, *geometry, given ? &srdf : nullptr);
  CollisionConstraints all(kinematics, geometry, pairs);
  measure(all, *kinematics, 1e-3, "small steps");
  measure(all, *kinematics, 0.5, "large steps");
  ConstraintOptions near;
  near.influence = 0.1;
  CollisionConstraints some(kinematics, geometry, pairs, near);
  measure(some, *kinematics, 1e-3, "small, influence 0.1 m");
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "constraints_benchmark: %s\n", error.what());
  return 2;
}
