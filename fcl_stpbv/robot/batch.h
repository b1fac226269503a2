// Distances or collision checks of many configurations in one call, on several threads.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fcl_stpbv/robot/collision_checker.h"
#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv {

/// How the columns of a batch are related. This changes only the time, and the results by no more than
/// rounding.
enum class Sequence {
  independent,  ///< unrelated, such as random samples: each query starts without a cache
  path,         ///< small steps along one path: each query starts from the previous answer
};

/// Number of columns that one thread takes at a time. Each such piece starts without a cache. So a batch
/// gives the same results if it is split at a multiple of this number.
constexpr Eigen::Index kBatchPiece = 64;

/// d(q) and J(q) of many configurations. Each worker thread has its own copy of the constraints. The results
/// are the same for any number of threads; least distances (CheckerBatch) are the same up to rounding. Not
/// thread-safe: only one thread at a time may call it.
class ConstraintsBatch {
 public:
  using Configurations = Eigen::Ref<const Eigen::MatrixXd>;  ///< one configuration per column
  using Matrix = Eigen::Ref<Eigen::MatrixXd>;                ///< output matrix

  /// @throws Error unless `threads` is from 1 to 256.
  ConstraintsBatch(const CollisionConstraints& constraints, int threads);
  /// Moves the contents of another object, which may only be destroyed or assigned to afterwards.
  ConstraintsBatch(ConstraintsBatch&&) noexcept;
  /// The same.
  ConstraintsBatch& operator=(ConstraintsBatch&&) noexcept;
  ~ConstraintsBatch();

  /// Distances (m): `q` has one configuration per column, and `d` (rows() x N) gets one column for each. For
  /// a column of q that is not finite, see CollisionConstraints::evaluate. @returns whether all of q was
  /// finite. @throws Error for matrices of a wrong size.
  bool evaluate(const Configurations& q, Sequence sequence, Matrix d);
  /// evaluate() that also writes the non-zero entries of J. `values` is nonZeros() x N, in the structure of
  /// makeJacobian().
  bool evaluateValues(const Configurations& q, Sequence sequence, Matrix d, Matrix values);

 private:
  class Impl;
  bool compute(const Configurations& q, Sequence sequence, Matrix d, Matrix* values);
  std::unique_ptr<Impl> impl_;
};

/// The results of a CollisionChecker for many configurations, computed in the same way.
class CheckerBatch {
 public:
  using Configurations = Eigen::Ref<const Eigen::MatrixXd>;            ///< one configuration per column
  using Verdicts = Eigen::Ref<Eigen::Array<bool, Eigen::Dynamic, 1>>;  ///< one entry per configuration

  /// @throws Error unless `threads` is from 1 to 256.
  CheckerBatch(const CollisionChecker& checker, int threads);
  /// Moves the contents of another object, which may only be destroyed or assigned to afterwards.
  CheckerBatch(CheckerBatch&&) noexcept;
  /// The same.
  CheckerBatch& operator=(CheckerBatch&&) noexcept;
  ~CheckerBatch();

  /// For each configuration, whether it collides; see CollisionChecker::collides.
  /// @throws Error for a matrix or a vector of another size.
  void collides(const Configurations& q, Sequence sequence, Verdicts hit);
  /// For each configuration, the least distance of all pairs (m); see CollisionChecker::minDistance.
  void minDistance(const Configurations& q, Sequence sequence, Eigen::Ref<Eigen::VectorXd> least);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fcl_stpbv
