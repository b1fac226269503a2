// The problem of the IPOPT example, as IPOPT asks for it: the allowed posture that is closest to a desired
// one.
#pragma once

#include <IpTNLP.hpp>
#include <algorithm>

#include "fcl_stpbv/robot/constraints.h"

/// min |q - wanted|^2 / 2, d(q) >= 0, joints within their limits.
class ClosestPosture : public Ipopt::TNLP {
  using VectorXd = Eigen::VectorXd;
  using In = Eigen::Map<const VectorXd>;
  using Out = Eigen::Map<VectorXd>;
  using Rows = fcl_stpbv::CollisionConstraints;

 public:
  ClosestPosture(Rows& rows, const fcl_stpbv::Kinematics& kinematics, const VectorXd& wanted, VectorXd& q)
      : rows_(rows), kinematics_(kinematics), wanted_(wanted), q_(q), hessian_(rows.makeHessian()) {}

  bool get_nlp_info(int& n, int& m, int& jacobian, int& hessian, IndexStyleEnum& style) override {
    n = rows_.columns();
    m = rows_.rows();
    jacobian = rows_.nonZeros();
    // The cost's diagonal; IPOPT adds entries at the same place.
    hessian = static_cast<int>(hessian_.nonZeros()) + n;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(int n, double* low, double* high, int m, double* least, double* most) override {
    Out(low, n) = kinematics_.lower();
    Out(high, n) = kinematics_.upper();
    std::fill(least, least + m, 0.0);
    std::fill(most, most + m, 1e20);
    return true;
  }
  bool get_starting_point(int n, bool, double* q, bool, double*, double*, int, bool, double*) override {
    Out(q, n) = q_;
    return true;
  }
  bool eval_f(int n, const double* q, bool, double& cost) override {
    cost = (In(q, n) - wanted_).squaredNorm() / 2;
    return true;
  }
  bool eval_grad_f(int n, const double* q, bool, double* gradient) override {
    Out(gradient, n) = In(q, n) - wanted_;
    return true;
  }
  bool eval_g(int n, const double* q, bool, int m, double* d) override {
    return rows_.evaluate(In(q, n), Out(d, m));
  }
  bool eval_jac_g(int n, const double* q, bool, int m, int count, int* row, int* column,
                  double* values) override {
    if (values) {
      VectorXd d(m);
      return rows_.evaluateValues(In(q, n), d, Out(values, count));
    }
    for (int i = 0; i < m; ++i)
      std::fill(row + rows_.rowStart()[static_cast<std::size_t>(i)],
                row + rows_.rowStart()[static_cast<std::size_t>(i) + 1], i);
    std::copy(rows_.columnIndices().begin(), rows_.columnIndices().end(), column);
    return true;
  }
  bool eval_h(int n, const double* q, bool, double scale, int m, const double* weights, bool, int, int* row,
              int* column, double* values) override {
    const Eigen::Index rowsPart = hessian_.nonZeros();
    if (!values) {
      for (int j = 0; j < n; ++j)
        for (Rows::SparseHessian::InnerIterator it(hessian_, j); it; ++it) {
          *row++ = static_cast<int>(it.row());
          *column++ = j;
        }
      for (int j = 0; j < n; ++j) row[j] = column[j] = j;
      return true;
    }
    const bool known = rows_.hessian(In(q, n), In(weights, m), hessian_);
    Out(values, rowsPart) = In(hessian_.valuePtr(), rowsPart);
    Out(values + rowsPart, n).setConstant(scale);
    return known;
  }
  void finalize_solution(Ipopt::SolverReturn, int n, const double* q, const double*, const double*, int,
                         const double*, const double*, double, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    q_ = In(q, n);
  }

 private:
  Rows& rows_;
  const fcl_stpbv::Kinematics& kinematics_;
  const VectorXd& wanted_;
  VectorXd& q_;
  Rows::SparseHessian hessian_;
};
