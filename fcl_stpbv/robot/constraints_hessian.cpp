// How rows change as q moves: dd/dt, the drift qd'Hqd and Hessian times vector. The pair's own Hessian gives
// the velocities of normal and witness points; the joints' twists change by Kinematics::differentiate
// (docs/robot.md, Second derivatives). Rows without a closed form use central differences.
#include <algorithm>
#include <limits>

#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/twist.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

}  // namespace

// Whether all numbers are finite and so small that products of two or three with lengths and curvatures stay
// finite.
bool CollisionConstraints::isUsable(const ConstVector& numbers) {
  return (numbers.array().abs() <= 1e100).all();
}

void CollisionConstraints::bodyVelocities(std::size_t row, Twist& first, Twist& second) const {
  first = rate_.link[at(geometry_->bodies[at(rows_[row].a)].link)];
  second = pairs_[row].obstacle ? Twist{} : rate_.link[at(geometry_->bodies[at(rows_[row].b)].link)];
}

// Fills moves_[row] for the velocities in rate_. @returns false if the row must use central differences.
bool CollisionConstraints::move(std::size_t row) {
  const Row& r = rows_[row];
  const Eigen::Isometry3d &pose1 = pose_[at(r.a)], &pose2 = pose_[at(r.b)];
  Twist first, second;
  bodyVelocities(row, first, second);
  BodyTwists twists;
  twists << velocityOf(pose1.translation(), first), first.angular, velocityOf(pose2.translation(), second),
      second.angular;
  return r.first ? rate(*r.first, pose1, *r.second, pose2, found_[row], twists, moves_[row])
                 : rate(*geometry_->bodies[at(r.a)].geometry, pose1, this->second(pairs_[row]), pose2,
                        answers_[row], twists, moves_[row]);
}

RowRates CollisionConstraints::makeRates() const {
  const Eigen::VectorXd zeros = Eigen::VectorXd::Zero(rows());
  return {zeros, zeros, zeros};
}

// The distance's speed is n.(u2 - u1), where u are the velocities of the body-fixed points at the witness
// points. The drift is the derivative of this product while q keeps its velocity qd.
bool CollisionConstraints::rateRow(std::size_t row, RowRates& rates, double* values) {
  const Eigen::Index i = static_cast<Eigen::Index>(row);
  const Witness witness = ask(row);
  double slope, curvature;
  rates.d[i] = levelled(row, witness.distance, slope, curvature);
  writeRow(row, witness, slope, values);
  rates.speed[i] = rates.drift[i] = 0;
  moves_[row] = {};
  if (witness.status == DistanceStatus::invalid) return true;
  Twist first, second;
  bodyVelocities(row, first, second);
  const Vector3d apart = velocityOf(witness.point[1], second) - velocityOf(witness.point[0], first);
  const double speed = witness.normal.dot(apart);
  rates.speed[i] = slope * speed;
  if (!move(row)) return false;
  const DistanceRate& moves = moves_[row];
  Vector3d change = second.angular.cross(moves.point[1]) - first.angular.cross(moves.point[0]) -
                    velocityOf(witness.point[0], rate_.drift[at(geometry_->bodies[at(rows_[row].a)].link)]);
  if (!pairs_[row].obstacle)
    change += velocityOf(witness.point[1], rate_.drift[at(geometry_->bodies[at(rows_[row].b)].link)]);
  rates.drift[i] = slope * (moves.normal.dot(apart) + witness.normal.dot(change)) + curvature * speed * speed;
  return true;
}

bool CollisionConstraints::evaluateValues(const ConstVector& q, const ConstVector& qd, RowRates& rates,
                                          Vector values) {
  requireSizes(q, qd, rates, values.size());
  if (!q.allFinite() || !isUsable(qd)) {
    nothingKnown(rates.d.data(), values.data());
    rates.speed.setZero();
    rates.drift.setZero();
    return false;
  }
  place(q);
  kinematics_->differentiate(q, qd, state_, rate_, placing_);
  moving_ = true;
  std::fill(open_.begin(), open_.end(), 1);
  for (std::size_t row = 0; row < pairs_.size(); ++row) open_[row] = !rateRow(row, rates, values.data());
  for (std::size_t row = pairs_.size(); row < open_.size(); ++row) {
    const Eigen::Index i = static_cast<Eigen::Index>(row);
    rates.d[i] = smoothValue(row, q, values.data());
    rates.speed[i] = rates.drift[i] = 0;
    open_[row] = rates.d[i] > std::numeric_limits<double>::lowest();
  }
  if (std::find(open_.begin(), open_.end(), 1) == open_.end()) return true;
  differences(q, qd);
  for (std::size_t row = 0; row < open_.size(); ++row) {
    if (!open_[row]) continue;
    double speed = 0, drift = 0;
    for (int k = rowStart_[row]; k < rowStart_[row + 1]; ++k) {
      speed += values[k] * qd[column_[at(k)]];
      drift += change_[k] * qd[column_[at(k)]];
    }
    rates.speed[static_cast<Eigen::Index>(row)] = speed;
    rates.drift[static_cast<Eigen::Index>(row)] = drift;
  }
  return true;
}

bool CollisionConstraints::evaluate(const ConstVector& q, const ConstVector& qd, RowRates& rates,
                                    SparseJacobian& jacobian) {
  requireStructure(jacobian);
  return evaluateValues(q, qd, rates, Eigen::Map<Eigen::VectorXd>(jacobian.valuePtr(), nonZeros()));
}

bool CollisionConstraints::evaluate(const ConstVector& q, const ConstVector& qd, RowRates& rates,
                                    Eigen::Ref<Eigen::MatrixXd> jacobian) {
  const bool known = evaluateValues(q, qd, rates, values_);
  spread(jacobian);
  return known;
}

// The row is slope (n.v + (x cross n).w) for each motion (v, w). Its change is the sum over what changes: the
// normal and the witness points by the pair's own second derivatives, the motions by the kinematics, the
// slope by the bend towards the influence distance.
bool CollisionConstraints::rowChange(std::size_t row, double* change) {
  std::fill(change + rowStart_[row], change + rowStart_[row + 1], 0.0);
  const Row& r = rows_[row];
  const Witness witness = ask(row);
  if (witness.status == DistanceStatus::invalid) return true;
  if (!move(row)) return false;
  Twist first, second;
  bodyVelocities(row, first, second);
  const Vector3d& n = witness.normal;
  const double speed = n.dot(velocityOf(witness.point[1], second) - velocityOf(witness.point[0], first));
  double slope, curvature;
  levelled(row, witness.distance, slope, curvature);
  Vector3d along[2], moment[2], alongChange[2], momentChange[2];
  for (std::size_t side = 0; side < 2; ++side) {
    const double sign = side == 0 ? -1 : 1;
    along[side] = sign * slope * n;
    moment[side] = witness.point[side].cross(along[side]);
    alongChange[side] = sign * (slope * moves_[row].normal + curvature * speed * n);
    momentChange[side] =
        moves_[row].point[side].cross(along[side]) + witness.point[side].cross(alongChange[side]);
  }
  for (int t = r.firstTerm; t < r.lastTerm; ++t) {
    const Term& term = terms_[at(t)];
    const Twist &motion = state_.motion[at(term.motion)], &motionChange = rate_.motion[at(term.motion)];
    change[term.slot] +=
        alongChange[term.side].dot(motion.linear) + momentChange[term.side].dot(motion.angular) +
        along[term.side].dot(motionChange.linear) + moment[term.side].dot(motionChange.angular);
  }
  return true;
}

// Fills the open rows' part of change_ and of moves_, along v, by central differences. Afterwards the rows'
// answers are those at q again. Where a smooth constraint ends, so that it has no value on one side of q, its
// change is not known.
void CollisionConstraints::differences(const ConstVector& q, const ConstVector& v) {
  constexpr char kEnds = 2;  // in place of the 1 of an open row
  // With this step the rounding of J divided by the step is about as large as the error at a region boundary.
  constexpr double kStep = 1e-6;
  const double length = v.norm();
  const double step = length > 0 ? kStep / length : 0;
  const auto rowsAt = [&](double far, Eigen::VectorXd& values) {
    moved_ = q + far * v;
    place(moved_);
    for (std::size_t row = 0; row < open_.size(); ++row) {
      if (!open_[row]) continue;
      if (row >= pairs_.size()) {
        if (smoothValue(row, moved_, values.data()) == std::numeric_limits<double>::lowest())
          open_[row] = kEnds;
        continue;
      }
      const Witness witness = ask(row);
      double slope, curvature;
      levelled(row, witness.distance, slope, curvature);
      writeRow(row, witness, slope, values.data());
      if (witness.status == DistanceStatus::invalid) continue;
      const double factor = far < 0 ? -0.5 / step : far > 0 ? 0.5 / step : 0;
      moves_[row].normal += factor * witness.normal;
      for (std::size_t side = 0; side < 2; ++side) moves_[row].point[side] += factor * witness.point[side];
    }
  };
  for (std::size_t row = 0; row < pairs_.size(); ++row)
    if (open_[row]) moves_[row] = {};
  rowsAt(-step, otherChange_);
  rowsAt(step, change_);
  for (std::size_t row = 0; row < open_.size(); ++row) {
    if (!open_[row]) continue;
    for (int k = rowStart_[row]; k < rowStart_[row + 1]; ++k)
      change_[k] = step > 0 && open_[row] != kEnds ? (change_[k] - otherChange_[k]) / (2 * step) : 0;
    open_[row] = 1;
  }
  place(q);
  for (std::size_t row = 0; row < pairs_.size(); ++row)
    if (open_[row]) ask(row);
}

bool CollisionConstraints::hessianVector(const ConstVector& q, const ConstVector& weights,
                                         const ConstVector& v, Vector out) {
  requireSizes(q, rows(), nonZeros());
  requireSize("CollisionConstraints", "weights", weights.size(), rows());
  requireSize("CollisionConstraints", "v", v.size(), columns());
  requireSize("CollisionConstraints", "the result", out.size(), columns());
  out.setZero();
  if (!q.allFinite() || !isUsable(weights) || !isUsable(v)) return false;
  place(q);
  kinematics_->differentiate(q, v, state_, rate_, placing_);
  moving_ = false;  // v is a direction, and so are the velocities in rate_
  std::fill(open_.begin(), open_.end(), 1);
  for (std::size_t row = 0; row < pairs_.size(); ++row) open_[row] = !rowChange(row, change_.data());
  if (std::find(open_.begin(), open_.end(), 1) != open_.end()) differences(q, v);
  for (int row = 0; row < rows(); ++row)
    for (int k = rowStart_[at(row)]; weights[row] != 0 && k < rowStart_[at(row) + 1]; ++k)
      out[column_[at(k)]] += weights[row] * change_[k];
  return true;
}

}  // namespace fcl_stpbv
