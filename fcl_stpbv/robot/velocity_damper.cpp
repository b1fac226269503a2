// Rows A x >= b for a controller from CollisionConstraints: Faverjon and Tournassoud's damper (1987) for
// velocities and accelerations, a second-order control barrier, and the bounds of docs/control.md.
#include "fcl_stpbv/robot/velocity_damper.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

// Values outside this range (m, m/s, s, 1/s) are taken for mistakes. A gain or a period is never 0.
constexpr double kLeast = 1e-9, kLargest = 1e9;

// Largest gain times period of a row (docs/control.md). With sampled velocities, a value of 1 reaches the
// security distance in one period. With sampled accelerations, integrated as v += p u, d += p v or exactly, a
// pair approaches the security distance without passing it if all roots of the closed loop are real and not
// negative. That is true for one gain with a value of up to 0.34, and for two gains whose values add up to at
// most 1. Each of the two is raised to at most 1/3. A larger one that is given is lowered where the other one
// needs its place.
constexpr double kMostGain = 1, kMostGainOfAccelerations = 1.0 / 3, kMostSum = 1;

// With sampled accelerations, gains of 1/3 keep a pair from its security distance if its speed times the
// period is at most this part of its room. A faster pair is braked more as it enters.
constexpr double kSlow = 2.0 / 3;

double mostGain(DamperLevel level, double period) {
  return (level == DamperLevel::velocity ? kMostGain : kMostGainOfAccelerations) / period;
}

// Two gains whose sum is too large: the larger one is lowered, down to the smaller one; then both.
void limitSum(double& a, double& g, double most) {
  double &smaller = a < g ? a : g, &larger = a < g ? g : a;
  if (smaller + larger <= most) return;
  smaller = std::min(smaller, most / 2);
  larger = most - smaller;
}

// `of` is "" or names the row.
void check(const Damper& damper, const std::string& of = "") {
  requireNumber("VelocityDamper: security" + of, damper.security, -kLargest, kLargest);
  requireNumber("VelocityDamper: influence" + of, damper.influence, damper.security, kLargest);
  requireNumber("VelocityDamper: damping" + of, damper.damping, kLeast, kLargest);
  if (damper.influence == damper.security)
    throw Error("VelocityDamper: influence" + of + " must be larger than security");
}

// Beyond `exact` the row's value goes over to a constant and its gradient to 0, so it could not stop the
// pair. An influence that was written in decimals may exceed `exact` by rounding.
void fitInfluence(double& influence, int row, double exact) {
  if (influence > exact * (1 + 4 * std::numeric_limits<double>::epsilon()))
    throw Error(
        formatted("VelocityDamper: influence %.9g m of row %d is beyond %.9g m, up to where its value is the "
                  "distance; give the constraints a larger influence, exactUpTo or hand-over",
                  influence, row, exact));
  influence = std::min(influence, exact);
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
      gain_(at(constraints.rows())),
      inside_(at(constraints.rows()), 0) {
  check(options_.all);
  requireNumber("VelocityDamper: headroom", options_.headroom, -kLargest, kLargest);
  requireNumber("VelocityDamper: period", options_.period, kLeast, kLargest);
  requireNumber("VelocityDamper: barrierGain", options_.barrierGain, kLeast, kLargest);
  for (const auto& [row, damper] : options_.rows) {
    requireRow(row);
    dampers_[at(row)] = damper;
  }
  for (int row = 0; row < constraints.rows(); ++row) {
    fitInfluence(dampers_[at(row)].influence, row, constraints.exactUpTo(row));
    check(dampers_[at(row)], " of row " + std::to_string(row));
    rest(row);
  }
  near_.reserve(at(constraints.rows()));
}

void VelocityDamper::requireRow(int row) const {
  detail::requireRow("VelocityDamper", row, constraints_.rows());
}

double VelocityDamper::damping(int row) const {
  requireRow(row);
  return damping_[at(row)];
}

double VelocityDamper::barrierGain(int row) const {
  requireRow(row);
  return gain_[at(row)];
}

double VelocityDamper::rate(int row) const {
  return damping_[at(row)] / (dampers_[at(row)].influence - dampers_[at(row)].security);
}

void VelocityDamper::rest(int row) {
  const double reach = dampers_[at(row)].influence - dampers_[at(row)].security;
  damping_[at(row)] = dampers_[at(row)].damping;
  gain_[at(row)] = options_.barrierGain;
  const double own = rate(row);
  double a = own;
  if (options_.level == DamperLevel::barrier)
    limitSum(a, gain_[at(row)], kMostSum / options_.period);
  else
    a = std::min(a, mostGain(options_.level, options_.period));
  if (a < own) damping_[at(row)] = a * reach;
}

void VelocityDamper::enter(int row) {
  const double room = rates_.d[row] - dampers_[at(row)].security;
  if (options_.headroom < 0 || !(room > 0)) return;
  if (options_.level == DamperLevel::barrier)
    raiseBoth(row, room);
  else
    raise(row, room);
}

// The row requires a * room >= speed, where `speed` is the present speed towards the other body.
void VelocityDamper::raise(int row, double room) {
  const Damper& damper = dampers_[at(row)];
  const double reach = damper.influence - damper.security, own = rate(row);
  const double most = mostGain(options_.level, options_.period);
  double speed = -rates_.speed[row];
  if (options_.level == DamperLevel::acceleration) speed -= options_.period * rates_.drift[row];
  const double excess = speed - own * room;
  if (!(excess > 0)) return;
  damping_[at(row)] = std::min(most, (speed + std::min(options_.headroom, excess)) / room) * reach;
}

// The row requires a g room >= (a + g) speed + fall. First the smaller gain is raised, up to the larger one;
// then both. Where their sum becomes too large, it stays at its limit: the smaller gain is then the least
// that fulfils the row with this sum, smaller (sum - smaller) room >= sum speed + fall. With the given larger
// gain the limit leaves the smaller one too little, so it is raised, and the larger one is lowered. A drift
// that brakes is ignored. Then the row holds only if h' + a h >= 0, and from such a state a pair never
// reaches h = 0.
void VelocityDamper::raiseBoth(int row, double room) {
  const Damper& damper = dampers_[at(row)];
  const double reach = damper.influence - damper.security;
  double &g = gain_[at(row)], a = rate(row);
  double speed = -rates_.speed[row];
  const double fall = std::max(0.0, -rates_.drift[row]);
  const double excess = speed + (fall - a * g * room) / (a + g);
  if (!(excess > 0)) return;
  speed += std::min(options_.headroom, excess);
  double &smaller = a < g ? a : g, &larger = a < g ? g : a;
  const double most = mostGain(options_.level, options_.period), sum = kMostSum / options_.period;
  const double needed = (larger * speed + fall) / (larger * room - speed);
  if (larger * room > speed && needed <= larger) {
    smaller = std::max(smaller, std::min(most, needed));
  } else {
    const double both = std::min(most, (speed + std::sqrt(speed * speed + room * fall)) / room);
    larger = std::max(larger, both);
    smaller = std::max(smaller, both);
  }
  if (smaller + larger > sum) {
    const double apart = std::sqrt(std::max(0.0, sum * sum - 4 * (sum * speed + fall) / room));
    smaller = std::min(most, (sum - apart) / 2);
    larger = sum - smaller;
  }
  damping_[at(row)] = a * reach;
}

double VelocityDamper::bound(int row) const {
  const Damper& damper = dampers_[at(row)];
  const double room = rates_.d[row] - damper.security, speed = rates_.speed[row];
  const double a = rate(row), g = gain_[at(row)];
  const double allowed = -a * room;
  if (options_.level == DamperLevel::velocity) return allowed;
  const double drift = rates_.drift[row];
  if (options_.level == DamperLevel::acceleration) return (allowed - speed) / options_.period - drift;
  return -drift - (a + g) * speed - a * g * room;
}

// Only for the period in which a pair enters too fast for the largest gains. One period later its speed times
// the period is at most kSlow of the room that is left then, if its acceleration is integrated exactly; with
// v += p u, d += p v more room is left. But it is never pushed away: a pair that would be at the security
// distance within half a period is stopped.
double VelocityDamper::brake(int row) const {
  const double room = rates_.d[row] - dampers_[at(row)].security, speed = rates_.speed[row];
  const double period = options_.period;
  if (options_.level == DamperLevel::velocity || options_.headroom < 0) return -kInfinity;
  if (!(-speed * period > kSlow * room)) return -kInfinity;
  const double allowed = std::min(0.0, -(room / period + speed / 2) / (1 / kSlow + 0.5));
  return (allowed - speed) / period - rates_.drift[row];
}

void VelocityDamper::update(const Eigen::Ref<const Eigen::VectorXd>& q,
                            const Eigen::Ref<const Eigen::VectorXd>& qd) {
  requireSize("VelocityDamper", "qd", qd.size(), constraints_.columns());
  bool known;
  if (options_.level == DamperLevel::velocity) {
    known = constraints_.evaluate(q, rates_.d, jacobian_) && qd.allFinite();
    if (!known) Eigen::Map<Eigen::VectorXd>(jacobian_.valuePtr(), jacobian_.nonZeros()).setZero();
    rates_.speed.noalias() = jacobian_ * qd;
  } else {
    known = constraints_.evaluate(q, qd, rates_, jacobian_);
  }
  near_.clear();
  if (!known) {  // no row can be met, and no pair has entered
    b_.setConstant(kInfinity);
    for (int row = 0; row < constraints_.rows(); ++row) near_.push_back(row);
    return;
  }
  for (int row = 0; row < constraints_.rows(); ++row) {
    const bool inside = rates_.d[row] < dampers_[at(row)].influence;
    if (inside) near_.push_back(row);
    b_[row] = kInfinity;
    if (!(rates_.d[row] > std::numeric_limits<double>::lowest()))
      continue;  // no value, so it has not entered
    const bool entered = inside && !inside_[at(row)];
    if (entered) enter(row);
    if (!inside && inside_[at(row)]) rest(row);
    inside_[at(row)] = inside;
    double b = inside ? bound(row) : -kInfinity;
    if (entered) b = std::max(b, brake(row));
    if (!std::isnan(b)) b_[row] = b;
  }
}

int VelocityDamper::dense(Eigen::Ref<Eigen::MatrixXd> A, Eigen::Ref<Eigen::VectorXd> b) const {
  const auto most = std::min(A.rows(), b.size());
  if (static_cast<std::size_t>(most) < near_.size() || A.cols() != jacobian_.cols())
    throw Error("VelocityDamper: dense() needs room for " + std::to_string(near_.size()) + " rows of " +
                std::to_string(jacobian_.cols()) + " columns, got " + std::to_string(most) + " of " +
                std::to_string(A.cols()));
  int count = 0;
  for (int row : near_) {
    A.row(count).setZero();
    for (CollisionConstraints::SparseJacobian::InnerIterator it(jacobian_, row); it; ++it)
      A(count, it.col()) = it.value();
    b[count++] = b_[row];
  }
  return count;
}

// While the active rows stay the same, x = x0 + H^-1 A' l with A x = b. The rows' part of dx/dt is the
// projection of H^-1 (dA/dt)' l plus H^-1 A' G^-1 (db/dt - dA/dt x), with G = A H^-1 A'.
double collisionAccelerationBound(const ProgramChange& change, double smallestH, double smallestG) {
  // 0 stays 0, even if the other factor is infinite.
  const auto times = [](double a, double b) { return a == 0 || b == 0 ? 0.0 : a * b; };
  const auto over = [](double sum, double eigenvalue) {
    if (sum == 0) return 0.0;
    return eigenvalue > 0 ? sum / std::sqrt(eigenvalue) : kInfinity;
  };
  return over(times(change.gradient, change.multiplier), smallestH) +
         over(change.bound + times(change.gradient, change.solution), smallestG);
}

}  // namespace fcl_stpbv
