// A frame of a link at a place in the world, some directions left free.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "fcl_stpbv/posture/rows.h"

namespace fcl_stpbv {

/// A frame of a link and where it is to be.
struct Placement {
  std::string name;                                          ///< for messages
  int link = 0;                                              ///< index into RobotModel::links
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();   ///< in the link's frame
  Eigen::Isometry3d target = Eigen::Isometry3d::Identity();  ///< in the world
  /// Along and about the target's axes: x, y, z, rx, ry, rz. Of the rotations none, one or all are free; with
  /// one, the frame's axis of that name points as the target's.
  std::array<bool, 6> free{};
};

/// Rows that vanish where the link is placed: the frame's position in the target's axes, then the rotation
/// vector from target to frame, or with a free axis the rotation vector that tilts the target's axis into the
/// frame's. Neither vanishes anywhere else; both have a singularity at half a turn only.
class PlacementRows : public PostureRows {
 public:
  /// @throws Error for two free rotations.
  PlacementRows(const Kinematics& kinematics, Placement placement);

  Kind kind() const override { return Kind::equal; }
  int size() const override { return static_cast<int>(rows_.size()); }
  std::string name(int row) const override;
  void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values, Eigen::Ref<RowMatrix> jacobian) override;

 private:
  // Rotational error in the target's axes, and the matrix that turns an angular velocity into its rate.
  void rotation(const Eigen::Matrix3d& frame, Eigen::Vector3d& error, Eigen::Matrix3d& rate) const;

  Placement placement_;
  std::vector<int> rows_;  // directions that are not free
  int freeAxis_ = -1;
  struct Carrier {
    std::size_t motion;
    int coordinate;
  };
  std::vector<Carrier> carriers_;
};

}  // namespace fcl_stpbv
