// A posture as a constrained optimisation problem: variables, bounds, cost, constraints.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/posture/rows.h"

namespace fcl_stpbv {

/// Sum of weight_i (q_i - reference_i)^2.
struct PostureCost {
  Eigen::VectorXd weights, reference;  ///< one entry per coordinate
};

/// The paper's eq. 3: all joints weigh 1, a moving base 0; reference (min + max) / 4, half way from 0 to the
/// middle of the joint's limits.
PostureCost quarterCost(const Kinematics& kinematics);

/// Everything that a solver asks for at one x.
struct PostureValues {
  Eigen::VectorXd x;
  double cost = 0;
  Eigen::VectorXd costGradient;
  Eigen::VectorXd equal;    ///< to be 0
  Eigen::VectorXd atLeast;  ///< not to be negative
  RowMatrix equalJacobian, atLeastJacobian;
};

/// A constraint that does not hold.
struct Violation {
  std::string name;
  double amount;  ///< how far it is from holding (m, rad, or a smooth constraint's own unit)
};

class PostureProblem {
 public:
  /// The joints keep to their limits. A moving base's rotation vector keeps within a quarter turn, axis by
  /// axis, of that at `start`: then it stays away from the full turn, where it is singular, wherever the
  /// start faces.
  PostureProblem(std::shared_ptr<const Kinematics> kinematics, PostureCost cost,
                 const Eigen::VectorXd& start);

  /// Adds constraints, and `variables` that only they use, within [0, 1]. @return the first such variable.
  int addVariables(int count);
  void add(std::shared_ptr<PostureRows> rows);

  const Kinematics& kinematics() const { return *kinematics_; }
  int variables() const { return static_cast<int>(lower_.size()); }
  int equalities() const { return equalities_; }
  int inequalities() const { return inequalities_; }
  const Eigen::VectorXd& lower() const { return lower_; }
  const Eigen::VectorXd& upper() const { return upper_; }
  std::string equalityName(int row) const { return name(PostureRows::Kind::equal, row); }
  std::string inequalityName(int row) const { return name(PostureRows::Kind::atLeast, row); }
  std::string variableName(int i) const;

  /// q within the bounds, and own variables that share out evenly.
  Eigen::VectorXd variablesAt(const Eigen::VectorXd& q) const;
  /// Second derivatives of the cost: it has no others.
  Eigen::VectorXd costCurvature() const;
  /// Computed anew only where x differs from the last one. Valid until the next call.
  const PostureValues& evaluate(const Eigen::Ref<const Eigen::VectorXd>& x);
  /// Distances computed so far, each with its gradient.
  long queries() const;
  /// What is farther than `tolerance` from holding, worst first; bounds included.
  std::vector<Violation> violations(const Eigen::Ref<const Eigen::VectorXd>& x, double tolerance);

 private:
  std::string name(PostureRows::Kind kind, int row) const;

  std::shared_ptr<const Kinematics> kinematics_;
  PostureCost cost_;
  Eigen::VectorXd lower_, upper_;
  std::vector<std::pair<int, int>> shares_;  // first own variable and count of each addVariables()
  std::vector<std::shared_ptr<PostureRows>> rows_;
  int equalities_ = 0, inequalities_ = 0;
  Kinematics::State state_;
  PostureValues values_;
  bool known_ = false;
};

}  // namespace fcl_stpbv
