// The figures of docs/motion.md: time of an edge between two free postures, and contacts that dense samples
// find but the proof does not. Usage: motion_figures [EDGES [SAMPLES [SEED [ROBOT.urdf [ROBOT.srdf]]]]]
#include <chrono>
#include <cstdio>
#include <exception>

#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/motion_check.h"
#include "test/reference/arguments.h"
#include "test/reference/robots.h"
#include "test/reference/shapes.h"
#include "test/reference/source_folder.h"
#include "tools/bench/measurement.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using Eigen::VectorXd;

namespace {

VectorXd freePosture(const test::Problem& robot, MotionCheck& check, test::Random& random) {
  const VectorXd &low = robot.kinematics->lower(), &high = robot.kinematics->upper();
  for (;;) {
    VectorXd q(low.size());
    for (Eigen::Index k = 0; k < q.size(); ++k) q[k] = random.uniform(low[k], high[k]);
    if (check.isFree(q)) return q;
  }
}

/// Moves each joint by 5 % of its range, up or down, within the limits.
VectorXd moved(const test::Problem& robot, const VectorXd& q, test::Random& random) {
  const VectorXd &low = robot.kinematics->lower(), &high = robot.kinematics->upper();
  VectorXd next = q;
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    const double step = (random.below(2) ? 0.05 : -0.05) * (high[k] - low[k]);
    next[k] += q[k] + step > high[k] || q[k] + step < low[k] ? -step : step;
  }
  return next;
}

void report(const char* what, std::vector<double> times) {
  if (!times.empty())
    std::printf("%-34s %6zu edges, median %7.0f us, 99 %% %7.0f us, worst %7.0f us\n", what, times.size(),
                benchmark::percentile(times, 0.5), benchmark::percentile(times, 0.99),
                benchmark::percentile(times, 1));
}

int run(int edges, int samples, int seed, const test::Problem& robot) {
  MotionCheck check(robot.kinematics, robot.geometry, robot.pairs);
  CollisionConstraints rows(robot.kinematics, robot.geometry, robot.pairs);
  test::Random random(static_cast<std::uint64_t>(seed));
  std::vector<double> freeTimes, hitTimes;
  VectorXd d(rows.rows());
  long missed = 0, madeUp = 0, asked = 0, queries = 0;
  for (int i = 0; i < edges; ++i) {
    const VectorXd q0 = freePosture(robot, check, random);
    VectorXd q1 = moved(robot, q0, random);
    if (!check.isFree(q1)) {
      --i;
      continue;
    }
    const auto start = std::chrono::steady_clock::now();
    const MotionBracket found = check.firstContact(q0, q1, {0, 1});
    const double time =
        std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count();
    const bool free = found.verdict == MotionVerdict::free;
    queries += found.queries;
    (free ? freeTimes : hitTimes).push_back(time);
    bool seen = false;
    for (int k = 0; k <= samples && samples > 0 && !seen; ++k) {
      rows.evaluate(q0 + static_cast<double>(k) / samples * (q1 - q0), d);
      seen = d.minCoeff() <= 0;
      ++asked;
    }
    missed += free && seen;
    if (found.verdict == MotionVerdict::contact) {
      rows.evaluate(q0 + found.until * (q1 - q0), d);
      madeUp += d.minCoeff() > 1e-12;
    }
  }
  std::printf("%d pairs of bodies, %.0f looks at a pair an edge\n", rows.rows(),
              static_cast<double>(queries) / edges);
  report("free, proven", freeTimes);
  report("in contact", hitTimes);
  std::printf("%ld samples: %ld contacts missed, %ld made up\n", asked, missed, madeUp);
  return missed + madeUp > 0;
}

}  // namespace

int main(int argc, char** argv) {
  const test::Arguments arguments(argc, argv, "[EDGES [SAMPLES [SEED [ROBOT.urdf [ROBOT.srdf]]]]]", 5);
  const std::string folder = test::sourceFolder() + "/data/hrp2_style/hrp2_style";
  const std::string urdf = arguments.text(4, folder + ".urdf");
  try {
    return run(arguments.number(1, 1000), arguments.number(2, 0, 0), arguments.number(3, 1),
               test::smoothProblem(
                   {"", urdf, arguments.text(5, urdf == folder + ".urdf" ? folder + ".srdf" : ""), {}}));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "motion_figures: %s\n", error.what());
    return 2;
  }
}
