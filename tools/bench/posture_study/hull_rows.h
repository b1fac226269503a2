// The distances of convex hulls as constraint rows, instead of those of STP-BVs: the input of an optimiser
// without the smooth volumes.
#pragma once

#include <fcl/geometry/shape/convex.h>

#include <memory>
#include <vector>

#include "fcl_stpbv/posture/problem.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv::tools {

enum class HullDistance {
  fcl,    ///< fcl::distance, tolerance 1e-10
  exact,  ///< FCL's GJK with a stopping criterion that proves convergence
};

/// One row per pair: the distance of the hulls, or minus FCL's penetration depth if they overlap, minus a
/// rounding radius for each body of the robot. The gradient is that of the witness points, or of the
/// contact's normal. As in CollisionConstraints, pairs with bounding spheres farther apart than `influence`
/// are not queried.
class HullRows : public PostureRows {
 public:
  HullRows(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
           std::vector<CheckedPair> pairs, std::vector<Obstacle> obstacles, HullDistance kind,
           double rounding, double influence);

  Kind kind() const override { return Kind::atLeast; }
  int size() const override { return static_cast<int>(pairs_.size()); }
  std::string name(int row) const override;
  void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values, Eigen::Ref<RowMatrix> jacobian) override;
  long queries() const override { return queries_; }

 private:
  struct Answer {
    double distance;
    Eigen::Vector3d normal, point1, point2;  // from 1 to 2; zero if nothing is known
  };
  Answer ask(const fcl::CollisionGeometryd& a, const Eigen::Isometry3d& poseA,
             const fcl::CollisionGeometryd& b, const Eigen::Isometry3d& poseB) const;
  Answer overlap(const fcl::CollisionGeometryd& a, const Eigen::Isometry3d& poseA,
                 const fcl::CollisionGeometryd& b, const Eigen::Isometry3d& poseB) const;

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  std::vector<CheckedPair> pairs_;
  std::vector<Obstacle> obstacles_;
  std::vector<std::shared_ptr<fcl::CollisionGeometryd>> hulls_;  // hulls of the robot's bodies
  // For each pair: the motions that carry its bodies.
  std::vector<std::vector<Kinematics::Dependence>> carriers_;
  HullDistance distance_;
  double rounding_, influence_;
  long queries_ = 0;
};

}  // namespace fcl_stpbv::tools
