// Plans a motion of the upper body to the can by OMPL's RRT-Connect, with motions checked by proofs. For
// comparison, plans it with `fcl::collide` on the hulls and OMPL's sampled motions, and checks by proof how
// many of those paths collide.
//   example_ompl DATA_FOLDER [RUNS [PAGE.html]]      the data folder of the project; RUNS of each
#include <ompl/base/ScopedState.h>
#include <ompl/geometric/PathSimplifier.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/report/text_table.h"
#include "fcl_stpbv/report/trajectory.h"
#include "page.h"
#include "test/reference/arguments.h"
#include "validity.h"

using namespace fcl_stpbv;
using namespace example;
namespace og = ompl::geometric;
using Path = std::vector<Eigen::VectorXd>;

namespace {

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

ob::SpaceInformationPtr spaceOf(const Scene& scene) {
  auto space = std::make_shared<ob::RealVectorStateSpace>(static_cast<unsigned>(scene.coordinates.size()));
  ob::RealVectorBounds bounds(static_cast<unsigned>(scene.coordinates.size()));
  for (std::size_t i = 0; i < scene.coordinates.size(); ++i) {
    bounds.setLow(static_cast<unsigned>(i), scene.kinematics->lower()[scene.coordinates[i]]);
    bounds.setHigh(static_cast<unsigned>(i), scene.kinematics->upper()[scene.coordinates[i]]);
  }
  space->setBounds(bounds);
  return std::make_shared<ob::SpaceInformation>(space);
}

struct Plan {
  bool found = false;
  double seconds = 0;
  Path path;
};

/// RRT-Connect, then OMPL's simplifier, which prefers clearance if there is an objective.
Plan planned(const Scene& scene, const ob::SpaceInformationPtr& space,
             const ob::OptimizationObjectivePtr& objective) {
  constexpr double kMostSeconds = 20;
  ob::ScopedState<ob::RealVectorStateSpace> start(space), goal(space);
  for (std::size_t i = 0; i < scene.coordinates.size(); ++i) {
    start->values[i] = scene.start[scene.coordinates[i]];
    goal->values[i] = scene.goal[scene.coordinates[i]];
  }
  auto problem = std::make_shared<ob::ProblemDefinition>(space);
  problem->setStartAndGoalStates(start, goal);
  if (objective) problem->setOptimizationObjective(objective);
  og::RRTConnect planner(space);
  planner.setProblemDefinition(problem);
  planner.setup();
  const auto begin = std::chrono::steady_clock::now();
  Plan plan;
  plan.found = planner.ob::Planner::solve(kMostSeconds) == ob::PlannerStatus::EXACT_SOLUTION;
  if (!plan.found) return plan;
  auto& path = *problem->getSolutionPath()->as<og::PathGeometric>();
  og::PathSimplifier(space, problem->getGoal(), objective).simplifyMax(path);
  plan.seconds = secondsSince(begin);
  for (const ob::State* state : path.getStates()) plan.path.push_back(scene.whole(valuesOf(state)));
  return plan;
}

/// A way point moved towards the middle of its neighbours, and pushed away from pairs nearer than `clearance`
/// along their gradients.
Eigen::VectorXd moved(const Scene& scene, CollisionConstraints& rows, const Eigen::VectorXd& before,
                      const Eigen::VectorXd& q, const Eigen::VectorXd& after, double clearance) {
  Eigen::VectorXd d(rows.rows()), push = Eigen::VectorXd::Zero(q.size());
  auto jacobian = rows.makeJacobian();
  rows.evaluate(q, d, jacobian);
  for (int row = 0; row < rows.rows(); ++row)
    if (d[row] < clearance) {
      const Eigen::VectorXd slope = jacobian.row(row).transpose();
      push += (clearance - d[row]) / std::max(slope.squaredNorm(), 1e-6) * slope;
    }
  Eigen::VectorXd next = q;
  for (const int k : scene.coordinates)
    next[k] += 0.3 * (0.5 * (before[k] + after[k]) - q[k]) + 0.5 * push[k];
  return next.cwiseMax(scene.kinematics->lower()).cwiseMin(scene.kinematics->upper());
}

/// Shortens a path. A step is kept only if both motions beside the way point are proven free.
void shorten(const Scene& scene, MotionCheck& check, CollisionConstraints& rows, Path& path) {
  constexpr int kRounds = 20;
  constexpr double kClearance = 0.02;  // m
  for (int round = 0; round < kRounds; ++round)
    for (std::size_t i = 1; i + 1 < path.size(); ++i) {
      const Eigen::VectorXd next = moved(scene, rows, path[i - 1], path[i], path[i + 1], kClearance);
      if (check.isMotionFree(path[i - 1], next) && check.isMotionFree(next, path[i + 1])) path[i] = next;
    }
}

/// The path with additional way points, so that there are points to move.
Path divided(const Path& path, double most) {
  Path finer{path[0]};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const int parts = std::max(1, static_cast<int>(std::ceil((path[i] - path[i - 1]).norm() / most)));
    for (int k = 1; k <= parts; ++k)
      finer.push_back(path[i - 1] + static_cast<double>(k) / parts * (path[i] - path[i - 1]));
  }
  return finer;
}

double lengthOf(const Path& path) {
  double length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) length += (path[i] - path[i - 1]).norm();
  return length;
}

bool provenFree(MotionCheck& check, const Path& path) {
  for (std::size_t i = 1; i < path.size(); ++i)
    if (!check.isMotionFree(path[i - 1], path[i])) return false;
  return true;
}

template <class... Values>
std::string line(const char* format, Values... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

/// What several runs of one way of planning came to.
struct Sum {
  int found = 0, colliding = 0;
  double seconds = 0;
  Count motions, states;
  Path best;

  void add(const Plan& plan) {
    if (!plan.found) return;
    ++found;
    seconds += plan.seconds;
    if (best.empty() || lengthOf(plan.path) < lengthOf(best)) best = plan.path;
  }
  static void add(Count& sum, const Count& part) {
    sum.asked += part.asked;
    sum.seconds += part.seconds;
  }
  /// What it came to, under these heads.
  static std::vector<std::string> heads() {
    return {"", "planned", "s each", "motions, µs each", "states, µs each", "paths that collide in between"};
  }
  std::vector<std::string> row(const char* name, int runs) const {
    const auto each = [](const Count& c) {
      const double mean = 1e6 * c.seconds / static_cast<double>(c.asked);
      return c.asked ? line("%ld at %.3g", c.asked, mean) : std::string("-");
    };
    return {name,
            line("%d of %d", found, runs),
            line("%.3f", seconds / std::max(1, found)),
            each(motions),
            each(states),
            line("%d", colliding)};
  }
};

void planByProofs(const Scene& scene, MotionCheck& check, CollisionConstraints& rows, Sum& sum) {
  const ob::SpaceInformationPtr space = spaceOf(scene);
  const auto states = std::make_shared<SmoothStates>(space, scene, check, rows);
  const auto motions = std::make_shared<ProvenMotions>(space, scene, check);
  space->setStateValidityChecker(states);
  space->setMotionValidator(motions);
  space->setup();
  sum.add(planned(scene, space, std::make_shared<Clearance>(space)));
  Sum::add(sum.motions, motions->count);
  Sum::add(sum.states, states->count);
}

void planBySamples(const Scene& scene, MotionCheck& hulls, Sum& sum) {
  const ob::SpaceInformationPtr space = spaceOf(scene);
  const auto states = std::make_shared<HullStates>(space, scene);
  space->setStateValidityChecker(states);  // with the default motion validator, at its default resolution
  space->setup();
  const Plan plan = planned(scene, space, nullptr);
  sum.add(plan);
  sum.colliding += plan.found && !provenFree(hulls, plan.path);
  Sum::add(sum.states, states->count);
}

void print(const Findings& found) {
  std::printf("%s\n%s\n", found.verdict.c_str(), found.about.c_str());
  report::TextTable table("lrrrrr");
  for (const auto& row : found.table) table.add(row);
  std::printf("%s", table.text().c_str());
}

int run(const std::string& data, int runs, const std::string& page) {
  const Scene scene = loadScene(data);
  MotionCheck smooth(scene.kinematics, scene.smooth, scene.pairs, scene.obstacles);
  MotionCheck hulls(scene.kinematics, scene.hulls, scene.pairs, scene.hullObstacles);
  ConstraintOptions options;
  options.obstacles = scene.obstacles;
  CollisionConstraints rows(scene.kinematics, scene.smooth, scene.pairs, options);
  if (!smooth.isFree(scene.start) || !smooth.isFree(scene.goal))
    throw Error("the start or the goal collides");
  Sum proofs, samples;
  for (int i = 0; i < runs; ++i) {
    planByProofs(scene, smooth, rows, proofs);
    planBySamples(scene, hulls, samples);
  }
  Findings found{"No path to the can was found",
                 {Sum::heads(), proofs.row("proofs", runs), samples.row("samples", runs)},
                 line("%zu coordinates, %zu pairs.", scene.coordinates.size(), scene.pairs.size())};
  if (proofs.best.empty()) {
    print(found);
    return 1;
  }
  Path path = divided(proofs.best, 0.5);
  const auto begin = std::chrono::steady_clock::now();
  shorten(scene, smooth, rows, path);
  const double seconds = secondsSince(begin);
  report::Trajectory way{path, {}, false};
  for (std::size_t i = 0; i < path.size(); ++i) way.time.push_back(static_cast<double>(i));
  const report::TrajectoryReport followed =
      report::follow(way, scene.kinematics, scene.smooth, scene.pairs, scene.obstacles, 0);
  double clearance = *std::min_element(followed.chartDistance.begin(), followed.chartDistance.end());
  if (std::abs(clearance) < 1e-9) clearance = 0;  // as the chart says it
  const bool good = followed.verdict == MotionVerdict::free;
  found.verdict =
      line("A path of %.2f rad to the can, %s", lengthOf(path), good ? "proven free" : "NOT proven free");
  found.about +=
      line(" Gradients shortened the path from %.3f rad to %.3f rad in %.3f s. Its clearance is %.4g mm.",
           lengthOf(proofs.best), lengthOf(path), seconds, 1e3 * clearance);
  print(found);
  if (!page.empty()) detail::writeOutput(page, pageOf(scene, followed, found));
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const test::Arguments arguments(argc, argv, "DATA_FOLDER [RUNS [PAGE.html]]", 3);
  const std::string data = arguments.text(1, "");
  const int runs = arguments.number(2, 1);
  if (data.empty()) {
    std::fprintf(stderr, "usage: %s DATA_FOLDER [RUNS [PAGE.html]]\n", argv[0]);
    return 2;
  }
  ompl::RNG::setSeed(1);
  ompl::msg::setLogLevel(ompl::msg::LOG_ERROR);
  try {
    return run(data, runs, arguments.text(3, ""));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
