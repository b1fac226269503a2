// Measures where continuity helps an optimiser: the figures of docs/optimise.md.
//   optimise_bench --runs 20 -o docs/measured
#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "tools/bench/measurement.h"
#include "tools/bench/optimise/memory.h"
#include "tools/bench/optimise/solver.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::benchmark;

namespace {

// Largest violation of a row that still counts as kept (m); IPOPT's own is 1e-8, scaled.
constexpr double kViolation = 1e-7;

/// A way to solve a task.
struct Way {
  std::string solver;
  Solver kind;
  bool continued;  ///< whether it begins with a small R
};

struct Result {
  bool converged = false;
  double cost = 0, violation = 0;
  long points = 0, hessians = 0;
  double ms = 0;
};

/// Solves the task on one model. `x` is the start and receives the solution; the cost of the solve is added
/// to `result`.
void solveOn(const Task& task, const Method& method, Solver solver, bool warm, Eigen::VectorXd& x,
             Result& result) {
  Nlp nlp(task, method);
  const double begin = threadTime();
  const Solution solution = solve(nlp, x, solver, warm);
  result.ms += (threadTime() - begin) * 1e-6;
  result.points += nlp.points;
  result.hessians += nlp.hessians;
  result.converged = solution.converged;
  x = solution.x;
  result.violation = nlp.violation(x);
  result.cost = task.cost(x);
}

/// Starts with a small R, twice the radius of the bodies, and increases it in steps of about 3. Each step
/// starts from the last solution. A step that fails is halved.
Result continueInR(const Task& task, const Method& goal, Solver solver) {
  constexpr double kFirst = 0.3, kStep = 10.0 / 3, kSmallest = 1.1;
  Result result;
  Eigen::VectorXd x = task.start;
  double good = 0;
  for (Method method = goal;;) {
    method.R = good == 0 ? kFirst : method.R;
    Eigen::VectorXd next = x;
    solveOn(task, method, solver, good > 0, next, result);
    if (result.converged) {
      x = next;
      good = method.R;
      if (good == goal.R) return result;
      method.R = std::min(goal.R, good * kStep);
    } else {
      method.R = std::sqrt(good * method.R);
      if (method.R < kSmallest * good || good == 0) return result;
    }
  }
}

Result run(const Task& task, const Way& way, const Method& method) {
  if (way.continued) return continueInR(task, method, way.kind);
  Result result;
  Eigen::VectorXd x = task.start;
  solveOn(task, method, way.kind, false, x, result);
  return result;
}

/// The models of a task's bodies. Obstacles, if there are any, stay flat (docs/control.md).
std::vector<Method> models(const std::string& task, double r) {
  const Model smooth = task == "pack" ? Model::smooth : Model::half;
  const std::string mm = ", r " + shown(1e3 * r) + " mm";
  std::vector<Method> list{{Model::hull, 0, 0, "hull"}, {Model::hull, r, 0, "hull + r" + mm}};
  for (double R : {1.0, 3.0, 10.0}) list.push_back({smooth, r, R, "STP-BV" + mm + ", R " + shown(R) + " m"});
  return list;
}

/// Solves that end at IPOPT's limit of iterations take most of the time, so they are shown on one or two
/// models only.
std::vector<Way> ways(const Method& method) {
  std::vector<Way> list{{"IPOPT, exact Hessian", Solver::exact, false}};
  if (method.R > 1) list.push_back({"IPOPT, exact Hessian, continued", Solver::exact, true});
  if (method.R == 10) list.push_back({"IPOPT, Gauss-Newton", Solver::gaussNewton, false});
  if (method.r > 0 && method.R != 3) list.push_back({"IPOPT, L-BFGS", Solver::limited, false});
  list.push_back({"SLSQP", Solver::slsqp, false});
  list.push_back({"NLopt, L-BFGS", Solver::augmented, false});
  return list;
}

/// Whether a solution keeps the rows and is as good as the best that any solver found for this seed and
/// model. Packings have many minima, so for them it is enough that the solver reports one of them.
bool solved(const Result& r, const std::string& task, double best) {
  return r.converged && r.violation <= kViolation &&
         (task == "pack" || r.cost <= best + 1e-4 * std::max(std::abs(best), 1e-3));
}

/// Adds one row of the table: the results of one way for all seeds.
void add(const std::string& task, const Method& method, const Way& way, const std::vector<Result>& results,
         const std::vector<double>& best, Measurement& measurement) {
  int converged = 0, good = 0;
  double worst = 0;
  std::vector<double> points, hessians, ms;
  for (std::size_t seed = 0; seed < results.size(); ++seed) {
    const Result& one = results[seed];
    converged += one.converged;
    good += solved(one, task, best[seed]);
    worst = std::max(worst, one.violation);
    points.push_back(static_cast<double>(one.points));
    hessians.push_back(static_cast<double>(one.hessians));
    ms.push_back(one.ms);
  }
  const double share = 100.0 / static_cast<double>(results.size());
  std::printf("%-7s %-24s %-32s %7.0f %7.0f %7.0f %7.0f %8.3g %9.2g\n", task.c_str(), method.name.c_str(),
              way.solver.c_str(), share * converged, share * good, median(points), median(hessians),
              median(ms), worst);
  std::fflush(stdout);
  measurement.rows.push_back({{"task", task},
                              {"method", method.name},
                              {"solver", way.solver},
                              {"converged", share * converged},
                              {"solved", share * good},
                              {"points", median(points)},
                              {"hessians", median(hessians)},
                              {"ms", significant(median(ms), 2)},
                              {"worst_violation", significant(worst, 2)}});
}

/// Measures every way on one model.
void measure(const std::vector<Task>& list, const Method& method, Measurement& measurement) {
  const std::vector<Way> all = ways(method);
  std::vector<std::vector<Result>> results(all.size());
  std::vector<double> best(list.size(), std::numeric_limits<double>::infinity());
  for (std::size_t w = 0; w < all.size(); ++w)
    for (std::size_t seed = 0; seed < list.size(); ++seed) {
      results[w].push_back(run(list[seed], all[w], method));
      if (results[w].back().violation <= kViolation)
        best[seed] = std::min(best[seed], results[w].back().cost);
    }
  for (std::size_t w = 0; w < all.size(); ++w)
    add(list[0].name, method, all[w], results[w], best, measurement);
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app("What optimisers need on hulls and on STP-BVs: place, slot, pack, corner.",
                     "optimise_bench");
  int runs = 20, first = 0;
  double r = 0.01;
  std::vector<std::string> chosen = tasks();
  std::string output;
  app.option("--runs", runs, "seeds a row").whole(1, 100000).shown();
  app.option("--first-seed", first, "of the runs").whole(0, 1000000).shown();
  app.option("--task", chosen, "only these").oneOf(tasks());
  app.option("--r", r, "of the rounded hulls and the volumes (m)").number(1e-4, 0.03).shown();
  app.option("-o,--output", output, "folder for optimise_TASK.json");
  return app.run(argc, argv, [&] {
    keepFreedMemory();
    requirePlace(output, "optimise_" + chosen.front());
    std::printf("%-7s %-24s %-32s %7s %7s %7s %7s %8s %9s\n", "", "", "medians", "conv %", "solved%",
                "points", "hessian", "ms", "violation");
    for (const std::string& name : chosen) {
      Measurement measurement;
      measurement.name = "optimise_" + name;
      measurement.about = {{"runs", runs}, {"first_seed", first}, {"r", r}};
      std::vector<Task> list;
      for (int seed = first; seed < first + runs; ++seed) list.push_back(makeTask(name, seed));
      for (const Method& method : models(name, r)) measure(list, method, measurement);
      if (!output.empty()) write(measurement, commandLine(argc, argv), output);
    }
    return 0;
  });
}
