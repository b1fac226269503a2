// Collision constraints for a controller's quadratic program: velocity dampers and control barrier functions.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv {

/// Velocity damper (Faverjon and Tournassoud, 1987): limits how fast a pair approaches. If d < influence,
/// then `dd/dt >= -damping (d - security) / (influence - security)`.
struct Damper {
  double influence = 0.05;  ///< d_i (m)
  double security = 0.01;   ///< d_s, the smallest distance that the pair may reach (m)
  double damping = 0.5;     ///< xi, the speed allowed at `influence` (m/s)
};

/// The variable of the quadratic program, and the form of the constraints.
enum class DamperLevel {
  velocity,      ///< qd: J qd >= b, the damper itself
  acceleration,  ///< qdd: the damper's inequality, for the velocity one period later
  barrier        ///< qdd: with h = d - security, h'' + (a + g) h' + a g h >= 0, a = damping / (influence -
                 ///< security)
};

/// Options of VelocityDamper.
struct DamperOptions {
  DamperLevel level = DamperLevel::velocity;  ///< variable and form of the constraints
  Damper all;                                 ///< parameters of all rows that are not in `rows`
  std::map<int, Damper> rows;                 ///< parameters of single rows, by index
  /// Used for a pair that comes within `influence` faster than its row allows. It gets a larger xi until it
  /// leaves the influence; at level `barrier` also a larger g, if xi is not enough. (There the smaller of the
  /// two gains is raised; the larger one is lowered if `period` limits their sum.) The larger gain allows
  /// the present speed plus the excess over the allowed speed, but at most `headroom` more than the present
  /// speed (m/s). So a row does not act in the period in which its pair enters. Exceptions: a pair that
  /// enters at `security` or nearer, or so fast that it would be there within a few periods, is braked at
  /// once. At level `barrier`, a row also limits at once an acceleration towards the other body that exceeds
  /// what the barrier allows. Negative: gains are never raised.
  double headroom = 0.05;
  /// Period of the controller (s), used at every level. It limits all gains, the given ones too: a to
  /// 1 / period, at level `acceleration` to 1 / (3 period), at level `barrier` a + g to 1 / period. With
  /// larger gains a pair could pass `security` between two periods. At level `barrier`, when a pair enters, a
  /// and g are raised to at most 1 / (3 period) each. So a row acts at once if the pair would reach
  /// `security` within 1 period (with accelerations 3, at level `barrier` 6, or less with a larger gain
  /// given).
  double period = 1e-3;
  double barrierGain = 50;  ///< g (1/s), for `barrier`
};

/// Constraints `A x >= b`, one for each row of CollisionConstraints, with a sparsity structure that never
/// changes. Rows beyond their influence have b = -infinity. No allocation in update().
class VelocityDamper {
 public:
  /// Keeps a reference to the constraints. @throws Error for lengths, speeds or row numbers out of range, and
  /// for an influence above CollisionConstraints::exactUpTo() of the row, because beyond it the row's value
  /// is not the distance.
  VelocityDamper(CollisionConstraints& constraints, DamperOptions options);

  /// Computes A and b at q, for the velocity qd. If q or qd is not finite, nothing is known: all rows are
  /// near(), with A = 0 and b = infinity, which no x can fulfil. A row without a value (a pair without a
  /// distance, a smooth constraint whose value is NaN) is near() too, with A = 0 and b = infinity. Neither
  /// changes which pairs are within their influence. @throws Error for a q or qd of a wrong size.
  void update(const Eigen::Ref<const Eigen::VectorXd>& q, const Eigen::Ref<const Eigen::VectorXd>& qd);

  /// The matrix A, rows() x columns() of the constraints.
  const CollisionConstraints::SparseJacobian& A() const { return jacobian_; }
  /// The right side b (m/s, or m/s^2 with accelerations).
  const Eigen::VectorXd& b() const { return b_; }
  /// The distances at the last update (m).
  const Eigen::VectorXd& d() const { return rates_.d; }
  /// Rows within their influence, ascending.
  const std::vector<int>& near() const { return near_; }
  /// For solvers with dense matrices: writes the rows of near() into `A` and `b` and returns their number.
  /// @throws Error unless `A` has columns() columns and both have at least near().size() rows.
  int dense(Eigen::Ref<Eigen::MatrixXd> A, Eigen::Ref<Eigen::VectorXd> b) const;

  /// The current xi of a row (m/s): that of its Damper, smaller if the period limits it, or the changed one
  /// while its pair is within the influence. @throws Error for a row that does not exist.
  double damping(int row) const;
  /// The current g of a row (1/s): that of the options, smaller if the period limits it, or the changed one
  /// while its pair is within the influence. @throws Error for a row that does not exist.
  double barrierGain(int row) const;

 private:
  void requireRow(int row) const;
  double rate(int row) const;
  void rest(int row);
  void enter(int row);
  void raise(int row, double room);
  void raiseBoth(int row, double room);
  double bound(int row) const;
  double brake(int row) const;

  CollisionConstraints& constraints_;
  DamperOptions options_;
  std::vector<Damper> dampers_;
  CollisionConstraints::SparseJacobian jacobian_;
  RowRates rates_;
  Eigen::VectorXd b_;
  std::vector<double> damping_, gain_;
  std::vector<char> inside_;
  std::vector<int> near_;
};

/// Rates of the active rows of a quadratic program `min x'Hx/2 - f'x, A x >= b`, and the size of its
/// solution, in the units of A, b and x, per second.
struct ProgramChange {
  double gradient = 0;    ///< upper bound on the 2-norm of dA/dt of the active rows (see gradientRateBound)
  double bound = 0;       ///< upper bound on |db/dt|
  double multiplier = 0;  ///< norm of the active rows' multipliers
  double solution = 0;    ///< |x|
};
/// Upper bound on the part of dx/dt that the collision constraints add to the task's own, in the norm
/// sqrt(x'Hx), while the same rows stay active. `smallestH` is the smallest eigenvalue of H, and `smallestG`
/// that of A H^-1 A' for the active rows (docs/control.md). 0 if nothing changes, for example without active
/// rows. Infinite if an eigenvalue is not above 0.
double collisionAccelerationBound(const ProgramChange& change, double smallestH, double smallestG);

}  // namespace fcl_stpbv
