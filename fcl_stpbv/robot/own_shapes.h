// Distances of the meshes and primitives themselves, without hulls and margins. No model of a robot can be
// clear where these are not.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/scene_model.h"

namespace fcl_stpbv::detail {

/// The shapes that a robot's whole bodies stand for. Meshes are read when they are first asked for, by any
/// thread.
class OwnShapes {
 public:
  using Bodies = std::vector<const Body*>;

  explicit OwnShapes(std::shared_ptr<const RobotGeometry> whole) : whole_(std::move(whole)) {}

  /// Whether two links, or a link and an obstacle, are so near that no bodies with at least these bodies' r
  /// meet the need. Volumes and parts contain their mesh and lie at least r outside it.
  /// If `bodies1` or `bodies2` is given, these bodies take the place of that link's own shapes, without a
  /// margin.
  /// @throws Error naming a mesh that cannot be read.
  bool rulesOut(const SceneNeed& need, const Kinematics& kinematics, const std::vector<Obstacle>& obstacles,
                const Bodies* bodies1 = nullptr, const Bodies* bodies2 = nullptr);

 private:
  struct Placed {
    const fcl::CollisionGeometryd* geometry;
    Eigen::Isometry3d pose;
    double margin;  // that every body around it has at least (m)
  };
  const fcl::CollisionGeometryd& shape(int body);
  std::vector<Placed> placed(int link, const Eigen::Isometry3d& pose, const Bodies* bodies);

  std::shared_ptr<const RobotGeometry> whole_;
  std::mutex mutex_;
  std::map<int, std::shared_ptr<const fcl::CollisionGeometryd>> shapes_;  // by body
};

}  // namespace fcl_stpbv::detail
