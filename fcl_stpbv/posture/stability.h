// Static stability: the centre of mass stands over the hull of the contacts.
#pragma once

#include <vector>

#include "fcl_stpbv/posture/rows.h"

namespace fcl_stpbv {

/// Mass and centre of mass of a robot's links, and how the coordinates move it.
class CentreOfMass {
 public:
  /// @throws Error for a robot without mass.
  explicit CentreOfMass(const Kinematics& kinematics);

  /// Of all links (kg).
  double mass() const { return mass_; }
  /// World frame. `jacobian` (3 x coordinates) is overwritten.
  Eigen::Vector3d evaluate(const Kinematics::State& state, Eigen::Ref<Eigen::Matrix3Xd> jacobian);

 private:
  struct Link {
    int parent;
    double mass;
    Eigen::Vector3d centre;
  };
  struct Motion {
    int link;  // the first one that it carries
    int coordinate;
  };
  std::vector<Link> links_;
  std::vector<Motion> motions_;
  double mass_ = 0;
  std::vector<double> below_;                 // mass of each link and all below it
  std::vector<Eigen::Vector3d> momentBelow_;  // their masses times positions
};

/// Points of one link that touch the ground: the corners of a convex patch, or any points of it.
struct Contact {
  int link = 0;                         ///< index into RobotModel::links
  std::vector<Eigen::Vector3d> points;  ///< in the link's frame (m)
};

/// The corners of a flat convex patch moved inwards so that each edge moves by `margin` (m). One or two
/// points have no inside: they stay where they are with a margin of 0. @throws Error where nothing is left.
std::vector<Eigen::Vector3d> shrunk(const std::vector<Eigen::Vector3d>& points, double margin);

/// Rows: the centre of mass, seen along z, is the sum of w_k times contact point k, with w_k >= 0 of sum 1.
/// The weights are variables of their own, from x[firstWeight] on, so that contacts may move with the posture
/// and nothing switches as they do. Each contact is shrunk by the margin, so the centre of mass keeps at
/// least that far from the support polygon's edges.
class StaticStability : public PostureRows {
 public:
  /// Keeps a reference to `kinematics`. `margin` in m. @throws Error where a contact has nothing left.
  StaticStability(const Kinematics& kinematics, std::vector<Contact> contacts, double margin,
                  int firstWeight);

  /// Number of weights, one per contact point.
  int weights() const { return weights_; }
  Kind kind() const override { return Kind::equal; }
  int size() const override { return 3; }
  std::string name(int row) const override;
  void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values, Eigen::Ref<RowMatrix> jacobian) override;

 private:
  const Kinematics& kinematics_;
  CentreOfMass centre_;
  std::vector<Contact> contacts_;
  std::vector<std::vector<Kinematics::Dependence>> carriers_;  // of each contact
  int firstWeight_, weights_ = 0;
  Eigen::Matrix3Xd centreJacobian_;
};

}  // namespace fcl_stpbv
