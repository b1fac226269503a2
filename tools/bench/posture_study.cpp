// posture_study: does a continuous gradient help? The same optimiser, tasks and starts with four sources of
// distances. Prints a table; writes every task as JSON (docs/posture.md).
#include <algorithm>
#include <array>
#include <cstdio>
#include <functional>
#include <iostream>
#include <limits>
#include <map>

#include "fcl_stpbv/posture/find_posture.h"
#include "test/reference/mesh_check.h"
#include "test/reference/source_folder.h"
#include "tools/bench/measurement.h"
#include "tools/bench/posture_study/hull_rows.h"
#include "tools/bench/posture_study/tasks.h"
#include "tools/program.h"

namespace {

using namespace fcl_stpbv;
using namespace fcl_stpbv::tools;

struct Method {
  const char* name;
  bool smooth;
  HullDistance hulls;
  bool rounded;
};
constexpr Method kMethods[] = {{"STP-BV", true, HullDistance::exact, true},
                               {"hulls, rounded, exact", false, HullDistance::exact, true},
                               {"hulls, rounded, FCL", false, HullDistance::fcl, true},
                               {"hulls, plain FCL", false, HullDistance::fcl, false}};
constexpr std::size_t kCount = std::size(kMethods);
constexpr double kInfluence = 0.2;  // m, the value of find_posture

struct Result {
  bool solved = false, clear = false;
  Posture posture;
  bool good() const { return solved && clear; }
};

struct Row {
  std::uint64_t seed;
  std::string family;
  bool feasible = false;
  std::array<Result, kCount> results;
};

PostureScene loadRobot() {
  const std::string data = fcl_stpbv::test::sourceFolder() + "/data/hrp2_style/hrp2_style";
  PostureScene scene;
  scene.robot = std::make_shared<const RobotModel>(loadUrdf(data + ".urdf"));
  scene.srdf = std::make_shared<const Srdf>(loadSrdf(data + ".srdf", *scene.robot));
  scene.geometry = std::make_shared<const RobotGeometry>(loadGeometry(*scene.robot));
  return scene;
}

PostureSetup setUpFor(const Method& method, const PostureTask& task, const PostureScene& scene) {
  if (method.smooth) return setUp(task, scene, kInfluence);
  PostureSetup setup = setUpWithoutCollisions(task, scene);
  setup.pairs = pairsOf(task, scene);
  const double rounding = method.rounded ? GeometryOptions().radii.r : 0.0;
  setup.problem->add(std::make_shared<HullRows>(std::make_shared<const Kinematics>(scene.robot, task.base),
                                                scene.geometry, setup.pairs, scene.obstacles, method.hulls,
                                                rounding, kInfluence));
  return setup;
}

class Study {
 public:
  Study(int starts, int searchStarts, double tolerance)
      : scene_(loadRobot()), check_(scene_.robot, nullptr, {}), searchStarts_(searchStarts) {
    options_.starts = starts;
    options_.anywhere = 0;  // only starts near the task's own are compared
    options_.solver.costTolerance = tolerance;
  }

  Row run(std::uint64_t seed) {
    const RandomTask random = randomTask(seed);
    scene_.obstacles = random.obstacles;
    check_.setObstacles(random.obstacles);
    Row row{seed, random.family, false, {}};
    for (std::size_t m = 0; m < kCount; ++m) row.results[m] = solve(kMethods[m], random.task, options_);
    row.feasible = row.results[0].good();
    // An STP-BV contains the rounded hull, which contains the hull. So a task that has a solution with
    // STP-BVs has one with all methods.
    PostureOptions search = options_;
    search.starts = searchStarts_;
    if (!row.feasible) row.feasible = solve(kMethods[0], random.task, search).good();
    return row;
  }

 private:
  Result solve(const Method& method, const PostureTask& task, const PostureOptions& options) {
    PostureSetup setup = setUpFor(method, task, scene_);
    Result result;
    result.posture = findPosture(setup, options);
    result.solved = result.posture.feasible;
    result.clear = result.solved && check_
                                        .collisions(setup.problem->kinematics(), result.posture.q,
                                                    test::linksOf(setup.pairs, *scene_.geometry))
                                        .empty();
    return result;
  }

  PostureScene scene_;
  test::MeshCheck check_;
  PostureOptions options_;
  int searchStarts_;
};

void printTable(const std::vector<Row>& rows, int starts) {
  const auto feasible = std::count_if(rows.begin(), rows.end(), [](const Row& row) { return row.feasible; });
  std::printf("%zu tasks, %d of them known to be feasible\n\n", rows.size(), static_cast<int>(feasible));
  std::printf(
      "| distances | solved at the first start | within %d | hits a mesh | iterations | distances | ms | "
      "cost above the best |\n",
      starts);
  std::puts("|---|---|---|---|---|---|---|---|");
  for (std::size_t m = 0; m < kCount; ++m) {
    int first = 0, within = 0, hits = 0;
    std::vector<double> iterations, calls, seconds, costs;
    for (const Row& row : rows) {
      const Result& result = row.results[m];
      hits += result.solved && !result.clear;
      if (!row.feasible || !result.good()) continue;
      ++within;
      first += result.posture.starts == 1;
      const bool all =
          std::all_of(row.results.begin(), row.results.end(), [](const Result& r) { return r.good(); });
      if (!all) continue;  // medians are over the same tasks for all methods
      iterations.push_back(result.posture.iterations);
      calls.push_back(static_cast<double>(result.posture.distanceCalls));
      seconds.push_back(result.posture.seconds);
      double best = std::numeric_limits<double>::infinity();
      for (const Result& r : row.results) best = std::min(best, r.posture.cost);
      costs.push_back(result.posture.cost / best - 1);
    }
    const double share = 100.0 / static_cast<double>(std::max<std::ptrdiff_t>(1, feasible));
    std::printf("| %s | %.1f %% | %.1f %% | %d | %.0f | %.0f | %.1f | %.1f %% |\n", kMethods[m].name,
                first * share, within * share, hits, benchmark::median(iterations), benchmark::median(calls),
                1e3 * benchmark::median(seconds), 100 * benchmark::median(costs));
  }
  std::map<std::string, std::array<int, kCount + 1>> families;
  for (const Row& row : rows) {
    if (!row.feasible) continue;
    ++families[row.family][kCount];
    for (std::size_t m = 0; m < kCount; ++m) families[row.family][m] += row.results[m].good();
  }
  std::puts("");
  for (const auto& [family, counts] : families) {
    std::printf("%s: %d feasible;", family.c_str(), counts[kCount]);
    for (std::size_t m = 0; m < kCount; ++m)
      std::printf(" %s %d%s", kMethods[m].name, counts[m], m + 1 < kCount ? "," : "\n");
  }
}

void fill(benchmark::Measurement& result, const std::vector<Row>& rows, int starts) {
  result.about = {{"tasks", rows.size()}, {"starts", starts}};
  for (const Row& row : rows)
    for (std::size_t m = 0; m < kCount; ++m) {
      const Result& r = row.results[m];
      result.rows.push_back({{"seed", row.seed},
                             {"family", row.family},
                             {"feasible", row.feasible},
                             {"distances", kMethods[m].name},
                             {"solved", r.solved},
                             {"clear", r.clear},
                             {"starts", r.posture.starts},
                             {"iterations", r.posture.iterations},
                             {"calls", r.posture.distanceCalls},
                             {"seconds", benchmark::significant(r.posture.seconds, 3)},
                             {"cost", benchmark::significant(r.posture.cost, 6)}});
    }
}

}  // namespace

int main(int argc, char** argv) {
  Program app("Postures for random tasks, with and without continuous gradients", "posture_study");
  int tasks = 240, starts = 5, searchStarts = 100;
  double tolerance = SolverOptions().costTolerance;
  app.option("--tasks", tasks, "Random tasks").shown().whole(1, 100000);
  app.option("--starts", starts, "Starts of each").shown().whole(1, 1000);
  app.option("--search-starts", searchStarts, "Starts before a task counts as infeasible").whole(1).shown();
  app.option("--tolerance", tolerance, "Relative change of the cost to stop at").number(0, 1).shown();
  return benchmark::runBenchmark(app, argc, argv, "posture_study", [&](benchmark::Measurement& result) {
    Study study(starts, searchStarts, tolerance);
    std::vector<Row> rows;
    for (int seed = 0; seed < tasks; ++seed) rows.push_back(study.run(static_cast<std::uint64_t>(seed)));
    printTable(rows, starts);
    fill(result, rows, starts);
  });
}
