// modelForScene(): checks the needs, then meets as many of them as possible (detail_choice.h).
#include "fcl_stpbv/robot/scene_model.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/robot/detail_choice.h"

namespace fcl_stpbv {

using namespace detail;

namespace {

void requireNeeds(const std::vector<SceneNeed>& needs, const Kinematics& kinematics, std::size_t obstacles) {
  const int links = static_cast<int>(kinematics.robot().links.size());
  for (std::size_t i = 0; i < needs.size(); ++i) {
    const SceneNeed& need = needs[i];
    const auto refuse = [&](const std::string& why) {
      throw Error("modelForScene: needs[" + std::to_string(i) + "]: " + why);
    };
    const int others = need.pair.obstacle ? static_cast<int>(obstacles) : links;
    if (need.pair.link1 < 0 || need.pair.link1 >= links || need.pair.link2 < 0 || need.pair.link2 >= others)
      refuse("is of a link or an obstacle that does not exist");
    if (!need.pair.obstacle && need.pair.link1 == need.pair.link2)
      refuse("is of a link and itself; give two links");
    if (need.q.size() != kinematics.size() || !need.q.allFinite())
      refuse("must have a configuration of " + std::to_string(kinematics.size()) + " finite numbers");
    if (!std::isfinite(need.clearance)) refuse("has a clearance that is not finite");
  }
}

}  // namespace

std::vector<std::shared_ptr<const RobotGeometry>> loadLevels(const RobotModel& robot,
                                                             const GeometryOptions& options,
                                                             const std::vector<double>& budgets) {
  for (std::size_t i = 0; i < budgets.size(); ++i) {
    // A budget of 0 is refused, because GeometryOptions::overCoverBudget takes 0 for no limit.
    if (!(budgets[i] > 0))
      throw Error("loadLevels: got a budget of " + toDecimal(budgets[i]) + "; each must be above r");
    if (i > 0 && !(budgets[i] < budgets[i - 1]))
      throw Error("loadLevels: each budget must be below the one before");
  }
  std::vector<std::shared_ptr<const RobotGeometry>> levels;
  for (const double budget : budgets) {
    GeometryOptions coarse = options;
    coarse.overCoverBudget = budget;
    levels.push_back(std::make_shared<const RobotGeometry>(loadGeometry(robot, coarse)));
  }
  levels.push_back(std::make_shared<const RobotGeometry>(loadGeometry(robot, options)));
  return levels;
}

SceneModel modelForScene(std::shared_ptr<const Kinematics> kinematics,
                         const std::vector<std::shared_ptr<const RobotGeometry>>& levels,
                         const std::vector<Obstacle>& obstacles, const std::vector<SceneNeed>& needs,
                         const SceneModelOptions& options) {
  requireNeeds(needs, *kinematics, obstacles.size());
  DetailChoice choice(std::move(kinematics), levels, obstacles, options, false);
  choice.refine(needs);
  SceneModel model{choice.geometry(), {}};
  std::copy_if(needs.begin(), needs.end(), std::back_inserter(model.unmet),
               [&](const SceneNeed& need) { return !choice.meets(need); });
  return model;
}

}  // namespace fcl_stpbv
