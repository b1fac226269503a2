// Many configurations in one call, shared out among threads.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fcl_stpbv/robot/collision_checker.h"
#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv {

/// What the columns of a batch have to do with each other. It changes the time only, as far as rounding goes.
enum class Sequence {
  independent,  ///< nothing, as samples: each starts from nothing
  path,         ///< small steps along one path: each starts from the one before
};

/// Columns of one piece of a batch. Each piece begins without a memory, so a batch that is cut between pieces
/// gives the same answers.
constexpr Eigen::Index kBatchPiece = 64;

/// d(q) and J(q) of many configurations. Each thread has its own copy of the constraints. The answers are the
/// same for any number of threads, least distances to rounding. One thread at a time may use one.
class ConstraintsBatch {
 public:
  using Configurations = Eigen::Ref<const Eigen::MatrixXd>;  ///< one a column
  using Matrix = Eigen::Ref<Eigen::MatrixXd>;                ///< room for results

  /// @throws Error unless `threads` is from 1 to 256.
  ConstraintsBatch(const CollisionConstraints& constraints, int threads);
  /// Takes over all that the other one has; the other one may only be destroyed.
  ConstraintsBatch(ConstraintsBatch&&) noexcept;
  ~ConstraintsBatch();

  /// Distances, a column for each configuration: `d` is rows() x N. A column of q that is not finite gets
  /// what CollisionConstraints::evaluate gives it.
  /// @returns whether all were finite. @throws Error for matrices of another size.
  bool evaluate(const Configurations& q, Sequence sequence, Matrix d);
  /// With the entries of J: `values` is nonZeros() x N, in the structure of makeJacobian().
  bool evaluateValues(const Configurations& q, Sequence sequence, Matrix d, Matrix values);

 private:
  class Impl;
  bool compute(const Configurations& q, Sequence sequence, Matrix d, Matrix* values);
  std::unique_ptr<Impl> impl_;
};

/// The verdicts of a CollisionChecker on many configurations, in the same way.
class CheckerBatch {
 public:
  using Configurations = Eigen::Ref<const Eigen::MatrixXd>;            ///< one a column
  using Verdicts = Eigen::Ref<Eigen::Array<bool, Eigen::Dynamic, 1>>;  ///< one a configuration

  /// @throws Error unless `threads` is from 1 to 256.
  CheckerBatch(const CollisionChecker& checker, int threads);
  /// Takes over all that the other one has; the other one may only be destroyed.
  CheckerBatch(CheckerBatch&&) noexcept;
  ~CheckerBatch();

  /// Whether any pair is not known to be clear, as CollisionChecker::collides says.
  /// @throws Error for a matrix or a vector of another size.
  void collides(const Configurations& q, Sequence sequence, Verdicts hit);
  /// The least distance of all pairs (m), as CollisionChecker::minDistance says.
  void minDistance(const Configurations& q, Sequence sequence, Eigen::Ref<Eigen::VectorXd> least);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fcl_stpbv
