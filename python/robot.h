// A robot's collision constraints in Python, and its motions.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bodies.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/batch.h"
#include "fcl_stpbv/robot/motion_check.h"
#include "interrupt.h"
#include "made.h"
#include "scene.h"

namespace fcl_stpbv {

namespace py = pybind11;

/// @throws Error naming the argument, for numbers that are too large for the rows' second derivatives.
inline void requireUsable(const Eigen::VectorXd& numbers, const char* name) {
  if (!(numbers.array().abs() <= 1e100).all())
    throw Error(std::string(name) + ": holds a number above 1e100");
}

/// MotionBracket for Python, with a row in place of a pair.
struct PythonMotionBracket {
  MotionVerdict verdict = MotionVerdict::undecided;
  double freeUntil = 0;
  std::optional<double> contactAt;
  std::optional<int> row;
};

/// A robot, its volumes, and the pairs that must be checked according to its SRDF.
class PythonRobot {
 public:
  using Given = Floats<Eigen::VectorXd>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  // NumPy's order
  using GivenRows = Floats<Rows>;
  using Verdicts = Eigen::Array<bool, Eigen::Dynamic, 1>;

  PythonRobot(const Path& urdf, const std::optional<Path>& srdf, const std::optional<Path>& obstacles,
              const BodyOptions& bodies, const std::string& base, const Folders& packagePath,
              double influence, std::optional<double> exactUpTo, double handOver, bool measureMeshes) {
    const auto scene = std::make_shared<PythonScene>();
    named(srdf, "srdf"), named(obstacles, "obstacles");
    requireLength(influence, "influence"), requireLength(handOver, "hand_over");
    requireBend(influence, exactUpTo);
    scene->options = bodies.ofRobot(obstacles.has_value());
    scene->aroundOptions = bodies.ofObstacles();
    scene->options.packagePath = scene->aroundOptions.packagePath = packagePath.existing();
    scene->robot = std::make_shared<const RobotModel>(scene->loading.robot(urdf));
    if (srdf) scene->srdf = scene->loading.srdf(*srdf, *scene->robot);
    scene->measureMeshes = measureMeshes;
    const auto geometry = scene->load(base, obstacles);
    scene_ = scene;
    options_.influence = influence;
    options_.exactUpTo = exactUpTo.value_or(-1);
    options_.handOver = handOver;
    options_.obstacles = scene->obstacles;
    use(geometry);
    warnings_ = scene->loading.warnings;
    warn(warnings_);
  }

  /// The same robot with bodies refined for the needs, and the indices of needs that no bodies meet.
  std::pair<std::unique_ptr<PythonRobot>, std::vector<std::size_t>> modelFor(
      const std::vector<PythonScene::Need>& needs, const std::vector<double>& budgets, int threads) const {
    std::vector<std::size_t> unmet;
    std::unique_ptr<PythonRobot> model;
    {
      const py::gil_scoped_release others;
      model.reset(new PythonRobot(*this, scene_->modelFor(needs, budgets, threads, unmet)));
    }
    const std::vector<std::string> fresh = warningsOfModel(*scene_->robot, *model->geometry_, warnings_);
    model->warnings_.insert(model->warnings_.end(), fresh.begin(), fresh.end());
    warn(fresh);
    return {std::move(model), std::move(unmet)};
  }

  py::str described() const {
    const std::string size = detail::counted(detail::at(kinematics_->size()), "coordinate") + ", " +
                             detail::counted(detail::at(rows()), "row");
    return decoded("<Robot " + scene_->robot->name + ": " + size + ">");
  }
  const std::vector<std::string>& warnings() const { return warnings_; }
  const Kinematics& kinematics() const { return *kinematics_; }
  int vertices() const {
    std::set<const StpBv*> volumes;
    const auto add = [&](const fcl::CollisionGeometryd& geometry) {
      if (const StpBvGeometry* smooth = asStpBv(&geometry)) volumes.insert(&smooth->volume());
    };
    for (const CheckedPair& pair : constraints_->pairs()) {
      add(*geometry_->bodies[static_cast<std::size_t>(pair.body)].geometry);
      const auto other = static_cast<std::size_t>(pair.other);
      add(pair.obstacle ? *scene_->obstacles[other].geometry() : *geometry_->bodies[other].geometry);
    }
    int sum = 0;
    for (const StpBv* volume : volumes) sum += volume->vertexCount();
    return sum;
  }
  int rows() const { return constraints_->rows(); }
  std::vector<std::string> rowNames() const {
    std::vector<std::string> names;
    for (int row = 0; row < rows(); ++row) names.push_back(constraints_->name(row));
    return names;
  }
  Eigen::VectorXd exactUpTo() const {
    Eigen::VectorXd exact(rows());
    for (int row = 0; row < rows(); ++row) exact[row] = constraints_->exactUpTo(row);
    return exact;
  }
  Eigen::VectorXd configuration(const std::string& state) const {
    if (!scene_->srdf) throw Error("configuration: group states stand in an SRDF; give the robot one");
    return kinematics_->configuration(scene_->srdf->state(state));
  }

  Eigen::VectorXd distances(const Given& given) {
    const Eigen::VectorXd& q = checked(given, "q", kinematics_->size());
    Eigen::VectorXd d(rows());
    constraints_->evaluate(q, d);
    return d;
  }
  std::pair<Eigen::VectorXd, Eigen::MatrixXd> evaluate(const Given& given) {
    const Eigen::VectorXd& q = checked(given, "q", kinematics_->size());
    Eigen::VectorXd d(rows());
    Eigen::MatrixXd jacobian(rows(), constraints_->columns());
    constraints_->evaluate(q, d, jacobian);
    return {std::move(d), std::move(jacobian)};
  }
  bool collides(const Given& given, double margin) {
    const Eigen::VectorXd& q = checked(given, "q", kinematics_->size());
    return checker(margin).collides(q);
  }
  py::object firstHit(const Given& given, double margin) {
    const Eigen::VectorXd& q = checked(given, "q", kinematics_->size());
    const std::optional<Hit> hit = checker(margin).firstHit(q);
    if (!hit) return py::none();
    if (hit->pair < 0) throw Error("q: its links are too far away to be placed");
    return py::int_(rowOf(hit->bodies));
  }
  double minDistance(const Given& given) {
    const Eigen::VectorXd& q = checked(given, "q", kinematics_->size());
    return checker(0).minDistance(q);
  }

  Verdicts collidesMany(GivenRows given, double margin, bool path, int threads) {
    const Rows& q = checkedRows(given);
    Verdicts hit(q.rows());
    CheckerBatch batch(checker(margin), threads);
    inSlices(q.rows(), threads, [&](Eigen::Index start, Eigen::Index count) {
      batch.collides(q.middleRows(start, count).transpose(), sequenceOf(path), hit.segment(start, count));
    });
    return hit;
  }
  std::pair<Rows, py::array_t<double>> evaluateMany(GivenRows given, bool path, int threads) {
    const Rows& q = checkedRows(given);
    Rows d(q.rows(), rows());
    py::array_t<double> jacobian({q.rows(), static_cast<Eigen::Index>(rows()), q.cols()});
    double* dense = jacobian.mutable_data();
    ConstraintsBatch batch(*constraints_, threads);
    Rows values;
    inSlices(q.rows(), threads, [&](Eigen::Index start, Eigen::Index count) {
      values.resize(count, constraints_->nonZeros());
      batch.evaluateValues(q.middleRows(start, count).transpose(), sequenceOf(path),
                           d.middleRows(start, count).transpose(), values.transpose());
      dense = spread(values, q.cols(), dense);
    });
    return {std::move(d), std::move(jacobian)};
  }
  Rows distancesMany(GivenRows given, bool path, int threads) {
    const Rows& q = checkedRows(given);
    Rows d(q.rows(), rows());
    ConstraintsBatch batch(*constraints_, threads);
    inSlices(q.rows(), threads, [&](Eigen::Index start, Eigen::Index count) {
      batch.evaluate(q.middleRows(start, count).transpose(), sequenceOf(path),
                     d.middleRows(start, count).transpose());
    });
    return d;
  }

  // Used by controllers (damper.cpp).
  const CollisionConstraints& constraints() const { return *constraints_; }
  std::vector<RowAnswer> answers(const Given& givenQ, const std::optional<Given>& givenQd);
  Eigen::VectorXd gradientRateBounds(const Given& givenQ, const Given& givenQd);

  // For motions (motion.cpp).
  bool isMotionFree(const Given& givenQ0, const Given& givenQ1, double margin);
  std::optional<Eigen::Index> firstUnprovenMotion(GivenRows given, double margin);
  PythonMotionBracket firstContact(const Given& givenQ0, const Given& givenQ1, double margin,
                                   double tolerance);
  std::tuple<Eigen::VectorXd, Eigen::VectorXd, bool> closestApproach(const Given& givenQ0,
                                                                     const Given& givenQ1, double precision);

  py::tuple rates(const Given& givenQ, const Given& givenQd) {
    const Eigen::VectorXd &q = checked(givenQ, "q", kinematics_->size()),
                          &qd = checked(givenQd, "qd", kinematics_->size());
    RowRates rates = constraints_->makeRates();
    Eigen::MatrixXd jacobian(rows(), constraints_->columns());
    requireUsable(qd, "qd");
    constraints_->evaluate(q, qd, rates, jacobian);
    return py::make_tuple(std::move(rates.d), std::move(jacobian), std::move(rates.speed),
                          std::move(rates.drift));
  }
  Eigen::VectorXd hessianVector(const Given& givenQ, const Given& givenWeights, const Given& givenV) {
    const Eigen::VectorXd &q = checked(givenQ, "q", kinematics_->size()),
                          &weights = checked(givenWeights, "weights", rows()),
                          &v = checked(givenV, "v", kinematics_->size());
    Eigen::VectorXd product(q.size());
    requireUsable(weights, "weights"), requireUsable(v, "v");
    constraints_->hessianVector(q, weights, v, product);
    return product;
  }
  Eigen::MatrixXd hessian(const Given& givenQ, const Given& givenWeights) {
    const Eigen::VectorXd &q = checked(givenQ, "q", kinematics_->size()),
                          &weights = checked(givenWeights, "weights", rows());
    requireUsable(weights, "weights");
    CollisionConstraints::SparseHessian lower = constraints_->makeHessian();
    constraints_->hessian(q, weights, lower);
    return Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
  }

 private:
  PythonRobot(const PythonRobot& coarse, const std::shared_ptr<const RobotGeometry>& geometry)
      : scene_(coarse.scene_), options_(coarse.options_), warnings_(coarse.warnings_) {
    use(geometry);
  }

  void use(const std::shared_ptr<const RobotGeometry>& geometry) {
    geometry_ = geometry;
    kinematics_ = scene_->kinematics;
    const std::vector<CheckedPair> pairs = scene_->pairs(*geometry);
    constraints_ = std::make_unique<CollisionConstraints>(kinematics_, geometry, pairs, options_);
    if (!pairs.empty())
      checker_ = std::make_unique<CollisionChecker>(kinematics_, geometry, pairs, scene_->obstacles);
  }

  /// Called before loading starts. @throws Error naming the argument.
  static void requireLength(double length, const char* name) {
    if (!(length > 0))
      throw Error(std::string(name) + ": got " + std::string(py::str(py::float_(length))) +
                  ", expected a length above 0 (m)");
  }
  /// Called before loading starts. @throws Error naming the argument.
  static void requireBend(double influence, const std::optional<double>& exactUpTo) {
    if (!exactUpTo) return;
    const std::string got = "exact_up_to: got " + std::string(py::str(py::float_(*exactUpTo))) + ", ";
    if (std::isinf(influence))
      throw Error(got + "which needs an influence; without one a row is its distance everywhere");
    if (!(*exactUpTo >= 0 && *exactUpTo < influence))
      throw Error(got + "expected a length of 0 or more and below influence (m)");
  }
  /// @throws Error naming the argument.
  static const Eigen::VectorXd& checked(const Given& given, const char* name, int size) {
    requireNumbers(given.value, size, name);
    return given.value;
  }

  const Rows& checkedRows(GivenRows& given) const {
    Rows& q = given.value;
    if (q.rows() == 0) q.resize(0, kinematics_->size());  // an empty list, whose rows have no known length
    if (q.cols() != kinematics_->size())
      throw Error("q: got rows of " + std::to_string(q.cols()) + " numbers, expected (N, " +
                  std::to_string(kinematics_->size()) + "), one row a configuration");
    requireFinite(q, "q");
    return q;
  }
  static Sequence sequenceOf(bool path) { return path ? Sequence::path : Sequence::independent; }
  /// @throws Error if no pair is checked, because then nothing is proven clear.
  void requireCheckedPairs() const {
    if (!checker_) throw Error("no pair of bodies is checked, so that nothing can be said about collisions");
  }
  /// @throws Error naming the argument.
  static void requireMargin(double margin) {
    if (std::isnan(margin)) throw Error("margin: is not a number");
  }
  CollisionChecker& checker(double margin) {
    requireCheckedPairs();
    requireMargin(margin);
    checker_->setMargin(margin);
    return *checker_;
  }
  /// The motion check. It is made at the first call. @throws Error without checked pairs.
  MotionCheck& motions();
  /// The row of a pair. Whole bodies with a hand-over to their parts have additional rows.
  int rowOf(const CheckedPair& wanted) const {
    const auto isWanted = [&](const CheckedPair& pair) {
      return pair.body == wanted.body && pair.other == wanted.other && pair.obstacle == wanted.obstacle;
    };
    const std::vector<CheckedPair>& pairs = constraints_->pairs();
    return static_cast<int>(std::find_if(pairs.begin(), pairs.end(), isWanted) - pairs.begin());
  }
  /// Calls `work(start, count)` on slices of all rows, without Python's lock. Ctrl-C can end it between two
  /// slices. @throws py::error_already_set after Ctrl-C.
  template <class Work>
  static void inSlices(Eigen::Index rows, int threads, const Work& work) {
    // Slices are whole pieces of a batch, so they do not change the answers. Their size grows as long as a
    // slice takes little time.
    using Clock = std::chrono::steady_clock;
    Eigen::Index slice = kBatchPiece * static_cast<Eigen::Index>(threads);
    const py::gil_scoped_release others;
    Interrupt interrupt;
    for (Eigen::Index start = 0; start < rows; interrupt()) {
      const Clock::time_point begin = Clock::now();
      const Eigen::Index count = std::min(slice, rows - start);
      work(start, count);
      start += count;
      if (Clock::now() - begin < std::chrono::milliseconds(100)) slice *= 2;
    }
  }
  /// Writes the entries of each J into a dense matrix of zeros. @return the end of the written part
  double* spread(const Rows& values, Eigen::Index columns, double* dense) const {
    const Eigen::Index size = rows() * columns;
    std::fill(dense, dense + values.rows() * size, 0.0);
    const std::vector<int>&start = constraints_->rowStart(), &column = constraints_->columnIndices();
    for (Eigen::Index i = 0; i < values.rows(); ++i, dense += size)
      for (int row = 0; row < rows(); ++row)
        for (int k = start[static_cast<std::size_t>(row)]; k < start[static_cast<std::size_t>(row) + 1]; ++k)
          dense[row * columns + column[static_cast<std::size_t>(k)]] = values(i, k);
    return dense;
  }

  std::shared_ptr<const PythonScene> scene_;
  ConstraintOptions options_;
  std::vector<std::string> warnings_;
  std::shared_ptr<const RobotGeometry> geometry_;
  std::shared_ptr<const Kinematics> kinematics_;
  std::unique_ptr<CollisionConstraints> constraints_;
  std::unique_ptr<CollisionChecker> checker_;  // null where no pair is checked
  std::unique_ptr<MotionCheck> motions_;       // null until a motion is asked about
  std::mutex motionsInUse_;                    // Python's lock does not guard them
};

}  // namespace fcl_stpbv

template <>
struct pybind11::detail::type_caster<fcl_stpbv::PythonRobot> : fcl_stpbv::MadeCaster<fcl_stpbv::PythonRobot> {
};

namespace fcl_stpbv {

/// Adds rows for controllers, and the classes of the rows' answers.
void addDampers(py::module_& module, py::class_<PythonRobot>& robotClass);
/// Adds the methods about motions, and the classes of their results.
void addMotions(py::module_& module, py::class_<PythonRobot>& robotClass);

}  // namespace fcl_stpbv
