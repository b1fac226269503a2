// A humanoid in front of a fridge. The motion of its upper body is planned, from standing to a posture that
// holds the can.
#pragma once

#include <vector>

#include "fcl_stpbv/robot/motion_check.h"

namespace example {

struct Scene {
  std::shared_ptr<const fcl_stpbv::Kinematics> kinematics;
  std::shared_ptr<const fcl_stpbv::RobotGeometry> smooth,
      hulls;  ///< STP-BVs, and the plain hulls of the meshes
  std::vector<fcl_stpbv::Obstacle> obstacles, hullObstacles;
  std::vector<fcl_stpbv::CheckedPair> pairs;
  Eigen::VectorXd start, goal;   ///< all coordinates; they differ only in the planned ones
  std::vector<int> coordinates;  ///< the planned coordinates: chest, head and arms

  Eigen::VectorXd whole(const double* planned) const;
};

/// Loads the scene from a project's data folder. The goal is the posture that is found for the task
/// pick_can.json.
/// @throws fcl_stpbv::Error.
Scene loadScene(const std::string& data);

}  // namespace example
