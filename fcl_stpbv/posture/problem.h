// The search for a posture as a constrained optimisation problem: variables, bounds, cost, constraints; and
// its solver.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv {

/// Row-major matrix: one constraint per row.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A group of constraints g(x), one per row: either all g = 0 or all g >= 0. The variables x are the robot's
/// coordinates q (Kinematics), followed by the additional variables of constraints (such as StaticStability).
class PostureRows {
 public:
  /// The kind of constraint: g = 0 or g >= 0.
  enum class Kind { equal, atLeast };

  /// A vector of variables and the poses of the links there.
  struct Point {
    Eigen::Ref<const Eigen::VectorXd> x;  ///< the variables
    const Kinematics::State& state;       ///< poses and motions of the links for the coordinates in x
  };

  virtual ~PostureRows() = default;
  /// Kind of all rows.
  virtual Kind kind() const = 0;
  /// Number of rows.
  virtual int size() const = 0;
  /// A row's name, for messages.
  virtual std::string name(int row) const = 0;
  /// A row's unit, for messages: "m", "rad", or "" for a number.
  virtual std::string unit(int /*row*/) const { return "m"; }
  /// Writes g and its Jacobian (size() x variables). The caller has set the Jacobian to zero. Lengths in m,
  /// angles in rad. What it throws ends a search and reaches the caller.
  virtual void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values,
                        Eigen::Ref<RowMatrix> jacobian) = 0;
  /// Number of distances computed so far, each with its gradient.
  virtual long queries() const { return 0; }
};

/// Sum of weight_i (q_i - reference_i)^2.
struct PostureCost {
  Eigen::VectorXd weights;    ///< one entry per coordinate, not negative
  Eigen::VectorXd reference;  ///< one entry per coordinate (rad or m)
};

/// The cost of the paper's eq. 3. All joints have the weight 1 and a moving base 0. The reference is (min +
/// max) / 4, half way from 0 to the middle of the joint's limits.
PostureCost quarterCost(const Kinematics& kinematics);

/// All values and derivatives that a solver needs at one x.
struct PostureValues {
  Eigen::VectorXd x;             ///< the variables
  double cost = 0;               ///< PostureCost at x
  Eigen::VectorXd costGradient;  ///< one entry per variable
  Eigen::VectorXd equal;         ///< values that must be 0
  Eigen::VectorXd atLeast;       ///< values that must not be negative
  RowMatrix equalJacobian;       ///< one row per entry of `equal`, one column per variable
  RowMatrix atLeastJacobian;     ///< one row per entry of `atLeast`
};

/// A constraint that does not hold.
struct Violation {
  std::string name;  ///< name of the constraint
  double amount;     ///< how far it is from holding (m, rad, or a smooth constraint's own unit)
  /// Unit of the amount: "m", "rad", or "" for a number and for a coordinate beyond its limit. A smooth
  /// constraint has "m".
  std::string unit = "m";
};

/// Cost and constraints as functions of the robot's coordinates and the constraints' additional variables.
class PostureProblem {
 public:
  /// Sets the bounds of the variables. Joints keep to their limits and to those of the joints that mimic
  /// them. Each component of a floating base's rotation vector stays within a quarter turn of that at
  /// `start`. So the vector stays away from the full turn, where it is singular, for any orientation of the
  /// start. The angle of a planar base stays within half a turn of that at `start`.
  /// @throws Error naming the joints, if the limits of mimic joints leave no value for a joint. This and all
  /// functions below throw Error for vectors of a wrong size.
  PostureProblem(std::shared_ptr<const Kinematics> kinematics, PostureCost cost,
                 const Eigen::VectorXd& start);

  /// Adds `count` variables with bounds [0, 1], for constraints that have additional variables. @return the
  /// index of the first one.
  int addVariables(int count);
  /// Adds a group of constraints.
  void add(std::shared_ptr<PostureRows> rows);

  /// The robot.
  const Kinematics& kinematics() const { return *kinematics_; }
  /// The robot, as a shared pointer.
  const std::shared_ptr<const Kinematics>& sharedKinematics() const { return kinematics_; }
  /// Number of variables: the coordinates, then the constraints' additional ones.
  int variables() const { return static_cast<int>(lower_.size()); }
  /// Number of equality constraints (g = 0).
  int equalities() const { return equalities_; }
  /// Number of inequality constraints (g >= 0).
  int inequalities() const { return inequalities_; }
  /// Lower bounds of the variables.
  const Eigen::VectorXd& lower() const { return lower_; }
  /// Upper bounds of the variables.
  const Eigen::VectorXd& upper() const { return upper_; }
  /// Name of an equality constraint.
  std::string equalityName(int row) const { return rowOf(PostureRows::Kind::equal, row).name; }
  /// Name of an inequality constraint.
  std::string inequalityName(int row) const { return rowOf(PostureRows::Kind::atLeast, row).name; }
  /// Name of a variable: the coordinate's name, or "contact weight" for an additional variable.
  std::string variableName(int i) const;
  /// Name of a variable's lower or upper limit. If the limit comes from a joint that mimics it, that joint's
  /// name is included.
  std::string limitName(int i, bool upper) const;

  /// Adds violations that do not depend on the variables, such as a collision of two bodies that cannot move.
  /// violations() lists them for every x.
  void addUnavoidable(const std::vector<Violation>& violations) {
    unavoidable_.insert(unavoidable_.end(), violations.begin(), violations.end());
  }
  /// All violations that were added by addUnavoidable().
  const std::vector<Violation>& unavoidable() const { return unavoidable_; }

  /// The variables for the coordinates q: q clamped to the bounds, and the same value for all additional
  /// variables that were added together, with sum 1.
  Eigen::VectorXd variablesAt(const Eigen::VectorXd& q) const;
  /// Second derivatives of the cost: the diagonal of its Hessian, which has no other entries.
  Eigen::VectorXd costCurvature() const;
  /// Values and derivatives at x. Recomputed only if x differs from the last call. The reference is valid
  /// until the next call.
  const PostureValues& evaluate(const Eigen::Ref<const Eigen::VectorXd>& x);
  /// Number of distances computed so far, each with its gradient.
  long queries() const;
  /// The constraints and bounds that are violated by more than `tolerance` at x, worst first.
  std::vector<Violation> violations(const Eigen::Ref<const Eigen::VectorXd>& x, double tolerance);
  /// violations() without those of unavoidable().
  std::vector<Violation> missed(const Eigen::Ref<const Eigen::VectorXd>& x, double tolerance);

 private:
  // A row of all rows of this kind, with the amount 0.
  Violation rowOf(PostureRows::Kind kind, int row) const;

  std::shared_ptr<const Kinematics> kinematics_;
  PostureCost cost_;
  Eigen::VectorXd lower_, upper_;
  // The joint that mimics the coordinate and sets its limit; "" if none does.
  std::vector<std::string> lowerOf_, upperOf_;
  std::vector<Violation> unavoidable_;
  // Index of the first variable and number of variables of each addVariables()
  std::vector<std::pair<int, int>> shares_;
  std::vector<std::shared_ptr<PostureRows>> rows_;
  int equalities_ = 0, inequalities_ = 0;
  Kinematics::State state_;
  PostureValues values_;
  bool known_ = false;
};

/// Stopping criteria and settings of a solver.
struct SolverOptions {
  int maxIterations = 300;  ///< largest number of iterations, each with one quadratic model
  /// Limit of the time (s). A search that ends because of it ends elsewhere on another machine.
  double maxSeconds = std::numeric_limits<double>::infinity();
  double tolerance = 1e-6;      ///< tolerance within which a constraint holds (m, rad)
  double costTolerance = 1e-8;  ///< stops when the relative change of the cost in one iteration is below this
  /// An inequality enters the model if its value is below this when the solver starts or restarts, or when it
  /// is violated (m, rad).
  double activation = 0.1;
  /// Called in every iteration; returning true stops the search. It must then keep returning true. What it
  /// throws ends the search and reaches the caller. May be null.
  std::function<bool()> stop;
};

/// Result of a solver.
struct SolverOutcome {
  Eigen::VectorXd x;   ///< best point found: the constraints hold, or are least violated
  int iterations = 0;  ///< iterations, each with one evaluation of all derivatives
  std::string status;  ///< why the solver stopped, as text
};

/// Sequential quadratic programming by NLopt's SLSQP. @throws Error for a start of another size, and whatever
/// rows and `stop` throw.
SolverOutcome solveBySlsqp(PostureProblem& problem, const Eigen::VectorXd& start,
                           const SolverOptions& options);

}  // namespace fcl_stpbv
