// Rows A x >= b for a controller from CollisionConstraints: Faverjon and Tournassoud's damper (1987) for
// velocities and accelerations, a second-order control barrier, and the bounds of docs/control.md.
#include "fcl_stpbv/robot/velocity_damper.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

// Beyond these in m, m/s, s and 1/s is a mistake; a gain or a period is never 0.
constexpr double kLeast = 1e-9, kLargest = 1e9;

void check(const Damper& damper) {
  requireNumber("VelocityDamper: security", damper.security, -kLargest, kLargest);
  requireNumber("VelocityDamper: influence", damper.influence, damper.security, kLargest);
  requireNumber("VelocityDamper: damping", damper.damping, kLeast, kLargest);
  if (damper.influence == damper.security)
    throw Error("VelocityDamper: influence must be larger than security");
}

}  // namespace

VelocityDamper::VelocityDamper(CollisionConstraints& constraints, DamperOptions options)
    : constraints_(constraints),
      options_(std::move(options)),
      dampers_(at(constraints.rows()), options_.all),
      jacobian_(constraints.makeJacobian()),
      rates_(constraints.makeRates()),
      b_(Eigen::VectorXd::Zero(constraints.rows())),
      damping_(at(constraints.rows())),
      inside_(at(constraints.rows()), 0) {
  check(options_.all);
  requireNumber("VelocityDamper: headroom", options_.headroom, -kLargest, kLargest);
  requireNumber("VelocityDamper: period", options_.period, kLeast, kLargest);
  requireNumber("VelocityDamper: barrierGain", options_.barrierGain, kLeast, kLargest);
  for (const auto& [row, damper] : options_.rows) {
    if (row < 0 || row >= constraints.rows())
      throw Error("VelocityDamper: there is no row " + std::to_string(row));
    check(damper);
    dampers_[at(row)] = damper;
  }
  for (int row = 0; row < constraints.rows(); ++row)
    if (dampers_[at(row)].influence > constraints.largestValue(row))
      throw Error("VelocityDamper: influence " + std::to_string(dampers_[at(row)].influence) + " m of row " +
                  std::to_string(row) + " is beyond the most that its value can be, " +
                  std::to_string(constraints.largestValue(row)) +
                  " m; give the constraints a larger influence or hand-over");
  near_.reserve(at(constraints.rows()));
}

// At the damper's own edge the row then says dd/dt >= -xi, below what the pair does.
void VelocityDamper::enter(int row) {
  const Damper& damper = dampers_[at(row)];
  double& damping = damping_[at(row)];
  damping = damper.damping;
  const double room = rates_.d[row] - damper.security;
  if (options_.headroom < 0 || !(room > 0)) return;
  damping = std::max(damping,
                     (options_.headroom - rates_.speed[row]) * (damper.influence - damper.security) / room);
}

double VelocityDamper::bound(int row) const {
  const Damper& damper = dampers_[at(row)];
  const double room = rates_.d[row] - damper.security, speed = rates_.speed[row];
  const double rate = damping_[at(row)] / (damper.influence - damper.security);
  const double allowed = -rate * room;
  if (options_.level == DamperLevel::velocity) return allowed;
  const double drift = rates_.drift[row];
  if (options_.level == DamperLevel::acceleration) return (allowed - speed) / options_.period - drift;
  return -drift - (rate + options_.barrierGain) * speed - rate * options_.barrierGain * room;
}

void VelocityDamper::update(const Eigen::Ref<const Eigen::VectorXd>& q,
                            const Eigen::Ref<const Eigen::VectorXd>& qd) {
  bool known;
  if (options_.level == DamperLevel::velocity) {
    known = constraints_.evaluate(q, rates_.d, jacobian_);
    rates_.speed.noalias() = jacobian_ * qd;
  } else {
    known = constraints_.evaluate(q, qd, rates_, jacobian_);
  }
  near_.clear();
  if (!known) {  // no row can be met, and none has entered
    b_.setConstant(std::numeric_limits<double>::infinity());
    for (int row = 0; row < constraints_.rows(); ++row) near_.push_back(row);
    return;
  }
  for (int row = 0; row < constraints_.rows(); ++row) {
    const bool inside = rates_.d[row] < dampers_[at(row)].influence;
    if (inside && !inside_[at(row)]) enter(row);
    inside_[at(row)] = inside;
    b_[row] = inside ? bound(row) : -std::numeric_limits<double>::infinity();
    if (inside) near_.push_back(row);
  }
}

int VelocityDamper::dense(Eigen::Ref<Eigen::MatrixXd> A, Eigen::Ref<Eigen::VectorXd> b) const {
  int count = 0;
  for (int row : near_) {
    A.row(count).setZero();
    for (CollisionConstraints::SparseJacobian::InnerIterator it(jacobian_, row); it; ++it)
      A(count, it.col()) = it.value();
    b[count++] = b_[row];
  }
  return count;
}

// Of x = x0 + H^-1 A' l, A x = b while the rows stay the same: their part of dx/dt is the projection of H^-1
// (dA/dt)' l and H^-1 A' G^-1 (db/dt - dA/dt x), G = A H^-1 A'.
double collisionAccelerationBound(const ProgramChange& change, double smallestH, double smallestG) {
  return change.gradient * change.multiplier / std::sqrt(smallestH) +
         (change.bound + change.gradient * change.solution) / std::sqrt(smallestG);
}

}  // namespace fcl_stpbv
