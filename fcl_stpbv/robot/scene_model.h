// Chooses the level of detail of a robot's bodies for a scene: coarse volumes where they are enough, finer
// volumes and convex parts where a pair needs them. This keeps the numbers of vertices and of constraints
// small.
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

/// A requirement on the model: in one configuration, two links, or a link and an obstacle, must be farther
/// apart than `clearance`. If the distance of the exact shapes is at most `clearance` plus the r of both
/// bodies (Body::radii), no model can meet it, and none is refined for it.
struct SceneNeed {
  LinkPair pair;         ///< the two links, or the link and the obstacle
  Eigen::VectorXd q;     ///< the configuration (rad, m)
  double clearance = 0;  ///< distance that the pair must exceed (m)
};

/// Technical options of modelForScene(). The result does not depend on them.
struct SceneModelOptions {
  std::string cacheFolder = defaultCacheFolder();  ///< cache for convex parts, "" for no cache
  int threads = 1;                                 ///< number of threads
  /// Called from time to time with the steps done, the number of all steps, and a text.
  std::function<void(std::size_t, std::size_t, const std::string&)> progress;
};

/// A robot with the detail that its needs require.
struct SceneModel {
  /// The bodies; its `byParts` lists the pairs that use convex parts.
  std::shared_ptr<const RobotGeometry> geometry;
  std::vector<SceneNeed> unmet;  ///< needs that even the finest bodies do not meet
};

/// Loads whole bodies at several levels, from coarse to fine. There is one level for each of `budgets`, the
/// limits on the over-cover (m, descending, all above r): its volumes have few vertices and a large r
/// (GeometryOptions::overCoverBudget). The last level has the volumes of `options`. @throws Error as
/// loadGeometry() does, and for budgets that do not descend.
std::vector<std::shared_ptr<const RobotGeometry>> loadLevels(const RobotModel& robot,
                                                             const GeometryOptions& options,
                                                             const std::vector<double>& budgets);

/// Refines links until all needs are met that can be met. Every link starts at the first of `levels`. In each
/// round the cheapest step that meets a need is taken: first a finer level of one link, then 2 parts, then 4,
/// then 8. Of equally cheap steps, the one that meets most needs is taken. If no single link helps, two links
/// are refined together. Only pairs with a need use convex parts; all others keep the whole bodies.
/// Good `needs` are the pairs that matter, in configurations that matter: start and goal of a task, the
/// closest configuration of each pair, samples. A need that the first level already meets costs only one
/// distance query.
/// @throws Error if the levels have different bodies, for a need with a pair that does not exist, and, naming
/// the mesh, for a mesh that cannot be split.
SceneModel modelForScene(std::shared_ptr<const Kinematics> kinematics,
                         const std::vector<std::shared_ptr<const RobotGeometry>>& levels,
                         const std::vector<Obstacle>& obstacles, const std::vector<SceneNeed>& needs,
                         const SceneModelOptions& options = {});

}  // namespace fcl_stpbv
