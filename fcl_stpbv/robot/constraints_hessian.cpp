// Second derivatives of the rows of CollisionConstraints along a vector; see constraints.h.
#include <algorithm>

#include "fcl_stpbv/adapter/fcl_hessian.h"
#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv {
namespace {

using Eigen::Vector3d;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// A body's velocity as DistanceHessian takes it: of the body's origin, and the angular one.
Eigen::Matrix<double, 6, 1> about(const Vector3d& origin, const Twist& velocity) {
  Eigen::Matrix<double, 6, 1> twist;
  twist << velocity.linear + velocity.angular.cross(origin), velocity.angular;
  return twist;
}

}  // namespace

// The row is slope (n.v + (x cross n).w) for each motion (v, w). Its change is the sum over what changes: the
// normal and the witness points by the pair's own second derivatives, the motions by the kinematics, the
// slope by the bend towards the influence distance.
bool CollisionConstraints::rowChange(std::size_t row, double* change) {
  std::fill(change + rowStart_[row], change + rowStart_[row + 1], 0.0);
  const Row& r = rows_[row];
  const Witness witness = ask(row);
  if (witness.status == DistanceStatus::invalid) return true;
  DistanceHessian second;
  const Eigen::Isometry3d &pose1 = pose_[at(r.a)], &pose2 = pose_[at(r.b)];
  const bool known = r.first ? hessian(*r.first, pose1, *r.second, pose2, found_[row], second)
                             : hessian(*geometry_->bodies[at(r.a)].geometry, pose1, this->second(pairs_[row]),
                                       pose2, answers_[row], second);
  if (!known) return false;
  Eigen::Matrix<double, 12, 1> twists;
  const Twist none;
  const Twist& velocity1 = rate_.link[at(geometry_->bodies[at(r.a)].link)];
  const Twist& velocity2 = pairs_[row].obstacle ? none : rate_.link[at(geometry_->bodies[at(r.b)].link)];
  twists << about(pose1.translation(), velocity1), about(pose2.translation(), velocity2);

  const Vector3d& n = witness.normal;
  const Vector3d turn = second.normal * twists;
  const double speed = n.dot(velocity2.linear - velocity1.linear + velocity2.angular.cross(witness.point[1]) -
                             velocity1.angular.cross(witness.point[0]));
  double slope, curvature;
  bend(witness.distance, slope, curvature);
  for (int side = 0; side < 2; ++side) {
    const Vector3d& x = witness.point[at(side)];
    const Vector3d slide = second.point[at(side)] * twists;
    const double sign = side == 0 ? -1 : 1;
    const Vector3d along = sign * slope * n, moment = x.cross(along);
    const Vector3d alongChange = sign * (slope * turn + curvature * speed * n);
    const Vector3d momentChange = slide.cross(along) + x.cross(alongChange);
    for (int t = r.firstTerm; t < r.lastTerm; ++t) {
      const Term& term = terms_[at(t)];
      if (term.side != side) continue;
      const Twist& motion = state_.motion[at(term.motion)];
      const Twist& motionChange = rate_.motion[at(term.motion)];
      change[term.slot] += alongChange.dot(motion.linear) + momentChange.dot(motion.angular) +
                           along.dot(motionChange.linear) + moment.dot(motionChange.angular);
    }
  }
  return true;
}

// Fills the open rows' change along v.
void CollisionConstraints::differences(const ConstVector& q, const ConstVector& v) {
  // Rounding in J divided by the step and what the step misses of a seam are then about equal.
  constexpr double kStep = 1e-6;
  const double length = v.norm();
  const double step = length > 0 ? kStep / length : 0;
  const auto rowsAt = [&](double far, Eigen::VectorXd& values) {
    moved_ = q + far * v;
    place(moved_);
    for (std::size_t row = 0; row < open_.size(); ++row) {
      if (!open_[row]) continue;
      if (row < pairs_.size())
        pairRow(row, values.data());
      else
        options_.smooth[row - pairs_.size()].value(moved_, values.data() + rowStart_[row]);
    }
  };
  rowsAt(-step, otherValues_);
  rowsAt(step, values_);
  for (std::size_t row = 0; row < open_.size(); ++row) {
    if (!open_[row]) continue;
    for (int k = rowStart_[row]; k < rowStart_[row + 1]; ++k)
      values_[k] = step > 0 ? (values_[k] - otherValues_[k]) / (2 * step) : 0;
  }
}

void CollisionConstraints::hessianVector(const ConstVector& q, const ConstVector& weights,
                                         const ConstVector& v, Vector out) {
  place(q);
  kinematics_->differentiate(q, v, state_, rate_);
  std::fill(open_.begin(), open_.end(), 1);
  auto work = [&](int k) {
    const std::size_t step = at(pool_->threads());
    for (std::size_t row = at(k); row < pairs_.size(); row += step)
      open_[row] = !rowChange(row, values_.data());
  };
  pool_->run(work);
  if (std::find(open_.begin(), open_.end(), 1) != open_.end()) differences(q, v);
  out.setZero();
  for (int row = 0; row < rows(); ++row)
    for (int k = rowStart_[at(row)]; k < rowStart_[at(row) + 1]; ++k)
      out[column_[at(k)]] += weights[row] * values_[k];
}

}  // namespace fcl_stpbv
