// A posture as a constrained optimisation problem: variables, bounds, cost, constraints.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/posture/rows.h"

namespace fcl_stpbv {

/// Sum of weight_i (q_i - reference_i)^2.
struct PostureCost {
  Eigen::VectorXd weights;    ///< one entry per coordinate, 0 or more
  Eigen::VectorXd reference;  ///< one entry per coordinate (rad or m)
};

/// The paper's eq. 3: all joints weigh 1, a moving base 0; reference (min + max) / 4, half way from 0 to the
/// middle of the joint's limits.
PostureCost quarterCost(const Kinematics& kinematics);

/// Everything that a solver asks for at one x.
struct PostureValues {
  Eigen::VectorXd x;             ///< the variables
  double cost = 0;               ///< PostureCost at x
  Eigen::VectorXd costGradient;  ///< one entry per variable
  Eigen::VectorXd equal;         ///< to be 0
  Eigen::VectorXd atLeast;       ///< not to be negative
  RowMatrix equalJacobian;       ///< one row per entry of `equal`, one column per variable
  RowMatrix atLeastJacobian;     ///< one row per entry of `atLeast`
};

/// A constraint that does not hold.
struct Violation {
  std::string name;  ///< of the constraint
  double amount;     ///< how far it is from holding (m, rad, or a smooth constraint's own unit)
};

/// A cost and constraints over the robot's coordinates and the constraints' own variables.
class PostureProblem {
 public:
  /// The joints keep to their limits. A moving base's rotation vector keeps within a
  /// quarter turn, axis by axis, of that at `start`: then it stays away from the full turn,
  /// where it is singular, wherever the start faces.
  PostureProblem(std::shared_ptr<const Kinematics> kinematics, PostureCost cost,
                 const Eigen::VectorXd& start);

  /// Adds constraints, and `variables` that only they use, within [0, 1]. @return the first such variable.
  int addVariables(int count);
  /// Adds constraints.
  void add(std::shared_ptr<PostureRows> rows);

  /// The robot.
  const Kinematics& kinematics() const { return *kinematics_; }
  /// Number of variables: the coordinates, then the constraints' own.
  int variables() const { return static_cast<int>(lower_.size()); }
  /// Number of rows to be 0.
  int equalities() const { return equalities_; }
  /// Number of rows not to be negative.
  int inequalities() const { return inequalities_; }
  /// Least values of the variables.
  const Eigen::VectorXd& lower() const { return lower_; }
  /// Largest values of the variables.
  const Eigen::VectorXd& upper() const { return upper_; }
  /// What a row to be 0 is about.
  std::string equalityName(int row) const { return name(PostureRows::Kind::equal, row); }
  /// What a row not to be negative is about.
  std::string inequalityName(int row) const { return name(PostureRows::Kind::atLeast, row); }
  /// A joint's name, or whose weight the variable is.
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
