// A task with the distances of one model of its bodies, with exact derivatives, in the form that optimisers
// need.
#pragma once

#include <memory>
#include <vector>

#include "fcl_stpbv/numbers.h"
#include "tools/bench/optimise/program.h"
#include "tools/bench/optimise/task.h"

namespace fcl_stpbv::benchmark {

/// min cost(x), rows(x) >= 0, lower <= x <= upper.
class Nlp : public SmoothProgram {
 public:
  Nlp(const Task& task, const Method& method);

  const Task& task() const { return task_; }
  int variables() const { return static_cast<int>(task_.c.size()); }
  int rows() const { return task_.knots * constraints_[0]->rows(); }
  const Vector& lower() const override { return task_.lower; }
  const Vector& upper() const override { return task_.upper; }
  Vector most() const override { return Vector::Constant(rows(), detail::kInfinity); }
  double cost(const Vector& x) override { return task_.cost(x); }
  Vector costGradient(const Vector& x) override { return task_.Q * x + task_.c; }
  const Vector& values(const Vector& x) override;
  const Vector& jacobian(const Vector& x) override;
  void hessian(const Vector& x, double scale, const Vector& weights, bool curvature,
               Vector& entries) override;
  double violation(const Vector& x) { return std::max(0.0, -values(x).minCoeff()); }

 private:
  void evaluate(const Eigen::VectorXd& x);
  void ofHulls(std::size_t knot, const Eigen::VectorXd& q, const Eigen::VectorXd& weights,
               CollisionConstraints::SparseHessian& lower);

  Task task_;
  Method method_;
  std::vector<std::unique_ptr<CollisionConstraints>> constraints_;  // one for each knot
  std::vector<Place> costPlaces_;
  CollisionConstraints::SparseHessian ofDistances_;
  Eigen::VectorXd x_, values_, entries_;
};

}  // namespace fcl_stpbv::benchmark
