// posture_ipopt: does IPOPT with the exact Hessian find postures that SLSQP does not, or sooner? Both
// continue from the points where the damped steps of findPosture() end, for the tasks of posture_study.
#include <algorithm>
#include <cstdio>
#include <functional>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/posture/approach.h"
#include "fcl_stpbv/posture/starts.h"
#include "test/reference/source_folder.h"
#include "tools/bench/measurement.h"
#include "tools/bench/optimise/memory.h"
#include "tools/bench/posture_ipopt/program.h"
#include "tools/bench/posture_study/tasks.h"
#include "tools/program.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::benchmark;
using Eigen::VectorXd;

namespace {

constexpr double kInfluence = 0.2;  // m, the value of find_posture

struct Bodies {
  const char* name;
  double R;  ///< m; 0: hulls
};
constexpr Bodies kBodies[] = {{"hulls", 0}, {"STP-BV, R 1 m", 1}, {"STP-BV, R 10 m", 10}};

struct Way {
  const char* name;
  Solver solver;
};
/// L-BFGS takes most of the time, so it is shown on one model only.
std::vector<Way> ways(const Bodies& bodies) {
  std::vector<Way> list{{"SLSQP", Solver::slsqp}, {"IPOPT, exact Hessian", Solver::exact}};
  if (bodies.R == 10) list.push_back({"IPOPT, L-BFGS", Solver::limited});
  return list;
}

/// How one way solved one task.
struct Result {
  int start = -1;  ///< the first one that led to a posture
  long points = 0, hessians = 0;
  double ms = 0, cost = 0;
};

/// Counts the points at which a problem is evaluated.
class Counter : public PostureRows {
 public:
  Kind kind() const override { return Kind::atLeast; }
  int size() const override { return 0; }
  std::string name(int) const override { return ""; }
  void evaluate(const Point&, Eigen::Ref<VectorXd>, Eigen::Ref<RowMatrix>) override { ++points; }
  long points = 0;
};

PostureScene loadRobot(const Bodies& bodies) {
  const std::string data = test::sourceFolder() + "/data/hrp2_style/hrp2_style";
  PostureScene scene;
  scene.robot = std::make_shared<const RobotModel>(loadUrdf(data + ".urdf"));
  scene.srdf = std::make_shared<const Srdf>(loadSrdf(data + ".srdf", *scene.robot));
  GeometryOptions options;
  if (bodies.R > 0) options.radii.R = bodies.R;
  RobotGeometry geometry = loadGeometry(*scene.robot, options);
  for (Body& body : geometry.bodies) {
    if (bodies.R > 0) continue;
    body.geometry = detail::hullGeometry(body.volume->vertices());
    body.geometry->computeLocalAABB();
    body.volume = nullptr;
  }
  scene.geometry = std::make_shared<const RobotGeometry>(std::move(geometry));
  return scene;
}

/// The two approaches of findPosture().
VectorXd nearPosture(PostureProblem& problem, const VectorXd& start) {
  detail::ApproachOptions how;
  how.costWeight = 1e-4;
  how.atLeastWeight = 0.3;
  const VectorXd soft = approach(problem, start, how).x;
  how.atLeastWeight = 1;
  return approach(problem, soft, how).x;
}

/// All ways from the same points. A way stops at its first posture.
std::vector<Result> run(std::uint64_t seed, const std::vector<Way>& all, PostureScene& scene, int starts) {
  const tools::RandomTask random = tools::randomTask(seed);
  scene.obstacles = random.obstacles;
  PostureSetup setup = setUp(random.task, scene, kInfluence);
  PostureHessian hessian(setup, random.task, scene, kInfluence);
  PostureProblem& problem = *setup.problem;
  const auto counter = std::make_shared<Counter>();
  problem.add(counter);
  detail::Starts from(problem, setup.start, setup.spread, 1, 0);
  std::vector<Result> results(all.size());
  for (int start = 0; start < starts; ++start) {
    const VectorXd x = nearPosture(problem, problem.variablesAt(from.next()));
    for (std::size_t w = 0; w < results.size(); ++w) {
      Result& result = results[w];
      if (result.start >= 0) continue;
      const long before = counter->points;
      const double begin = threadTime();
      PostureSolution solution{x, 0};
      if (all[w].solver == Solver::slsqp)
        solution.x = solveBySlsqp(problem, x, {}).x;
      else
        solution = solveByIpopt(problem, hessian, x, all[w].solver);
      result.ms += (threadTime() - begin) * 1e-6;
      result.points += counter->points - before;
      result.hessians += solution.hessians;
      result.cost = problem.evaluate(solution.x).cost;
      if (problem.missed(solution.x, SolverOptions().tolerance).empty()) result.start = start;
    }
  }
  return results;
}

/// Adds a row of the table for each way. Medians are over the tasks that every way solves at the first start.
void add(const Bodies& bodies, const std::vector<Way>& all, const std::vector<std::vector<Result>>& tasks,
         Measurement& measurement) {
  for (std::size_t w = 0; w < all.size(); ++w) {
    int first = 0, within = 0;
    double ms = 0;
    std::vector<double> points, hessians, times, costs;
    for (const std::vector<Result>& results : tasks) {
      const Result& one = results[w];
      first += one.start == 0;
      within += one.start >= 0;
      ms += one.ms / static_cast<double>(tasks.size());
      if (std::any_of(results.begin(), results.end(), [](const Result& r) { return r.start != 0; })) continue;
      points.push_back(static_cast<double>(one.points));
      hessians.push_back(static_cast<double>(one.hessians));
      times.push_back(one.ms);
      costs.push_back(one.cost / results[0].cost - 1);
    }
    if (points.empty()) points = hessians = times = costs = {0};
    std::printf("%-15s %-21s %7d %7d %7.0f %9.0f %9.2g %9.2g %9.1g\n", bodies.name, all[w].name, first,
                within, median(points), median(hessians), median(times), ms, median(costs));
    std::fflush(stdout);
    measurement.rows.push_back({{"bodies", bodies.name},
                                {"solver", all[w].name},
                                {"first", first},
                                {"within", within},
                                {"points", median(points)},
                                {"hessians", median(hessians)},
                                {"ms", significant(median(times), 2)},
                                {"mean_ms", significant(ms, 2)},
                                {"cost", significant(median(costs), 2)}});
  }
}

}  // namespace

int main(int argc, char** argv) {
  tools::Program app("IPOPT with exact Hessians beside SLSQP for the postures of posture_study",
                     "posture_ipopt");
  int tasks = 80, starts = 5;
  std::string folder;
  app.option("--tasks", tasks, "Random tasks").whole(1, 100000).shown();
  app.option("--starts", starts, "Starts of each").whole(1, 1000).shown();
  app.option("-o,--output", folder, "Folder for posture_ipopt.json");
  return app.run(argc, argv, [&] {
    keepFreedMemory();
    requirePlace(folder, "posture_ipopt");
    Measurement measurement;
    measurement.name = "posture_ipopt";
    measurement.about = {{"tasks", tasks}, {"starts", starts}};
    std::printf("%-15s %-21s %7s %7s %7s %9s %9s %9s %9s\n", "", "solved:", "first", "within", "points",
                "hessians", "ms", "mean ms", "cost");
    for (const Bodies& bodies : kBodies) {
      const std::vector<Way> all = ways(bodies);
      PostureScene scene = loadRobot(bodies);
      std::vector<std::vector<Result>> results;
      for (int seed = 0; seed < tasks; ++seed)
        results.push_back(run(static_cast<std::uint64_t>(seed), all, scene, starts));
      add(bodies, all, results, measurement);
    }
    if (!folder.empty()) benchmark::write(measurement, commandLine(argc, argv), folder);
    return 0;
  });
}
