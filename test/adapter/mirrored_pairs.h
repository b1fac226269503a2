// A hull and its mirror image in mirrored poses: a humanoid's left and right limb in a symmetric posture.
#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/convex/hull_graph.h"
#include "test/reference/shapes.h"

namespace fcl_stpbv::test {

/// Random hulls and poses with their mirror images across the plane y = 0.
class MirroredPairs {
 public:
  explicit MirroredPairs(std::uint64_t seed) : random_(seed) { nextShape(); }

  void nextShape() {
    const double r = random_.below(2) == 0 ? 0.0 : 0.01;
    Cloud cloud =
        randomHull(20 + random_.below(200), {0.1 + random_.uniform(0, 0.1), 0.1, 0.2}, 1000 + ++shapes_);
    geometry_ = std::make_shared<StpBvGeometry>(StpBv::build(cloud, {r, 10.0}));
    for (Eigen::Vector3d& p : cloud) p[1] = -p[1];
    mirror_ = std::make_shared<StpBvGeometry>(StpBv::build(cloud, {r, 10.0}));
    nextPose();
  }

  void nextPose() {
    const Eigen::Matrix3d across = Eigen::Vector3d(1, -1, 1).asDiagonal();
    const Eigen::Matrix3d rotation = random_.rotation();
    const Eigen::Vector3d t(random_.uniform(-1, 1), random_.uniform(0.15, 0.5), random_.uniform(-1, 1));
    pose_ = test::pose(rotation, t);
    mirrorPose_ = test::pose(across * rotation * across, across * t);
  }

  const StpBvGeometry& geometry() const { return *geometry_; }
  const StpBvGeometry& mirror() const { return *mirror_; }
  const detail::HullGraph& hull() const { return geometry_->hull(); }
  const detail::HullGraph& mirrorHull() const { return mirror_->hull(); }
  const Eigen::Isometry3d& pose() const { return pose_; }
  const Eigen::Isometry3d& mirrorPose() const { return mirrorPose_; }

 private:
  Random random_;
  std::uint64_t shapes_ = 0;
  std::shared_ptr<StpBvGeometry> geometry_, mirror_;
  Eigen::Isometry3d pose_, mirrorPose_;
};

}  // namespace fcl_stpbv::test
