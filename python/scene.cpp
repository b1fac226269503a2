// Loading a robot among obstacles for Python, and modelForScene() of it.
#include "scene.h"

#include <algorithm>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/near_name.h"
#include "interrupt.h"
#include "words.h"

namespace fcl_stpbv {
namespace {

BaseMotion baseMotion(const std::string& name) {
  if (name == "fixed") return BaseMotion::fixed;
  if (name == "planar") return BaseMotion::planar;
  if (name == "floating") return BaseMotion::floating;
  throw Error("base: got \"" + name + "\", expected \"fixed\", \"planar\" or \"floating\"");
}

}  // namespace

std::shared_ptr<const RobotGeometry> PythonScene::load(const std::string& base,
                                                       const std::optional<Path>& obstaclesUrdf) {
  const BaseMotion motion = baseMotion(base);
  kinematics = std::make_shared<const Kinematics>(robot, motion);
  baseMoves = motion != BaseMotion::fixed;
  RobotGeometry bodies = loading.geometry(*robot, options), things;
  if (obstaclesUrdf) {
    around = std::make_shared<const RobotModel>(loading.obstacles(*obstaclesUrdf));
    things = loading.geometry(*around, aroundOptions);
    obstacles = obstaclesOf(around, things);
  }
  if (srdf) loading.warnOfPairs(*robot, bodies, *srdf);
  coverPrimitives(pairs(bodies), bodies, &things);
  loading.warnOfR(*robot, bodies, options);
  if (measureMeshes) {
    measureExcess(bodies, options.threads);
    measureExcess(things, options.threads);
  }
  if (around) {
    loading.warnOfR(*around, things, aroundOptions);
    obstacles = obstaclesOf(around, things);  // with their covers
  }
  return std::make_shared<const RobotGeometry>(std::move(bodies));
}

std::vector<CheckedPair> PythonScene::pairs(const RobotGeometry& geometry) const {
  std::vector<CheckedPair> all = selfPairs(*robot, geometry, srdf ? &*srdf : nullptr);
  const std::vector<CheckedPair> withObstacles = obstaclePairs(*robot, geometry, obstacles.size(), baseMoves);
  all.insert(all.end(), withObstacles.begin(), withObstacles.end());
  return all;
}

SceneNeed PythonScene::toNeed(const Need& given, const std::string& name,
                              const std::vector<CheckedPair>& checked, const RobotGeometry& geometry) const {
  const auto& [first, second, q, clearance] = given;
  const auto obstacle = std::find_if(obstacles.begin(), obstacles.end(),
                                     [&, &wanted = second](const Obstacle& o) { return o.name == wanted; });
  SceneNeed need;
  need.q = q.value;
  need.clearance = clearance;
  const int link1 = robot->link(first), link2 = robot->link(second);
  const auto unknown = [&](const std::string& missing, const std::string& wanted) {
    const auto body = std::find_if(geometry.bodies.begin(), geometry.bodies.end(),
                                   [&](const Body& b) { return b.name == wanted; });
    const std::string other = body == geometry.bodies.end()
                                  ? ""
                                  : "; that is a body of the link \"" +
                                        robot->links[static_cast<std::size_t>(body->link)].name +
                                        "\", and a need names links";
    std::vector<std::string> known = detail::namesOf(robot->links);
    if (wanted == second)
      for (const Obstacle& each : obstacles) known.push_back(each.name);
    return Error(name + ": " + missing + " \"" + wanted + "\"" +
                 (other.empty() ? detail::didYouMean(wanted, known) : other));
  };
  if (link1 < 0) throw unknown("the robot has no link", first);
  if (link2 < 0 && obstacle == obstacles.end()) throw unknown("there is no link or obstacle", second);
  if (link2 >= 0 && obstacle != obstacles.end())
    throw Error(name + ": \"" + second + "\" is a link and an obstacle; give one of them another name");
  need.pair = link2 >= 0 ? LinkPair{link1, link2}
                         : LinkPair{link1, static_cast<int>(obstacle - obstacles.begin()), true};
  const bool known = std::any_of(checked.begin(), checked.end(), [&](const CheckedPair& pair) {
    const LinkPair links = linksOf(pair, geometry);
    return !(links < need.pair) && !(need.pair < links);
  });
  if (!known)
    throw Error(name + ": \"" + first + "\" and \"" + second + "\" are no pair of this robot's rows");
  return need;
}

std::shared_ptr<const RobotGeometry> PythonScene::modelFor(const std::vector<Need>& given,
                                                           const std::vector<double>& budgets, int threads,
                                                           std::vector<std::size_t>& unmet) const {
  constexpr int kMostThreads = 256;
  if (threads < 1 || threads > kMostThreads)
    throw Error("threads: got " + std::to_string(threads) + ", expected 1 to " +
                std::to_string(kMostThreads));
  std::vector<std::shared_ptr<const RobotGeometry>> levels = loadLevels(*robot, options, budgets);
  const std::vector<CheckedPair> checked = pairs(*levels.back());
  const RobotGeometry flat = around ? loadGeometry(*around, aroundOptions) : RobotGeometry();
  for (std::shared_ptr<const RobotGeometry>& level : levels) {
    RobotGeometry covered = *level, things = flat;
    coverPrimitives(checked, covered, &things);
    level = std::make_shared<const RobotGeometry>(std::move(covered));
  }
  std::vector<SceneNeed> needs;
  for (std::size_t i = 0; i < given.size(); ++i)
    needs.push_back(toNeed(given[i], "needs[" + std::to_string(i) + "]", checked, *levels.back()));
  SceneModelOptions how;
  how.threads = threads;
  Interrupt interrupt;
  how.progress = [&](std::size_t, std::size_t, const std::string&) { interrupt(); };
  const SceneModel model =
      inPythonsWords([&] { return modelForScene(kinematics, levels, obstacles, needs, how); });
  unmet.clear();
  for (std::size_t i = 0; i < needs.size() && unmet.size() < model.unmet.size(); ++i) {
    const SceneNeed& next = model.unmet[unmet.size()];  // the unmet needs are in the order of the needs
    const bool same = !(needs[i].pair < next.pair) && !(next.pair < needs[i].pair);
    if (same && needs[i].q == next.q && needs[i].clearance == next.clearance) unmet.push_back(i);
  }
  if (!measureMeshes) return model.geometry;
  RobotGeometry measured = *model.geometry;
  measureExcess(measured, threads);
  return std::make_shared<const RobotGeometry>(std::move(measured));
}

}  // namespace fcl_stpbv
