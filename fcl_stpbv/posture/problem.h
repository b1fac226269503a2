// A posture as a constrained optimisation problem: variables, bounds, cost, constraints; and its solver.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv {

/// One constraint after the other.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A few rows g(x), all of which are to be 0 or all of which are not to be negative. The variables x are the
/// robot's coordinates q (Kinematics) and, after them, what a constraint brings along (StaticStability).
class PostureRows {
 public:
  /// What is asked of the rows.
  enum class Kind { equal, atLeast };

  /// A vector of variables and where it puts the links.
  struct Point {
    Eigen::Ref<const Eigen::VectorXd> x;  ///< the variables
    const Kinematics::State& state;       ///< of the coordinates in x
  };

  virtual ~PostureRows() = default;
  /// The same for all rows.
  virtual Kind kind() const = 0;
  /// Number of rows.
  virtual int size() const = 0;
  /// What a row is about, for messages.
  virtual std::string name(int row) const = 0;
  /// Writes g and its Jacobian, size() x variables, which comes zeroed. Lengths in m, angles in rad.
  virtual void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values,
                        Eigen::Ref<RowMatrix> jacobian) = 0;
  /// Distances computed so far, each with its gradient.
  virtual long queries() const { return 0; }
};

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
  /// The joints keep to their limits, and to those of the joints that mimic them. A moving base's rotation
  /// vector keeps within a quarter turn, axis by axis, of that at `start`: then it stays away from the full
  /// turn, where it is singular, wherever the start faces. @throws Error naming the joints where mimic ones
  /// leave a joint no value, and, as all below do, for vectors of another size.
  PostureProblem(std::shared_ptr<const Kinematics> kinematics, PostureCost cost,
                 const Eigen::VectorXd& start);

  /// Adds `count` variables within [0, 1], for constraints that come with their own. @return the index of the
  /// first one.
  int addVariables(int count);
  /// Adds constraints.
  void add(std::shared_ptr<PostureRows> rows);

  /// The robot.
  const Kinematics& kinematics() const { return *kinematics_; }
  /// The robot, for whoever keeps it longer.
  const std::shared_ptr<const Kinematics>& sharedKinematics() const { return kinematics_; }
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
  /// A variable's name and which of its limits it is; of a joint that mimics it, that one's name too.
  std::string limitName(int i, bool upper) const;

  /// What does not hold and what no variable changes: it is among the violations everywhere.
  void addStill(const std::vector<Violation>& violations) {
    still_.insert(still_.end(), violations.begin(), violations.end());
  }
  /// All that was added so.
  const std::vector<Violation>& still() const { return still_; }

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
  /// The same without still().
  std::vector<Violation> missed(const Eigen::Ref<const Eigen::VectorXd>& x, double tolerance);

 private:
  std::string name(PostureRows::Kind kind, int row) const;

  std::shared_ptr<const Kinematics> kinematics_;
  PostureCost cost_;
  Eigen::VectorXd lower_, upper_;
  std::vector<std::string> lowerOf_, upperOf_;  // the joint that mimics the coordinate and sets its limit
  std::vector<Violation> still_;
  std::vector<std::pair<int, int>> shares_;  // first own variable and count of each addVariables()
  std::vector<std::shared_ptr<PostureRows>> rows_;
  int equalities_ = 0, inequalities_ = 0;
  Kinematics::State state_;
  PostureValues values_;
  bool known_ = false;
};

/// When a solver ends.
struct SolverOptions {
  int maxIterations = 300;      ///< models built at most
  double maxSeconds = 10;       ///< s
  double tolerance = 1e-6;      ///< a constraint holds within this (m, rad)
  double costTolerance = 1e-8;  ///< relative change of the cost in one iteration at which it ends
  /// Inequalities with more slack than this are left out of an iteration's model until they have less.
  double activation = 0.1;
  /// Asked at every model: true, which it stays, ends the search. Null: nothing does.
  std::function<bool()> stop;
};

/// Where a solver ended.
struct SolverOutcome {
  Eigen::VectorXd x;   ///< best found: the constraints hold, or are least violated
  int iterations = 0;  ///< models built, each from one evaluation of all derivatives
  std::string status;  ///< why it ended, for people
};

/// Sequential quadratic programming by NLopt's SLSQP. @throws Error for a start of another size.
SolverOutcome solveBySlsqp(PostureProblem& problem, const Eigen::VectorXd& start,
                           const SolverOptions& options);

}  // namespace fcl_stpbv
