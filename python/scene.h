// A robot with its obstacles, loaded for Python, and its pairs of bodies.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "fcl_stpbv/robot/scene_model.h"
#include "loading.h"
#include "parts.h"

namespace fcl_stpbv {

/// The data that do not depend on the level of detail of the links.
struct PythonScene {
  /// First link, second link or obstacle, configuration, clearance (m).
  using Need = std::tuple<std::string, std::string, Floats<Eigen::VectorXd>, double>;

  std::shared_ptr<const RobotModel> robot;
  std::optional<Srdf> srdf;
  std::shared_ptr<const Kinematics> kinematics;
  GeometryOptions options, aroundOptions;
  std::shared_ptr<const RobotModel> around;  ///< null without obstacles
  std::vector<Obstacle> obstacles;
  bool baseMoves = false;
  bool measureMeshes = false;  ///< whether the bodies get their Body::volumeExcess
  Loading loading;

  /// Loads all files and covers primitives. @return the robot's bodies @throws Error naming the file.
  std::shared_ptr<const RobotGeometry> load(const std::string& base,
                                            const std::optional<Path>& obstaclesUrdf);

  /// The pairs to check: those that the SRDF does not leave out, and the pairs with obstacles.
  std::vector<CheckedPair> pairs(const RobotGeometry& geometry) const;

  /// The bodies, as fine as the needs require (scene_model.h). `unmet` receives the indices of needs that no
  /// bodies meet. @throws Error naming the argument.
  std::shared_ptr<const RobotGeometry> modelFor(const std::vector<Need>& needs,
                                                const std::vector<double>& budgets, int threads,
                                                std::vector<std::size_t>& unmet) const;

 private:
  SceneNeed toNeed(const Need& need, const std::string& name, const std::vector<CheckedPair>& checked,
                   const RobotGeometry& geometry) const;
};

}  // namespace fcl_stpbv
