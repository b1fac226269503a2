// Meshes and primitives themselves, without hulls and margins: what no model of a robot can clear.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <map>
#include <memory>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/scene_model.h"

namespace fcl_stpbv::detail {

/// The shapes that a robot's whole bodies stand for. Meshes are read when they are first asked for.
class OwnShapes {
 public:
  explicit OwnShapes(std::shared_ptr<const RobotGeometry> whole) : whole_(std::move(whole)) {}

  /// Whether two links, or a link and an obstacle, are so near that no bodies with at least these bodies' r
  /// meet the need. Volumes and parts contain their mesh and lie at least r outside it.
  /// @throws Error naming a mesh that cannot be read.
  bool rulesOut(const SceneNeed& need, const Kinematics& kinematics, const std::vector<Obstacle>& obstacles);

 private:
  const fcl::CollisionGeometryd& shape(int body);

  std::shared_ptr<const RobotGeometry> whole_;
  std::map<int, std::shared_ptr<const fcl::CollisionGeometryd>> shapes_;  // by body
};

}  // namespace fcl_stpbv::detail
