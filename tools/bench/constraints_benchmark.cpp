// Time of d(q) and J(q) of all self pairs of a robot, beside FCL: median and 99th percentile over random
// walks.
//   constraints_benchmark ROBOT.urdf [ROBOT.srdf] [PACKAGE_PATH]
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <functional>

#include "fcl_stpbv/robot/constraints.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;

namespace {

using Evaluate = std::function<void(const Eigen::VectorXd&)>;

// Each configuration is `step` of the joints' ranges away from the last one.
void measure(const Kinematics& kinematics, double step, int rows, const char* what,
             const Evaluate& evaluate) {
  test::Random random(1);
  Eigen::VectorXd q = kinematics.neutral();
  std::vector<double> times;
  for (int i = 0; i < 3000; ++i) {
    for (int k = 0; k < q.size(); ++k) {
      const double range = kinematics.upper()[k] - kinematics.lower()[k];
      q[k] = std::clamp(q[k] + step * range * random.uniform(-1, 1), kinematics.lower()[k],
                        kinematics.upper()[k]);
    }
    const auto start = std::chrono::steady_clock::now();
    evaluate(q);
    times.push_back(
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  std::printf("%-34s %6d pairs, median %8.1f us, 99 %% %8.1f us, %6.0f ns a pair\n", what, rows,
              times[times.size() / 2], times[times.size() * 99 / 100], times[times.size() / 2] * 1e3 / rows);
}

// Distances alone of the polyhedra, as FCL's own users ask for them.
class PlainFcl {
 public:
  PlainFcl(const Kinematics& kinematics, const RobotGeometry& geometry, const std::vector<CheckedPair>& pairs)
      : kinematics_(kinematics), geometry_(geometry), pairs_(pairs), state_(kinematics.makeState()) {}

  void operator()(const Eigen::VectorXd& q) {
    kinematics_.forward(q, state_);
    fcl::DistanceRequestd request;
    for (const CheckedPair& pair : pairs_) {
      const Body& a = geometry_.bodies[static_cast<std::size_t>(pair.body)];
      const Body& b = geometry_.bodies[static_cast<std::size_t>(pair.other)];
      fcl::DistanceResultd result;
      fcl::distance(a.geometry.get(), state_.link[static_cast<std::size_t>(a.link)] * a.pose,
                    b.geometry.get(), state_.link[static_cast<std::size_t>(b.link)] * b.pose, request,
                    result);
    }
  }

 private:
  const Kinematics& kinematics_;
  const RobotGeometry& geometry_;
  const std::vector<CheckedPair>& pairs_;
  Kinematics::State state_;
};

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
  ConstraintOptions near;
  near.influence = 0.1;
  CollisionConstraints all(kinematics, geometry, pairs), some(kinematics, geometry, pairs, near);
  Eigen::VectorXd d(all.rows()), values(all.nonZeros()), weights = Eigen::VectorXd::Ones(all.rows()),
                                                         v = Eigen::VectorXd::Ones(all.columns()), out = v;
  const Evaluate jacobian = [&](const Eigen::VectorXd& q) { all.evaluateValues(q, d, values); };
  measure(*kinematics, 1e-3, all.rows(), "d and J, small steps", jacobian);
  RowRates rates = all.makeRates(), someRates = rates;
  measure(*kinematics, 1e-3, all.rows(), "d, J and rates, small steps",
          [&](const Eigen::VectorXd& q) { all.evaluateValues(q, v, rates, values); });
  measure(*kinematics, 0.5, all.rows(), "d and J, large steps", jacobian);
  measure(*kinematics, 1e-3, all.rows(), "d and J, small, influence 0.1 m",
          [&](const Eigen::VectorXd& q) { some.evaluateValues(q, d, values); });
  measure(*kinematics, 1e-3, all.rows(), "d, J and rates, influence 0.1 m",
          [&](const Eigen::VectorXd& q) { some.evaluateValues(q, v, someRates, values); });
  CollisionConstraints::SparseHessian lower = all.makeHessian();
  measure(*kinematics, 1e-3, all.rows(), "Lagrangian's Hessian, small steps",
          [&](const Eigen::VectorXd& q) { all.hessian(q, weights, lower); });
  measure(*kinematics, 1e-3, all.rows(), "Hessian times vector, small steps",
          [&](const Eigen::VectorXd& q) { all.hessianVector(q, weights, v, out); });
  PlainFcl plain(*kinematics, *geometry, pairs);
  measure(*kinematics, 1e-3, all.rows(), "fcl::distance on the hulls, small", std::ref(plain));
  measure(*kinematics, 0.5, all.rows(), "fcl::distance on the hulls, large", std::ref(plain));
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "constraints_benchmark: %s\n", error.what());
  return 2;
}
