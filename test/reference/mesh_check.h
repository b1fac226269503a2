// Checks by FCL, on the original triangle meshes, whether a posture is free of collisions. It uses no STP-BV,
// no hull and none of this library's distances.
#pragma once

#include <fcl/narrowphase/collision_object.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/posture/task.h"

namespace fcl_stpbv::test {

class MeshCheck {
 public:
  /// Reads the meshes again. `allowed` are names of a link and an obstacle that may touch.
  MeshCheck(std::shared_ptr<const RobotModel> robot, std::shared_ptr<const RobotModel> scene,
            const std::vector<std::string>& packagePath,
            std::vector<std::pair<std::string, std::string>> allowed = {});

  /// Replaces the obstacles by these: shapes of FCL at their poses.
  void setObstacles(const std::vector<Obstacle>& obstacles);

  /// Names of the pairs in collision at q: the given pairs of links, and all links with all obstacles.
  std::vector<std::string> collisions(const Kinematics& kinematics, const Eigen::VectorXd& q,
                                      const std::vector<std::pair<int, int>>& links);

 private:
  struct Part {
    int link;
    std::string name;
    std::shared_ptr<fcl::CollisionGeometryd> geometry;
    Eigen::Isometry3d pose;  // in the link
  };
  static std::vector<Part> partsOf(const RobotModel& model, const std::vector<std::string>& packagePath);

  std::vector<Part> robot_, scene_;
  std::vector<Eigen::Isometry3d> scenePoses_;
  std::vector<std::pair<std::string, std::string>> allowed_;
};

/// The pairs of links among some pairs of bodies.
std::vector<std::pair<int, int>> linksOf(const std::vector<CheckedPair>& pairs,
                                         const RobotGeometry& geometry);

}  // namespace fcl_stpbv::test
