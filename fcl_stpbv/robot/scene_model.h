// As few vertices and rows as a scene needs: coarse volumes where they do, finer ones and convex parts where
// a pair asks for them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv {

/// What a model is to show: two links, or a link and an obstacle, farther apart than this in one
/// configuration. Where the links themselves are nearer than that and the margins r of both, no model shows
/// it, and none gets finer for it.
struct SceneNeed {
  LinkPair pair;         ///< the two
  Eigen::VectorXd q;     ///< the configuration (rad, m)
  double clearance = 0;  ///< that their distance is to exceed (m)
};

/// How the work is done; what comes out does not depend on it.
struct SceneModelOptions {
  std::string cacheFolder = defaultCacheFolder();  ///< of convex parts, "" for no cache
  int threads = 1;                                 ///< that share the work; any number gives the same
  /// Called now and then: steps done, of how many, at what.
  std::function<void(std::size_t, std::size_t, const std::string&)> progress;
};

/// A robot as fine as its needs ask for.
struct SceneModel {
  std::shared_ptr<const RobotGeometry> geometry;  ///< its `byParts`: the pairs that are taken by parts
  std::vector<SceneNeed> unmet;                   ///< needs that the finest bodies do not show either
};

/// Whole bodies, coarse to fine: volumes that may exceed their hulls by each of `budgets` (m, falling, all
/// above r), which have few vertices and a large r (GeometryOptions::overCoverBudget); then those of
/// `options` as they are. @throws Error as loadGeometry() does, and for budgets that do not fall.
std::vector<std::shared_ptr<const RobotGeometry>> loadLevels(const RobotModel& robot,
                                                             const GeometryOptions& options,
                                                             const std::vector<double>& budgets);

/// Every link starts at the first of `levels`. The cheapest step that meets a need is taken first: a finer
/// level of one link before parts, 2 parts before 4 and 8; of equal steps, that of the link that meets the
/// most needs; two links at once where no single one helps. Only pairs with a need are taken by parts, all
/// others keep the whole bodies. It ends when all needs are met that can be. `needs`: pairs that matter in
/// configurations that do, as start and goal of a task, the closest configuration of each pair, samples;
/// those that the first level shows cost one distance each.
/// @throws Error where the levels' bodies differ, for needs of pairs that do not exist, and naming a mesh
/// that cannot be split.
SceneModel modelForScene(std::shared_ptr<const Kinematics> kinematics,
                         const std::vector<std::shared_ptr<const RobotGeometry>>& levels,
                         const std::vector<Obstacle>& obstacles, const std::vector<SceneNeed>& needs,
                         const SceneModelOptions& options = {});

}  // namespace fcl_stpbv
