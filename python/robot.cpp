// A robot's collision constraints in Python.
#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/batch.h"
#include "interrupt.h"
#include "made.h"
#include "scene.h"

namespace py = pybind11;

namespace fcl_stpbv {
namespace {

/// A robot, its volumes and the pairs that its SRDF leaves to be checked.
class PythonRobot {
 public:
  using Given = Floats<Eigen::VectorXd>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  // NumPy's order
  using GivenRows = Floats<Rows>;
  using Verdicts = Eigen::Array<bool, Eigen::Dynamic, 1>;

  PythonRobot(const Path& urdf, const std::optional<Path>& srdf, const std::optional<Path>& obstacles,
              double r, double R, const std::string& base, const std::vector<Path>& packagePath,
              double influence, double handOver) {
    const auto scene = std::make_shared<PythonScene>();
    named(srdf, "srdf"), named(obstacles, "obstacles");
    requireLength(influence, "influence"), requireLength(handOver, "hand_over");
    scene->robot = std::make_shared<const RobotModel>(loadUrdf(urdf.string()));
    if (srdf) scene->srdf = loadSrdf(srdf->string(), *scene->robot);
    scene->options.radii = {r, R};
    scene->options.packagePath = toText(packagePath);
    const auto geometry = scene->load(base, obstacles);
    scene_ = scene;
    options_.influence = influence;
    options_.handOver = handOver;
    options_.obstacles = scene->obstacles;
    use(geometry);
  }

  /// The same robot, as fine as the needs ask for, and the places of those that no bodies meet.
  std::pair<std::unique_ptr<PythonRobot>, std::vector<std::size_t>> modelFor(
      const std::vector<PythonScene::Need>& needs, const std::vector<double>& budgets, int threads) const {
    std::vector<std::size_t> unmet;
    const py::gil_scoped_release others;
    const auto geometry = scene_->modelFor(needs, budgets, threads, unmet);
    return {std::unique_ptr<PythonRobot>(new PythonRobot(*this, geometry)), std::move(unmet)};
  }

  const Kinematics& kinematics() const { return *kinematics_; }
  int vertices() const {
    std::set<const StpBv*> volumes;
    for (const CheckedPair& pair : constraints_->pairs())
      for (const int body : {pair.body, pair.obstacle ? pair.body : pair.other})
        volumes.insert(geometry_->bodies[static_cast<std::size_t>(body)].volume.get());
    volumes.erase(nullptr);
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
    // Whole bodies that hand over to their parts have rows beside those of the pairs.
    const auto isHit = [&](const CheckedPair& pair) {
      return pair.body == hit->bodies.body && pair.other == hit->bodies.other &&
             pair.obstacle == hit->bodies.obstacle;
    };
    const std::vector<CheckedPair>& pairs = constraints_->pairs();
    return py::int_(std::find_if(pairs.begin(), pairs.end(), isHit) - pairs.begin());
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
      : scene_(coarse.scene_), options_(coarse.options_) {
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

  /// @throws Error naming the argument, before the work of loading.
  static void requireLength(double length, const char* name) {
    if (!(length > 0))
      throw Error(std::string(name) + ": got " + std::string(py::str(py::float_(length))) +
                  ", expected a length above 0 (m)");
  }
  /// @throws Error naming the argument.
  static const Eigen::VectorXd& checked(const Given& given, const char* name, int size) {
    requireNumbers(given.value, size, name);
    return given.value;
  }

  /// @throws Error naming the argument, for what the rows' second derivatives take for no number.
  static void requireUsable(const Eigen::VectorXd& numbers, const char* name) {
    if (!(numbers.array().abs() <= 1e100).all())
      throw Error(std::string(name) + ": holds a number above 1e100");
  }

  const Rows& checkedRows(GivenRows& given) const {
    Rows& q = given.value;
    if (q.rows() == 0) q.resize(0, kinematics_->size());  // an empty list does not say how long its rows are
    if (q.cols() != kinematics_->size())
      throw Error("q: got rows of " + std::to_string(q.cols()) + " numbers, expected (N, " +
                  std::to_string(kinematics_->size()) + "), one row a configuration");
    requireFinite(q, "q");
    return q;
  }
  static Sequence sequenceOf(bool path) { return path ? Sequence::path : Sequence::independent; }
  CollisionChecker& checker(double margin) {
    if (!checker_) throw Error("no pair of bodies is checked, so that nothing can be said about collisions");
    checker_->setMargin(margin);
    return *checker_;
  }
  /// `work(start, count)` on all rows without Python's lock, a slice at a time: between two of them Ctrl-C
  /// ends it. @throws py::error_already_set then.
  template <class Work>
  static void inSlices(Eigen::Index rows, int threads, const Work& work) {
    // Slices are whole pieces of a batch, which leaves each answer as it is. They grow as long as they take
    // no time.
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
  /// The entries of each J in their places among zeros. @return the end of what is written
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
  std::shared_ptr<const RobotGeometry> geometry_;
  std::shared_ptr<const Kinematics> kinematics_;
  std::unique_ptr<CollisionConstraints> constraints_;
  std::unique_ptr<CollisionChecker> checker_;  // null where no pair is checked
};

}  // namespace
}  // namespace fcl_stpbv

template <>
struct pybind11::detail::type_caster<fcl_stpbv::PythonRobot> : fcl_stpbv::MadeCaster<fcl_stpbv::PythonRobot> {
};

namespace fcl_stpbv {

void addRobot(py::module_& module) {
  py::class_<PythonRobot>(module, "Robot", "Distances d(q) and Jacobian J(q) of a robot's pairs of bodies.")
      .def(py::init<const Path&, const std::optional<Path>&, const std::optional<Path>&, double, double,
                    const std::string&, const std::vector<Path>&, double, double>(),
           py::arg("urdf"), py::arg("srdf") = py::none(), py::arg("obstacles") = py::none(), py::kw_only(),
           py::arg("r") = 0.01, py::arg("R") = 10.0, py::arg("base") = "fixed",
           py::arg("package_path") = std::vector<Path>{},
           py::arg("influence") = std::numeric_limits<double>::infinity(),
           py::arg("hand_over") = std::numeric_limits<double>::infinity(),
           "Loads a URDF, and the bodies of another one as obstacles. Pairs that the SRDF disables (without\n"
           "one, adjacent and rigid links) are left out. base: \"fixed\", \"planar\" or \"floating\".\n"
           "influence: farther pairs are constant (m). hand_over: links farther apart than this (m) are one\n"
           "row, nearer ones a row for each pair of their parts (model_for).")
      .def("model_for", &PythonRobot::modelFor, py::arg("needs"), py::kw_only(),
           py::arg("budgets") = std::vector<double>{}, py::arg("threads") = 1,
           "(a Robot as fine as the needs ask for, places of the needs that no bodies meet).\n"
           "A need: (link, link or obstacle, q, clearance in m that their distance is to exceed at q).\n"
           "budgets: coarser volumes to start from may exceed the hulls by each of these (m, falling).")
      .def_property_readonly("vertices", &PythonRobot::vertices, "of all volumes that its rows ask")
      .def_property_readonly(
          "names", [](const PythonRobot& robot) { return robot.kinematics().names(); }, "of the coordinates")
      .def_property_readonly("rows", &PythonRobot::rowNames, "names of the pairs, in the order of d")
      .def_property_readonly("lower", [](const PythonRobot& robot) { return robot.kinematics().lower(); })
      .def_property_readonly("upper", [](const PythonRobot& robot) { return robot.kinematics().upper(); })
      .def_property_readonly("neutral", [](const PythonRobot& robot) { return robot.kinematics().neutral(); })
      .def("configuration", &PythonRobot::configuration, py::arg("state"),
           "q of one of the SRDF's group states.")
      .def("distances", &PythonRobot::distances, py::arg("q"), "d(q), one row a pair (m).")
      .def("evaluate", &PythonRobot::evaluate, py::arg("q"), "(d(q), J(q)), J dense, a row a pair.")
      .def("collides", &PythonRobot::collides, py::arg("q"), py::kw_only(), py::arg("margin") = 0.0,
           "Whether any pair is not proven to be farther apart than margin (m).")
      .def("first_hit", &PythonRobot::firstHit, py::arg("q"), py::kw_only(), py::arg("margin") = 0.0,
           "Such a pair, an index into rows; None where all are clear.")
      .def("min_distance", &PythonRobot::minDistance, py::arg("q"), "Least of all pairs (m).")
      .def("collides_many", &PythonRobot::collidesMany, py::arg("q"), py::kw_only(), py::arg("margin") = 0.0,
           py::arg("path") = false, py::arg("threads") = 1,
           "collides() for each row of q. path: the rows are small steps along one path.")
      .def("distances_many", &PythonRobot::distancesMany, py::arg("q"), py::kw_only(),
           py::arg("path") = false, py::arg("threads") = 1, "d for each row of q: (N, rows).")
      .def("evaluate_many", &PythonRobot::evaluateMany, py::arg("q"), py::kw_only(), py::arg("path") = false,
           py::arg("threads") = 1, "(d, J) for each row of q: (N, rows) and (N, rows, coordinates).")
      .def("rates", &PythonRobot::rates, py::arg("q"), py::arg("qd"),
           "(d, J, dd/dt, qd' H qd): how each distance changes while q moves with velocity qd; H is its "
           "Hessian.")
      .def("hessian_vector", &PythonRobot::hessianVector, py::arg("q"), py::arg("weights"), py::arg("v"),
           "Sum over the rows of weight times (Hessian of d) times v.")
      .def("hessian", &PythonRobot::hessian, py::arg("q"), py::arg("weights"),
           "Sum over the rows of weight times Hessian of d, symmetric: a Lagrangian's part.");
}

}  // namespace fcl_stpbv
