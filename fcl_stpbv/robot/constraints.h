// All distances of a robot and their Jacobian, as an optimiser or a controller asks for them.
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

/// A smooth function of some coordinates that stands for pairs whose hulls would be too fat, as around a hip
/// or a shoulder (paper VI: 8 of its 117 constraints).
struct SmoothConstraint {
  std::string name;              ///< for messages and reports
  std::vector<int> coordinates;  ///< ascending
  /// Value at q, positive where allowed; writes one derivative per coordinate unless `gradient` is null. A
  /// velocity damper compares it with the distances of the pairs (m). Called from one thread at a time for
  /// each constraint. Must not throw; must not allocate if evaluate() shall not.
  std::function<double(const Eigen::Ref<const Eigen::VectorXd>& q, double* gradient)> value;
  std::vector<std::pair<std::string, std::string>> replaces;  ///< pairs of links that are left out for it
};

/// Which rows there are beside those of the pairs, and how far they reach.
struct ConstraintOptions {
  /// Pairs farther apart than this (m) cost one test of their bounding spheres. Their rows are constant:
  /// beyond `exactUpTo` a row leaves the distance d and bends over, twice continuously differentiable, to
  /// (influence + exactUpTo) / 2.
  double influence = std::numeric_limits<double>::infinity();
  double exactUpTo = -1;  ///< less than the influence (m); negative: half of it
  /// Two bodies whose convex parts are among the pairs (RobotGeometry::byParts) get one more row, that of the
  /// whole bodies, before the first of their parts'. Where the whole ones are farther apart than this (m), no
  /// part is asked and the parts' rows are constant at 3/4 of it, or less with `exactUpTo`; from half of it
  /// down the new row is constant there and the parts' are exact; between, every row bends as above.
  /// Infinite: no such rows.
  double handOver = std::numeric_limits<double>::infinity();
  std::vector<Obstacle> obstacles;       ///< that pairs may name
  std::vector<SmoothConstraint> smooth;  ///< rows after those of the pairs
};

/// What a controller asks for at every tick, row by row.
struct RowRates {
  Eigen::VectorXd d;      ///< (m)
  Eigen::VectorXd speed;  ///< dd/dt = J qd (m/s)
  /// qd' H qd, H the Hessian of d: dJ/dt qd, the second derivative of d while qd stays what it is (m/s^2).
  Eigen::VectorXd drift;
};

/// An answer that moves: after evaluate(q, qd) with the velocities at qd, else with zeros.
struct RowAnswer : DistanceAnswer {
  Eigen::Vector3d normalVelocity{0, 0, 0};  ///< (1/s), world axes
  /// Of the witness points, which slide on their bodies (m/s), world axes.
  std::array<Eigen::Vector3d, 2> pointVelocity{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
};

/// d(q) and J(q): one row per pair of bodies, then one per smooth constraint. Each row starts its query from
/// its last answer. One thread at a time may use one; no allocation after construction where every pair is of
/// STP-BVs. ConstraintsBatch (batch.h) has threads, and a copy shares the robot and nothing else.
///
/// J is the paper's eq. 2 with the velocities of the witness points taken as fixed to their bodies; the
/// motions of Kinematics are its pre-gradient matrices, put together once per configuration for all pairs.
class CollisionConstraints {
 public:
  using Vector = Eigen::Ref<Eigen::VectorXd>;             ///< room for results
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
  /// The pairs of the first rows: without those that smooth constraints replace, with those of whole bodies
  /// that hand over to their parts.
  const std::vector<CheckedPair>& pairs() const { return pairs_; }
  /// The two bodies of a row, or the smooth constraint's name. @throws Error for a row that does not exist,
  /// as all do that are asked for one, and as all below do for a q or a result of another size than theirs.
  std::string name(int row) const;
  /// Up to where a row's value is its distance (m): beyond it bends over, for `influence` or `handOver`. For
  /// the row of whole bodies this bounds what `influence` does to it.
  double exactUpTo(int row) const;

  /// The entries of J that may differ from 0, row by row, columns ascending.
  int nonZeros() const { return static_cast<int>(column_.size()); }
  /// Where each row begins among the entries, and one past the last.
  const std::vector<int>& rowStart() const { return rowStart_; }
  /// The column of each entry.
  const std::vector<int>& columnIndices() const { return column_; }
  /// A matrix of that structure, for evaluate() to fill.
  SparseJacobian makeJacobian() const;

  /// Distances, and with `jacobian` their derivatives. Where a coordinate of q is not finite nothing is
  /// known: each d is the lowest of all doubles, which no optimiser takes for clear, each derivative 0, each
  /// answer() `invalid`. So is, of a q that is finite, the row of a pair that cannot be measured, as with
  /// links 1e160 m away.
  /// @returns whether q was finite.
  bool evaluate(const ConstVector& q, Vector d);
  /// With the nonZeros() entries of J.
  bool evaluateValues(const ConstVector& q, Vector d, Vector values);
  /// With J in the structure of makeJacobian().
  bool evaluate(const ConstVector& q, Vector d, SparseJacobian& jacobian);
  /// With J as a dense matrix, rows() x columns().
  bool evaluate(const ConstVector& q, Vector d, Eigen::Ref<Eigen::MatrixXd> jacobian);

  /// Room for one row's numbers each.
  RowRates makeRates() const;
  /// d and J at q and how they change as q moves with the velocity qd. Closed form (docs/robot.md), on a
  /// region boundary that of one side, for a mesh or a tree that of its nearest triangle or cell; central
  /// differences for the drift of smooth constraints and of the few answers that have no second derivative. A
  /// q or qd that is not finite, or a qd above 1e100, whose square may overflow, gives what it gives above,
  /// and rates of 0.
  bool evaluateValues(const ConstVector& q, const ConstVector& qd, RowRates& rates, Vector values);
  /// The same with J in the structure of makeJacobian().
  bool evaluate(const ConstVector& q, const ConstVector& qd, RowRates& rates, SparseJacobian& jacobian);
  /// The same with J as a dense matrix.
  bool evaluate(const ConstVector& q, const ConstVector& qd, RowRates& rates,
                Eigen::Ref<Eigen::MatrixXd> jacobian);

  /// Most that |dJ/dt| of a row may be at the last evaluate(q, qd), in the 2-norm, whatever the patches: from
  /// both bodies' r and R, their distance and their velocities (docs/control.md). Infinite without a
  /// velocity, for bodies that are neither STP-BVs nor polyhedra, for smooth constraints, and where nothing
  /// bounds it.
  double gradientRateBound(int row) const;

  /// Sum over the rows of weight times (Hessian of d) times v: the change of J as q moves along v. Closed
  /// form and differences as above. Rows of weight 0 count for nothing, whatever they are. Where one of these
  /// numbers is not finite, or one of the weights or of v above 1e100, 0. @returns whether all were.
  bool hessianVector(const ConstVector& q, const ConstVector& weights, const ConstVector& v, Vector out);

  /// The lower triangle that a weighted sum of the rows' Hessians may fill, for hessian() to fill: columns
  /// one after the other, rows ascending; the structure never changes.
  SparseHessian makeHessian() const;
  /// Sum over the rows of weight times Hessian of d: the constraints' part of a Lagrangian's Hessian, as
  /// IPOPT asks for it. The first call makes room for what it needs. Numbers that are not finite as above.
  /// @throws Error for a matrix of another structure than makeHessian()'s.
  bool hessian(const ConstVector& q, const ConstVector& weights, SparseHessian& lower);
  /// The Hessian of one row, columns() x columns(), symmetric. Numbers that are not finite as above.
  /// @throws Error for a matrix of another size.
  bool hessian(const ConstVector& q, int row, Eigen::Ref<Eigen::MatrixXd> full);

  /// What the last evaluation found for a pair; status `invalid` where its spheres were enough, and for the
  /// row of a smooth constraint, which has no points. hessian() asks only the rows that it is given weights
  /// for: after it evaluate anew.
  RowAnswer answer(int row) const;
  /// Where the links were at the last evaluation: those of the rows' bodies and all that carry them. The
  /// others are not placed.
  const Kinematics::State& state() const { return state_; }
  /// Makes the next evaluation start as the first one did.
  void forget();

 private:
  friend class ConstraintsBatch;
  struct Term {
    int motion;
    int side;  // 0: it carries the first body, 1: the second
    int slot;  // among the non-zeros
  };
  // Of a joint that carries both bodies, and that one between them mimics.
  struct CommonMotion {
    int motion;
    int slot;
  };
  struct Row {
    const StpBv *first = nullptr, *second = nullptr;  // null where one of the two is no STP-BV
    int a = 0, b = 0;                                 // places among pose_ and centre_
    int firstTerm = 0, lastTerm = 0;
    double far = 0;             // centres farther apart than this need no query
    double start = 0, end = 0;  // where the row leaves the distance, and where it is constant
    int group = -1;             // of the whole bodies that hand over to it, -1 for none
    bool whole = false;         // hands over to the parts
    bool finite = false;        // the corners of both are numbers, if they are meshes
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
  void nothingKnown(double* d, double* values);
  void spread(Eigen::Ref<Eigen::MatrixXd> jacobian) const;
  Witness ask(std::size_t row);
  Witness query(std::size_t row);
  Witness known(std::size_t row) const;
  double pairRow(std::size_t row, double* values);
  void writeRow(std::size_t row, const Witness& witness, double slope, double* values) const;
  double bend(std::size_t row, double d, double& slope, double& curvature) const;
  void bodyVelocities(std::size_t row, Twist& first, Twist& second) const;
  bool move(std::size_t row);
  bool rateRow(std::size_t row, RowRates& rates, double* values);
  bool rowChange(std::size_t row, double* change);
  void differences(const ConstVector& q, const ConstVector& v);
  void makeRoomForHessian();
  void prepareHessian(const ConstVector& q);
  bool rowHessian(std::size_t row);
  template <class Add>
  void openHessians(const ConstVector& q, const Add& add);

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  std::vector<CheckedPair> pairs_;
  ConstraintOptions options_;
  std::vector<int> rowStart_{0}, column_;
  std::vector<Row> rows_;
  std::vector<int> groupOf_;           // of each pair, -1 for none
  std::vector<std::size_t> wholeRow_;  // of each group
  std::vector<Witness> whole_;         // what its bodies are at, once placed
  std::vector<CommonMotion> common_;
  std::vector<Term> terms_;
  std::vector<int> placed_;      // the robot's bodies that rows have
  Kinematics::Subtree placing_;  // their links
  Kinematics::State state_;
  Kinematics::Rate rate_;
  std::vector<Eigen::Isometry3d> pose_;  // of each body, then of each obstacle
  std::vector<Eigen::Vector3d> centre_;  // of their spheres
  std::vector<PairCache> caches_;
  std::vector<Distance> found_;          // of pairs of STP-BVs
  std::vector<DistanceAnswer> answers_;  // of the other pairs
  std::vector<DistanceRate> moves_;      // of normal and points, at the last velocity
  bool moving_ = false;                  // whether the last evaluation had one
  Eigen::VectorXd values_, change_, otherChange_, moved_, axis_;
  std::vector<Kinematics::Rate> alongEach_;  // at a unit velocity of each coordinate, for hessian()
  SparseHessian structure_;                  // that hessian() fills, without values
  // Of one row's coordinates: what each does to both bodies, as DistanceHessian takes it; that matrix times
  // it; the row's Hessian.
  Eigen::Matrix<double, 12, Eigen::Dynamic> twists_, pushes_;
  Eigen::MatrixXd square_;
  std::vector<char> open_;  // rows whose change is left to differences
};

}  // namespace fcl_stpbv
