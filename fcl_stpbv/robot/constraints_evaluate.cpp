// Distances and Jacobian of all rows at q: checks sizes, computes the links' poses, and evaluates each row.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv {
namespace {

using detail::at;
using detail::requireSize;

const char* const kOwner = "CollisionConstraints";

}  // namespace

void CollisionConstraints::requireRow(int row) const { detail::requireRow(kOwner, row, rows()); }

void CollisionConstraints::requireSizes(const ConstVector& q, Eigen::Index d, Eigen::Index values) const {
  requireSize(kOwner, "q", q.size(), columns());
  requireSize(kOwner, "d", d, rows());
  requireSize(kOwner, "the Jacobian", values, nonZeros());
}

void CollisionConstraints::requireSizes(const ConstVector& q, const ConstVector& qd, const RowRates& rates,
                                        Eigen::Index values) const {
  requireSizes(q, rates.d.size(), values);
  requireSize(kOwner, "qd", qd.size(), columns());
  requireSize(kOwner, "speed", rates.speed.size(), rows());
  requireSize(kOwner, "drift", rates.drift.size(), rows());
}

// Checks only sizes and counts. To compare all indices would take too long at every configuration.
void CollisionConstraints::requireStructure(const SparseJacobian& jacobian) const {
  if (jacobian.rows() != rows() || jacobian.cols() != columns() || jacobian.nonZeros() != nonZeros() ||
      !jacobian.isCompressed())
    throw Error("CollisionConstraints: the Jacobian needs the structure that makeJacobian() gives it");
}

void CollisionConstraints::nothingKnown(double* d, double* values) {
  std::fill(d, d + rows(), std::numeric_limits<double>::lowest());
  if (values) std::fill(values, values + nonZeros(), 0.0);
  for (Distance& found : found_) found = Distance{};
  for (DistanceAnswer& answer : answers_) answer = DistanceAnswer{};
  moving_ = false;
}

bool CollisionConstraints::compute(const ConstVector& q, double* d, double* values) {
  const bool known = computePairs(q, d, values);
  if (known) computeSmooth(q, d, values);
  return known;
}

bool CollisionConstraints::computePairs(const ConstVector& q, double* d, double* values) {
  if (!q.allFinite()) {
    nothingKnown(d, values);
    return false;
  }
  place(q);
  moving_ = false;
  for (std::size_t row = 0; row < pairs_.size(); ++row) d[row] = pairRow(row, values);
  return true;
}

void CollisionConstraints::computeSmooth(const ConstVector& q, double* d, double* values) const {
  for (std::size_t row = pairs_.size(); row + 1 < rowStart_.size(); ++row)
    d[row] = smoothValue(row, q, values);
}

// NaN would pass a comparison with a margin.
double CollisionConstraints::smoothValue(std::size_t row, const ConstVector& q, double* values) const {
  const double value =
      options_.smooth[row - pairs_.size()].value(q, values ? values + rowStart_[row] : nullptr);
  if (!std::isnan(value)) return value;
  if (values) std::fill(values + rowStart_[row], values + rowStart_[row + 1], 0.0);
  return std::numeric_limits<double>::lowest();
}

void CollisionConstraints::spread(Eigen::Ref<Eigen::MatrixXd> jacobian) const {
  if (jacobian.rows() != rows() || jacobian.cols() != columns())
    throw Error(
        "CollisionConstraints: the Jacobian needs a row for each row and a column for each coordinate");
  jacobian.setZero();
  for (int row = 0; row < rows(); ++row)
    for (int k = rowStart_[at(row)]; k < rowStart_[at(row) + 1]; ++k)
      jacobian(row, column_[at(k)]) = values_[k];
}

bool CollisionConstraints::evaluate(const ConstVector& q, Vector d) {
  requireSizes(q, d.size(), nonZeros());
  return compute(q, d.data(), nullptr);
}

bool CollisionConstraints::evaluateValues(const ConstVector& q, Vector d, Vector values) {
  requireSizes(q, d.size(), values.size());
  return compute(q, d.data(), values.data());
}

bool CollisionConstraints::evaluate(const ConstVector& q, Vector d, SparseJacobian& jacobian) {
  requireSizes(q, d.size(), jacobian.nonZeros());
  requireStructure(jacobian);
  return compute(q, d.data(), jacobian.valuePtr());
}

bool CollisionConstraints::evaluate(const ConstVector& q, Vector d, Eigen::Ref<Eigen::MatrixXd> jacobian) {
  requireSizes(q, d.size(), nonZeros());
  const bool known = compute(q, d.data(), values_.data());
  spread(jacobian);
  return known;
}

}  // namespace fcl_stpbv
