// A lower bound on the gap of two bodies over a box of joint values: a plane fixed to one link between them,
// and how far the joints on either side of that link can push the bodies towards it (docs/proofs.md).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "fcl_stpbv/robot/body_points.h"
#include "fcl_stpbv/robot/push_bound.h"

namespace fcl_stpbv::detail {

/// Handles one box at a time. Allocates nothing once it has seen its largest bodies and its longest chain.
class PlaneBound {
 public:
  /// Sets the joints in order, and the bodies in the world at the middle of the box. The bodies are stored
  /// as references.
  void set(const std::vector<BoxJoint>& joints, const BodyPoints& first, const BodyPoints& second);

  /// Lower bound on the gap (m) wherever the joints are in the box. Starts from the unit normal (from the
  /// first body to the second) and the nearest points at the middle of the box, improves the normal, and
  /// stops at the first bound above `enough`. `shares`, of the size of the box, receives how much each
  /// coordinate reduces the gap.
  double gap(const Eigen::Vector3d& normal, const std::array<Eigen::Vector3d, 2>& nearest, double enough,
             Eigen::VectorXd& shares);

  /// The bound for one plane. It is fixed to the link after the first `reference` joints, and has the unit
  /// normal n at the middle of the box.
  double gapAlong(const Eigen::Vector3d& n, std::size_t reference, Eigen::VectorXd& shares);

 private:
  void fixTo(std::size_t reference);
  void rank(const Eigen::Vector3d& n, const std::array<Eigen::Vector3d, 2>& nearest);

  std::vector<OutwardJoint> joints_;
  BodySide first_, second_;
  PushBound push_;
  std::vector<std::pair<double, std::size_t>> order_;
  Eigen::VectorXd trial_;
};

}  // namespace fcl_stpbv::detail
