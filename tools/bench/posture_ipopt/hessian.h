// The second derivatives of a posture's rows, for IPOPT.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fcl_stpbv/posture/support_patch.h"
#include "fcl_stpbv/posture/task.h"
#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv::benchmark {

/// Placements, the centre of mass and distances in closed form; contacts by differences of their rates.
class PostureHessian {
 public:
  /// For the rows that setUp() makes of a task with a floating base and a robot without mimic joints.
  PostureHessian(const PostureSetup& setup, const PostureTask& task, const PostureScene& scene,
                 double influence);

  /// The lower triangle of the Hessian of equal . (rows that must be 0) + atLeast . (rows that must not be
  /// negative).
  void evaluate(const Eigen::VectorXd& x, const Eigen::VectorXd& equal, const Eigen::VectorXd& atLeast,
                Eigen::MatrixXd& lower);

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  /// A function of one link's pose. While the link moves with the twist [linear; angular] it changes by
  /// slope . twist, and the slope by change.transpose() * twist.
  struct LinkTerm {
    Vector6 slope = Vector6::Zero();
    Eigen::Matrix<double, 6, 6> change = Eigen::Matrix<double, 6, 6>::Zero();
  };

  static void addPosition(const Eigen::Vector3d& point, const Eigen::Vector3d& weight, LinkTerm& term);
  void addRotation(const Placement& placement, const Eigen::Vector3d& weight, LinkTerm& term) const;
  template <class Slope>
  void addContact(std::size_t contact, const Slope& slope, Eigen::MatrixXd& lower);
  void addStability(const Eigen::VectorXd& x, const Eigen::Vector3d& weight, Eigen::MatrixXd& lower);
  void add(int link, const LinkTerm& term, Eigen::MatrixXd& lower) const;

  std::shared_ptr<const Kinematics> kinematics_;
  std::vector<Placement> placements_;
  std::vector<int> links_;  // of the contacts
  std::vector<detail::SupportPatch> patches_;
  Eigen::Matrix3d world_;
  std::unique_ptr<CentreOfMass> centre_;
  CollisionConstraints distances_;
  CollisionConstraints::SparseHessian ofDistances_;
  std::vector<std::vector<Kinematics::Dependence>> carriers_;  // of each link
  Kinematics::State state_;
  std::vector<Kinematics::Rate> along_;  // at a unit velocity of each coordinate
};

}  // namespace fcl_stpbv::benchmark
