// Time of d(q) and J(q) of all self pairs of a robot, and of FCL's distances: median and 99th percentile over
// random walks. For the table of docs/robot.md.
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>

#include "fcl_stpbv/robot/constraints.h"
#include "test/reference/random_walk.h"
#include "tools/bench/measurement.h"
#include "tools/bench/robot_argument.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using benchmark::significant;

namespace {

using Evaluate = std::function<void(const Eigen::VectorXd&)>;

struct Way {
  const char* what;
  const char* steps;  ///< small or large
  Evaluate evaluate;
};

// Times (us) of the configurations of a walk, sorted.
std::vector<double> times(const Kinematics& kinematics, const Way& way, int count) {
  const Eigen::MatrixXd walk =
      test::randomWalk(kinematics, way.steps[0] == 's' ? test::kSmallStep : test::kRandomStep, count);
  std::vector<double> result;
  Eigen::VectorXd q;
  for (Eigen::Index i = 0; i < walk.cols(); ++i) {
    q = walk.col(i);
    const double start = benchmark::threadTime();
    way.evaluate(q);
    result.push_back(1e-3 * (benchmark::threadTime() - start));
  }
  std::sort(result.begin(), result.end());
  return result;
}

// FCL's distances of the polyhedra, as FCL's users compute them.
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

struct Arguments {
  test::TestRobot robot;
  int configurations = 3000, turns = 3;
};

void measure(const Arguments& arguments, benchmark::Measurement& result) {
  const auto [model, kinematics, geometry, pairs] = test::problem(arguments.robot);
  ConstraintOptions near;
  near.influence = 0.1;
  CollisionConstraints all(kinematics, geometry, pairs), some(kinematics, geometry, pairs, near);
  Eigen::VectorXd d(all.rows()), values(all.nonZeros()), weights = Eigen::VectorXd::Ones(all.rows()),
                                                         v = Eigen::VectorXd::Ones(all.columns()), out = v;
  RowRates rates = all.makeRates(), someRates = rates;
  CollisionConstraints::SparseHessian lower = all.makeHessian();
  PlainFcl plain(*kinematics, *geometry, pairs);
  const Evaluate jacobian = [&](const Eigen::VectorXd& q) { all.evaluateValues(q, d, values); };
  const std::vector<Way> ways{
      {"d and J", "small", jacobian},
      {"d and J", "large", jacobian},
      {"d and J, influence 0.1 m", "small",
       [&](const Eigen::VectorXd& q) { some.evaluateValues(q, d, values); }},
      {"d, J and rates", "small", [&](const Eigen::VectorXd& q) { all.evaluateValues(q, v, rates, values); }},
      {"d, J and rates, influence 0.1 m", "small",
       [&](const Eigen::VectorXd& q) { some.evaluateValues(q, v, someRates, values); }},
      {"Lagrangian's Hessian", "small", [&](const Eigen::VectorXd& q) { all.hessian(q, weights, lower); }},
      {"Hessian times vector", "small",
       [&](const Eigen::VectorXd& q) { all.hessianVector(q, weights, v, out); }},
      {"`fcl::distance` of the hulls", "small", std::ref(plain)},
      {"`fcl::distance` of the hulls", "large", std::ref(plain)}};
  result.about = {
      {"robot", model->name}, {"pairs", all.rows()}, {"configurations", arguments.configurations}};
  for (const Way& way : ways)
    result.rows.push_back({{"what", way.what}, {"steps", way.steps}, {"us_p50", {}}, {"us_p99", {}}});
  // The ways take turns, so that a slowdown of the machine affects all of them.
  for (int turn = 0; turn < arguments.turns; ++turn)
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const std::vector<double> us = times(*kinematics, ways[k], arguments.configurations);
      result.rows[k]["us_p50"].push_back(significant(us[us.size() / 2], 3));
      result.rows[k]["us_p99"].push_back(significant(us[us.size() * 99 / 100], 3));
    }
  result.print();
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app("Time of d(q), J(q) and second derivatives of all pairs of a robot, beside FCL",
                     "constraints_benchmark");
  Arguments arguments;
  benchmark::describeRobot(app, arguments.robot);
  app.option("--configurations", arguments.configurations, "of each random walk").whole(1).shown();
  app.option("--turns", arguments.turns, "walks of each way, in turns").whole(1).shown();
  return benchmark::runBenchmark(app, argc, argv, "constraints",
                                 [&](benchmark::Measurement& result) { measure(arguments, result); });
}
