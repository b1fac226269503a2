// Rows and their Jacobian come from CollisionConstraints at each knot. So do second derivatives, except for
// hulls: there they are central differences of the gradient, or differences on one side if the gradient jumps
// on the other.
#include "tools/bench/optimise/nlp.h"

namespace fcl_stpbv::benchmark {

using Eigen::VectorXd;

Nlp::Nlp(const Task& task, const Method& method) : task_(task), method_(method) {
  for (int knot = 0; knot < task.knots; ++knot) constraints_.push_back(constraintsOf(task.scene, method));
  const CollisionConstraints& one = *constraints_[0];
  ofDistances_ = one.makeHessian();
  for (int j = 0; j < variables(); ++j)
    for (int i = j; i < variables(); ++i)
      if (task_.Q(i, j) != 0) costPlaces_.push_back({i, j});
  hessianPlaces_ = costPlaces_;
  for (int knot = 0; knot < task.knots; ++knot) {
    const int first = knot * one.columns();
    for (int row = 0; row < one.rows(); ++row) {
      for (int k = one.rowStart()[static_cast<std::size_t>(row)];
           k < one.rowStart()[static_cast<std::size_t>(row) + 1]; ++k)
        jacobianPlaces_.push_back(
            {knot * one.rows() + row, first + one.columnIndices()[static_cast<std::size_t>(k)]});
    }
    for (int column = 0; column < ofDistances_.outerSize(); ++column)
      for (CollisionConstraints::SparseHessian::InnerIterator it(ofDistances_, column); it; ++it)
        hessianPlaces_.push_back({first + static_cast<int>(it.row()), first + column});
  }
  if (task.clearance)
    for (int row = 0; row < rows(); ++row) jacobianPlaces_.push_back({row, variables() - 1});
  values_.resize(rows());
  // The derivative of d - clearance by the clearance.
  entries_.setConstant(static_cast<Eigen::Index>(jacobianPlaces_.size()), -1);
}

void Nlp::evaluate(const VectorXd& x) {
  if (x_.size() == x.size() && x_ == x) return;
  ++points;
  x_ = x;
  for (std::size_t knot = 0; knot < constraints_.size(); ++knot) {
    CollisionConstraints& c = *constraints_[knot];
    const Eigen::Index k = static_cast<Eigen::Index>(knot);
    c.evaluateValues(x.segment(k * c.columns(), c.columns()), values_.segment(k * c.rows(), c.rows()),
                     entries_.segment(k * c.nonZeros(), c.nonZeros()));
  }
  values_.array() -= margins(method_) + (task_.clearance ? x[x.size() - 1] : 0);
}

const VectorXd& Nlp::values(const VectorXd& x) {
  evaluate(x);
  return values_;
}

const VectorXd& Nlp::jacobian(const VectorXd& x) {
  evaluate(x);
  return entries_;
}

void Nlp::hessian(const VectorXd& x, double scale, const VectorXd& weights, bool curvature,
                  VectorXd& entries) {
  ++hessians;
  entries.setZero(static_cast<Eigen::Index>(hessianPlaces_.size()));
  Eigen::Index to = 0;
  for (const Place& p : costPlaces_) entries[to++] = scale * task_.Q(p.row, p.column);
  if (!curvature) return;
  for (std::size_t knot = 0; knot < constraints_.size(); ++knot) {
    CollisionConstraints& c = *constraints_[knot];
    const Eigen::Index k = static_cast<Eigen::Index>(knot);
    const VectorXd q = x.segment(k * c.columns(), c.columns()), w = weights.segment(k * c.rows(), c.rows());
    if (method_.model == Model::hull)
      ofHulls(knot, q, w, ofDistances_);
    else
      c.hessian(q, w, ofDistances_);
    entries.segment(to, ofDistances_.nonZeros()) =
        Eigen::Map<const VectorXd>(ofDistances_.valuePtr(), ofDistances_.nonZeros());
    to += ofDistances_.nonZeros();
  }
}

// Two polyhedra have no closed form here. If the gradient jumps on one side, the difference on the other side
// is used: it is the second derivative of the present features, not the jump divided by the step.
void Nlp::ofHulls(std::size_t knot, const VectorXd& q, const VectorXd& weights,
                  CollisionConstraints::SparseHessian& lower) {
  constexpr double kStep = 1e-6;  // m, rad: an error of 1e-10 in the gradient becomes 1e-4
  // Change of the gradient over a step; a smooth gradient changes by at most 1e-4.
  constexpr double kJump = 1e-3;
  CollisionConstraints& c = *constraints_[knot];
  VectorXd d(c.rows());
  Eigen::MatrixXd here(c.rows(), c.columns()), after(here), before(here);
  c.evaluate(q, d, here);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(c.columns(), c.columns());
  for (int j = 0; j < c.columns(); ++j) {
    VectorXd moved = q;
    moved[j] = q[j] + kStep;
    c.evaluate(moved, d, after);
    moved[j] = q[j] - kStep;
    c.evaluate(moved, d, before);
    for (int row = 0; row < c.rows(); ++row) {
      const VectorXd up = after.row(row) - here.row(row), down = here.row(row) - before.row(row);
      const bool upGood = up.norm() < kJump, downGood = down.norm() < kJump;
      if (upGood || downGood)
        sum.col(j) += weights[row] *
                      (upGood && downGood ? VectorXd((up + down) / 2)
                       : upGood           ? up
                                          : down) /
                      kStep;
    }
  }
  for (int j = 0; j < lower.outerSize(); ++j)
    for (CollisionConstraints::SparseHessian::InnerIterator it(lower, j); it; ++it)
      it.valueRef() = (sum(it.row(), j) + sum(j, it.row())) / 2;
}

}  // namespace fcl_stpbv::benchmark
