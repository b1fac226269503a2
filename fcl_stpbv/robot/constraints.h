// All distances of a robot and their Jacobian, for an optimiser or a controller.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_hessian.h"
#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv {

/// A smooth function of some coordinates that replaces pairs of links whose convex hulls would be too large,
/// such as around a hip or a shoulder (paper VI: 8 of its 117 constraints).
struct SmoothConstraint {
  std::string name;              ///< for messages and reports
  std::vector<int> coordinates;  ///< ascending
  /// Returns the value at q, positive for allowed configurations. Writes one derivative per entry of
  /// `coordinates`, unless `gradient` is null. NaN if there is no value: the row is then that of a pair
  /// without a distance, with the lowest double and no derivative. A velocity damper treats the value like a
  /// distance (m). It is called from one thread at a time for each constraint. It must not throw. It must not
  /// allocate if evaluate() shall not allocate.
  std::function<double(const Eigen::Ref<const Eigen::VectorXd>& q, double* gradient)> value;
  /// Names of the pairs of links that it replaces.
  std::vector<std::pair<std::string, std::string>> replaces;
};

/// Additional rows, and the distances up to which rows are active.
struct ConstraintOptions {
  /// Pairs farther apart than this (m) cost only one test of their bounding spheres. Their rows have the
  /// constant value (influence + exactUpTo) / 2. Up to `exactUpTo` a row is the distance d. In between it
  /// goes over to the constant, with continuous second derivatives.
  double influence = std::numeric_limits<double>::infinity();
  /// Must be less than the influence (m), which must be finite; negative: half the influence.
  double exactUpTo = -1;
  /// For two bodies whose convex parts are among the pairs (RobotGeometry::byParts): adds a row for the whole
  /// bodies, before the first row of their parts. If the whole bodies are farther apart than `handOver` (m),
  /// no part is queried, and the rows of the parts have the constant value 3/4 handOver, or less with
  /// `influence`. If they are nearer than handOver / 2, the added row has that constant value and the rows of
  /// the parts are exact. In between every row goes over smoothly, as above. Infinite: no such rows.
  double handOver = std::numeric_limits<double>::infinity();
  std::vector<Obstacle> obstacles;       ///< the obstacles that pairs refer to
  std::vector<SmoothConstraint> smooth;  ///< rows after those of the pairs
};

/// Values and rates of all rows, for a controller.
struct RowRates {
  Eigen::VectorXd d;      ///< (m)
  Eigen::VectorXd speed;  ///< dd/dt = J qd (m/s)
  /// qd' H qd = dJ/dt qd, where H is the Hessian of d: the second time derivative of d at constant qd
  /// (m/s^2).
  Eigen::VectorXd drift;
};

/// An answer with the velocities of its normal and points, and a bound on the distance of the meshes behind
/// the two bodies. The velocities are those at qd after evaluate(q, qd), otherwise zero.
struct RowAnswer : DistanceAnswer {
  Eigen::Vector3d normalVelocity{0, 0, 0};  ///< (1/s), world axes
  /// Velocities of the witness points, which slide on their bodies (m/s), world axes.
  std::array<Eigen::Vector3d, 2> pointVelocity{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  /// Upper bound on the distance of the meshes or primitives behind the two bodies (m): `upper` plus both
  /// bodies' Body::volumeExcess. `lower` bounds it from below, except for a row of parts, whose meshes may be
  /// nearer at other parts. NaN without measureExcess(), and for a distance that is not above 0.
  double meshDistanceMost = std::numeric_limits<double>::quiet_NaN();
};

/// Distances d(q) and Jacobian J(q): one row per pair of bodies, then one per smooth constraint. Each row's
/// query starts from its last answer. Not thread-safe: only one thread at a time may use an object; copies
/// share only the robot, and ConstraintsBatch (batch.h) uses several threads. No allocation after
/// construction if every pair consists of two STP-BVs.
///
/// J follows the paper's eq. 2, with the velocities of the points that are fixed to the bodies at the witness
/// points. The paper's pre-gradient matrices are the motions of Kinematics. They are computed once per
/// configuration for all pairs.
class CollisionConstraints {
 public:
  using Vector = Eigen::Ref<Eigen::VectorXd>;             ///< output vector
  using ConstVector = Eigen::Ref<const Eigen::VectorXd>;  ///< a configuration, or one number per row
  using SparseJacobian = Eigen::SparseMatrix<double, Eigen::RowMajor>;  ///< rows() x columns()
  using SparseHessian = Eigen::SparseMatrix<double>;                    ///< columns() x columns()

  /// @throws Error for a pair, coordinate or link that does not exist.
  CollisionConstraints(std::shared_ptr<const Kinematics> kinematics,
                       std::shared_ptr<const RobotGeometry> geometry, std::vector<CheckedPair> pairs,
                       ConstraintOptions options = {});
  /// Number of rows: one per pair, then one per smooth constraint.
  int rows() const { return static_cast<int>(rowStart_.size()) - 1; }
  /// Number of coordinates.
  int columns() const { return kinematics_->size(); }
  /// The pairs of the first rows. Pairs that smooth constraints replace are missing; pairs of whole bodies
  /// from `handOver` are added.
  const std::vector<CheckedPair>& pairs() const { return pairs_; }
  /// Name of a row: its two bodies, or the smooth constraint's name. @throws Error for a row that does not
  /// exist. All functions below throw Error for such a row, and for a q or an output of a wrong size.
  std::string name(int row) const;
  /// The distance up to which a row's value is its distance (m). Beyond it the row goes over to a constant,
  /// because of `influence` or `handOver`. For the row of whole bodies it is the limit that comes from
  /// `influence`.
  double exactUpTo(int row) const;

  /// Number of entries of J that may differ from 0. They are ordered by row, then by column.
  int nonZeros() const { return static_cast<int>(column_.size()); }
  /// Index of each row's first entry, and one past the last entry (as in compressed sparse row format).
  const std::vector<int>& rowStart() const { return rowStart_; }
  /// The column of each entry.
  const std::vector<int>& columnIndices() const { return column_; }
  /// A sparse matrix of this structure, to be filled by evaluate().
  SparseJacobian makeJacobian() const;

  /// Distances (m), and with `jacobian` their derivatives. If a coordinate of q is not finite, nothing is
  /// known: each d is the lowest double, which no optimiser takes for clear, each derivative is 0, and each
  /// answer() is `invalid`. For a finite q, the same holds for the row of a pair without a distance, for
  /// example with links 1e160 m away. @returns whether q was finite.
  bool evaluate(const ConstVector& q, Vector d);
  /// evaluate() that also writes the nonZeros() entries of J.
  bool evaluateValues(const ConstVector& q, Vector d, Vector values);
  /// evaluate() that also writes J in the structure of makeJacobian().
  bool evaluate(const ConstVector& q, Vector d, SparseJacobian& jacobian);
  /// evaluate() that also writes J as a dense matrix, rows() x columns().
  bool evaluate(const ConstVector& q, Vector d, Eigen::Ref<Eigen::MatrixXd> jacobian);

  /// Vectors of the right size for evaluate(q, qd).
  RowRates makeRates() const;
  /// d and J at q, and their rates while q moves with velocity qd. The rates are in closed form
  /// (docs/robot.md). On a region boundary they are those of one side; for a mesh or an octree they are those
  /// of its nearest triangle or cell. The drift is from central differences for smooth constraints and for
  /// the few answers without a second derivative; 0 where a smooth constraint has no value beside q. If q or
  /// qd is not finite, or qd is above 1e100 so that its square may overflow, d and J are as for a q that is
  /// not finite, and the rates are 0.
  bool evaluateValues(const ConstVector& q, const ConstVector& qd, RowRates& rates, Vector values);
  /// The same evaluation with J in the structure of makeJacobian().
  bool evaluate(const ConstVector& q, const ConstVector& qd, RowRates& rates, SparseJacobian& jacobian);
  /// The same evaluation with J as a dense matrix.
  bool evaluate(const ConstVector& q, const ConstVector& qd, RowRates& rates,
                Eigen::Ref<Eigen::MatrixXd> jacobian);

  /// Upper bound on the 2-norm of a row's dJ/dt at the last evaluate(q, qd). It uses both bodies' r and R,
  /// their distance and their velocities (docs/control.md), and holds for any patches. Infinite after an
  /// evaluation without velocity, for bodies that are neither STP-BVs nor polyhedra, for smooth constraints,
  /// and if there is no bound.
  double gradientRateBound(int row) const;

  /// Sum over the rows of weight * (Hessian of d) * v: the weighted change of J as q moves along v. Closed
  /// form or central differences, as above. Rows with weight 0 are ignored. If an input is not finite, or a
  /// weight or an entry of v is above 1e100, `out` is 0. @returns whether all inputs were usable.
  bool hessianVector(const ConstVector& q, const ConstVector& weights, const ConstVector& v, Vector out);

  /// A sparse matrix for hessian() to fill: the lower triangle of a weighted sum of the rows' Hessians, in
  /// column order with ascending rows. The structure never changes.
  SparseHessian makeHessian() const;
  /// Sum over the rows of weight * Hessian of d: the constraints' part of the Hessian of a Lagrangian, as
  /// IPOPT needs it. The first call allocates memory. Inputs that are not finite are handled as above.
  /// @throws Error for a matrix of another structure than makeHessian()'s.
  bool hessian(const ConstVector& q, const ConstVector& weights, SparseHessian& lower);
  /// The Hessian of one row, columns() x columns(), symmetric. Inputs that are not finite are handled as
  /// above.
  /// @throws Error for a matrix of another size.
  bool hessian(const ConstVector& q, int row, Eigen::Ref<Eigen::MatrixXd> full);

  /// The answer of a row's pair at the last evaluation. The status is `invalid` if the pair was not queried,
  /// because bounding spheres or `handOver` made its row constant, and for the row of a smooth constraint,
  /// which has no points. Then nothing else of the answer is known, as for any pair without an answer (the
  /// distance is minus infinity): use the row's d. hessian() queries only rows whose weight is not 0; call
  /// evaluate() again before answer() of the others.
  RowAnswer answer(int row) const;
  /// The poses of the links at the last evaluation. Only the links of the rows' bodies and their ancestors
  /// are up to date.
  const Kinematics::State& state() const { return state_; }
  /// Drops all cached answers: the next evaluation starts like the first one.
  void forget();

 private:
  friend class ConstraintsBatch;
  struct Term {
    int motion;
    int side;  // 0: the motion moves the first body, 1: the second
    int slot;  // index among the non-zero entries
  };
  // A joint that moves both bodies, and that a joint between them mimics.
  struct CommonMotion {
    int motion;
    int slot;
  };
  struct Row {
    const StpBv *first = nullptr, *second = nullptr;  // null if one of the two is no STP-BV
    int a = 0, b = 0;                                 // indices into pose_ and centre_
    int firstTerm = 0, lastTerm = 0;
    double far = 0;             // centres farther apart than this need no query
    double start = 0, end = 0;  // distances at which the row leaves the distance and becomes constant
    int group = -1;             // index of the group of its whole bodies, -1 for none
    bool whole = false;         // whether this is the row of a group's whole bodies
    bool finite = false;        // whether all vertices of both bodies are finite, if they are meshes
    double excess = 0;          // of both surfaces over their meshes
    int firstCommon = 0, lastCommon = 0;
  };
  struct Witness {
    DistanceStatus status;
    double distance;
    Eigen::Vector3d normal;
    std::array<Eigen::Vector3d, 2> point;
  };

  void leaveOutReplaced();
  void addWholePairs();
  void addPair(const CheckedPair& pair);
  void addTerms(const CheckedPair& pair, Row& row);
  void addSmooth(const SmoothConstraint& constraint);
  const fcl::CollisionGeometryd& second(const CheckedPair& pair) const;
  void requireRow(int row) const;
  static bool isUsable(const ConstVector& numbers);
  void requireSizes(const ConstVector& q, Eigen::Index d, Eigen::Index values) const;
  void requireSizes(const ConstVector& q, const ConstVector& qd, const RowRates& rates,
                    Eigen::Index values) const;
  void requireStructure(const SparseJacobian& jacobian) const;
  void requireStructure(const SparseHessian& lower) const;
  void place(const ConstVector& q);
  void askWhole();
  bool compute(const ConstVector& q, double* d, double* values);
  bool computePairs(const ConstVector& q, double* d, double* values);
  void computeSmooth(const ConstVector& q, double* d, double* values) const;
  double smoothValue(std::size_t row, const ConstVector& q, double* values) const;
  void nothingKnown(double* d, double* values);
  void spread(Eigen::Ref<Eigen::MatrixXd> jacobian) const;
  Witness ask(std::size_t row);
  Witness query(std::size_t row);
  Witness known(std::size_t row) const;
  double pairRow(std::size_t row, double* values);
  void writeRow(std::size_t row, const Witness& witness, double slope, double* values) const;
  double levelled(std::size_t row, double d, double& slope, double& curvature) const;
  void bodyVelocities(std::size_t row, Twist& first, Twist& second) const;
  bool move(std::size_t row);
  bool rateRow(std::size_t row, RowRates& rates, double* values);
  bool rowChange(std::size_t row, double* change);
  void differences(const ConstVector& q, const ConstVector& v);
  void makeRoomForHessian();
  void prepareHessian(const ConstVector& q);
  bool rowHessian(std::size_t row);
  void fillTwists(std::size_t row);
  void addTwistChanges(std::size_t row, const Witness& witness);
  template <class Add>
  void openHessians(const ConstVector& q, const Add& add);

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  std::vector<CheckedPair> pairs_;
  ConstraintOptions options_;
  std::vector<int> rowStart_{0}, column_;
  std::vector<Row> rows_;
  std::vector<int> groupOf_;           // for each pair: its group, -1 for none
  std::vector<std::size_t> wholeRow_;  // for each group: the row of its whole bodies
  std::vector<Witness> whole_;         // for each group: the last answer of its whole bodies
  std::vector<CommonMotion> common_;
  std::vector<Term> terms_;
  std::vector<int> placed_;      // the robot's bodies that occur in rows
  Kinematics::Subtree placing_;  // the links of these bodies
  Kinematics::State state_;
  Kinematics::Rate rate_;
  std::vector<Eigen::Isometry3d> pose_;  // of each body, then of each obstacle
  std::vector<Eigen::Vector3d> centre_;  // of the bounding spheres of these
  std::vector<PairCache> caches_;
  std::vector<Distance> found_;          // answers of pairs of STP-BVs
  std::vector<DistanceAnswer> answers_;  // answers of the other pairs
  std::vector<DistanceRate> moves_;      // velocities of normal and points, at the last velocity of q
  bool moving_ = false;                  // whether the last evaluation had a velocity
  Eigen::VectorXd values_, change_, otherChange_, moved_, axis_;
  std::vector<Kinematics::Rate> alongEach_;  // rates at a unit velocity of each coordinate, for hessian()
  SparseHessian structure_;                  // structure of hessian()'s matrix, without values
  // For one row. `twists_`: the twists of both bodies for each coordinate of the row, as DistanceHessian
  // takes them. `pushes_`: DistanceHessian's matrix times `twists_`. `square_`: the row's Hessian.
  Eigen::Matrix<double, 12, Eigen::Dynamic> twists_, pushes_;
  Eigen::MatrixXd square_;
  std::vector<char> open_;  // rows whose change is computed by central differences
};

}  // namespace fcl_stpbv
