// A robot in one posture as FCL objects, one per body, in FCL's broadphase.
#pragma once

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision_object.h>

#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv::tools {

/// Each object's user data is its Body. The model and the geometry must outlive this object.
class PosedRobot {
 public:
  /// Bodies of one link are never checked against each other, nor are pairs of links that `srdf` leaves out.
  PosedRobot(const Kinematics& kinematics, const RobotGeometry& geometry, const Srdf& srdf);

  void moveTo(const Eigen::VectorXd& q);

  fcl::DynamicAABBTreeCollisionManagerd& manager() { return manager_; }
  const Kinematics::State& state() const { return state_; }
  const fcl::CollisionObjectd& object(std::size_t body) const { return *objects_[body]; }
  /// Pairs of bodies to check.
  const std::vector<std::pair<int, int>>& pairs() const { return pairs_; }
  bool checked(const fcl::CollisionObjectd* a, const fcl::CollisionObjectd* b) const;

 private:
  int index(const fcl::CollisionObjectd* object) const;

  const Kinematics& kinematics_;
  const RobotGeometry& geometry_;
  Kinematics::State state_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  std::vector<std::pair<int, int>> pairs_;
  std::set<std::pair<int, int>> checked_;
  fcl::DynamicAABBTreeCollisionManagerd manager_;
};

/// For `manager().distance(&check, selfDistanceCallback)`: the library's callback, without the pairs that are
/// left out.
struct SelfCheck {
  const PosedRobot* robot;
  DistanceData data;
};
bool selfDistanceCallback(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* check, double& dist);

}  // namespace fcl_stpbv::tools
