// A task with the distances of one model of its bodies, with exact derivatives, in the form that optimisers
// need.
#pragma once

#include <memory>
#include <vector>

#include "tools/bench/optimise/task.h"

namespace fcl_stpbv::benchmark {

/// min cost(x), rows(x) >= 0, lower <= x <= upper.
class Nlp {
 public:
  Nlp(const Task& task, const Method& method);

  const Task& task() const { return task_; }
  int variables() const { return static_cast<int>(task_.c.size()); }
  int rows() const { return task_.knots * constraints_[0]->rows(); }
  /// Row and column of each entry of the rows' Jacobian, or of the lower triangle of a Lagrangian's Hessian.
  /// In the latter a place may occur twice; then the entries are added.
  struct Place {
    int row, column;
  };
  const std::vector<Place>& jacobianPlaces() const { return jacobianPlaces_; }
  const std::vector<Place>& hessianPlaces() const { return hessianPlaces_; }

  /// The rows at x, and the entries of their Jacobian; kept until the next x.
  const Eigen::VectorXd& values(const Eigen::VectorXd& x);
  const Eigen::VectorXd& jacobian(const Eigen::VectorXd& x);
  /// The Hessian of scale * cost + weights . rows. Without `curvature` the rows count as flat (Gauss-Newton).
  void hessian(const Eigen::VectorXd& x, double scale, const Eigen::VectorXd& weights, bool curvature,
               Eigen::VectorXd& entries);
  double violation(const Eigen::VectorXd& x) { return std::max(0.0, -values(x).minCoeff()); }

  long points = 0;    ///< number of different x for which rows were computed
  long hessians = 0;  ///< number of second derivatives computed

 private:
  void evaluate(const Eigen::VectorXd& x);
  void ofHulls(std::size_t knot, const Eigen::VectorXd& q, const Eigen::VectorXd& weights,
               CollisionConstraints::SparseHessian& lower);

  Task task_;
  Method method_;
  std::vector<std::unique_ptr<CollisionConstraints>> constraints_;  // one for each knot
  std::vector<Place> jacobianPlaces_, hessianPlaces_, costPlaces_;
  CollisionConstraints::SparseHessian lower_;
  Eigen::VectorXd x_, values_, entries_;
};

}  // namespace fcl_stpbv::benchmark
