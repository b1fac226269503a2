// Collision rows for a controller's quadratic program: velocity dampers and control barriers.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv {

/// Brakes a pair that comes closer (Faverjon and Tournassoud, 1987): `dd/dt >= -damping (d - security) /
/// (influence - security)` from `influence` on.
struct Damper {
  double influence = 0.05;  ///< d_i (m)
  double security = 0.01;   ///< d_s, where the pair may not come closer (m)
  double damping = 0.5;     ///< xi, the speed allowed at `influence` (m/s)
};

/// What the program's variable is, and so what the rows say of it.
enum class DamperLevel {
  velocity,      ///< qd: J qd >= b, the damper itself
  acceleration,  ///< qdd: the damper's inequality for the velocity one period later
  barrier        ///< qdd: with h = d - security, h'' + (a + g) h' + a g h >= 0, a = damping / (influence -
                 ///< security)
};

/// What the rows brake, and when.
struct DamperOptions {
  DamperLevel level = DamperLevel::velocity;  ///< what the program's variable is
  Damper all;                                 ///< of all rows but those in `rows`
  std::map<int, Damper> rows;                 ///< of single rows
  /// A pair that enters faster than its row allows gets a larger xi until it leaves, at `barrier` a larger g
  /// too where xi is not enough. They allow what it does and as much again as it was too fast, at most this
  /// much (m/s). So no row acts on the tick on which it enters, but for a pair that enters at `security` or
  /// beyond, or so fast that it would be there within a few periods: that one brakes at once. At `barrier`
  /// a row also holds back, from the tick on which it enters, what accelerates towards the other body by more
  /// than the barrier allows. Negative: never.
  double headroom = 0.05;
  /// Of the controller (s), at every level: with gains above 1 / period, with accelerations above 1 / (3
  /// period), a pair could pass `security` between two ticks. Up to there a and g rise on entering. So a row
  /// acts at once where `security` is 1 period away, with accelerations 3, at `barrier` 6.
  double period = 1e-3;
  double barrierGain = 50;  ///< g (1/s), for `barrier`
};

/// Rows `A x >= b` of all pairs, one for each row of the constraints, in a structure that never changes. Rows
/// beyond their influence have b = -infinity. No allocation in update().
class VelocityDamper {
 public:
  /// Keeps a reference to the constraints. @throws Error for lengths, speeds or rows that make no sense, and
  /// for an influence beyond CollisionConstraints::exactUpTo(), where that row bends over.
  VelocityDamper(CollisionConstraints& constraints, DamperOptions options);

  /// Rows at q, while q moves with velocity qd. Of a q or qd that is not finite nothing is known: all rows
  /// are near, with A = 0 and b = infinity, which no x meets. A smooth constraint whose value is no number is
  /// near too, with b = infinity. @throws Error for a q or qd of another size.
  void update(const Eigen::Ref<const Eigen::VectorXd>& q, const Eigen::Ref<const Eigen::VectorXd>& qd);

  /// The rows' left side, rows() x columns() of the constraints.
  const CollisionConstraints::SparseJacobian& A() const { return jacobian_; }
  /// The rows' right side (m/s, or m/s^2 with accelerations).
  const Eigen::VectorXd& b() const { return b_; }
  /// The distances at the last update (m).
  const Eigen::VectorXd& d() const { return rates_.d; }
  /// Rows within their influence, ascending.
  const std::vector<int>& near() const { return near_; }
  /// Writes those rows one below the other and returns how many: for solvers of dense programs. @throws
  /// Error unless `A` has columns() columns, and both have room for near().size() rows.
  int dense(Eigen::Ref<Eigen::MatrixXd> A, Eigen::Ref<Eigen::VectorXd> b) const;

  /// xi of a row: its own, or what it got on entering, until it leaves (m/s). @throws Error for a row that
  /// does not exist.
  double damping(int row) const;
  /// g of a row: that of the options, or what it got on entering (1/s). @throws Error likewise.
  double barrierGain(int row) const;

 private:
  void requireRow(int row) const;
  void rest(int row);
  void enter(int row);
  void raise(int row, double room);
  void raiseBoth(int row, double room);
  double bound(int row) const;

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

/// What changes per second, in the units of A, b and x, in a quadratic program `min x'Hx/2 - f'x, A x >= b`,
/// of the rows that act.
struct ProgramChange {
  double gradient = 0;    ///< most of |dA/dt|, the 2-norm over the acting rows (see gradientRateBound)
  double bound = 0;       ///< most of |db/dt|
  double multiplier = 0;  ///< norm of the acting rows' multipliers
  double solution = 0;    ///< |x|
};
/// Most of |dx/dt| that collision rows add to what the task alone asks for, in the norm sqrt(x'Hx),
/// while the same rows act: `smallestH` is the smallest eigenvalue of H, `smallestG` that of A
/// H^-1 A' of the acting rows (docs/control.md). 0 where nothing changes, as without acting rows; infinite
/// where an eigenvalue is not above 0.
double collisionAccelerationBound(const ProgramChange& change, double smallestH, double smallestG);

}  // namespace fcl_stpbv
