// A smooth program in the form that IPOPT needs.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::benchmark {

/// min cost(x), 0 <= rows(x) <= most, lower <= x <= upper.
class SmoothProgram {
 public:
  using Vector = Eigen::VectorXd;
  /// Row and column of an entry of the rows' Jacobian, or of the lower triangle of a Lagrangian's Hessian. In
  /// the latter a place may occur twice; then the entries are added.
  struct Place {
    int row, column;
  };

  virtual ~SmoothProgram() = default;
  virtual const Vector& lower() const = 0;
  virtual const Vector& upper() const = 0;
  /// One entry for each row: 0 if the row must be 0, infinity if it must not be negative.
  virtual Vector most() const = 0;
  virtual double cost(const Vector& x) = 0;
  virtual Vector costGradient(const Vector& x) = 0;
  /// The rows at x, and the entries of their Jacobian in the order of jacobianPlaces().
  virtual const Vector& values(const Vector& x) = 0;
  virtual const Vector& jacobian(const Vector& x) = 0;
  /// The Hessian of scale * cost + weights . rows. Without `curvature` the rows count as flat (Gauss-Newton).
  virtual void hessian(const Vector& x, double scale, const Vector& weights, bool curvature,
                       Vector& entries) = 0;

  const std::vector<Place>& jacobianPlaces() const { return jacobianPlaces_; }
  const std::vector<Place>& hessianPlaces() const { return hessianPlaces_; }

  long points = 0;    ///< number of different x for which rows were computed
  long hessians = 0;  ///< number of second derivatives computed

 protected:
  std::vector<Place> jacobianPlaces_, hessianPlaces_;
};

}  // namespace fcl_stpbv::benchmark
