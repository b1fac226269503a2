// What a constraint of a posture gives a solver: values and exact first derivatives.
#pragma once

#include <Eigen/Core>
#include <string>

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

}  // namespace fcl_stpbv
