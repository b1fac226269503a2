// Collision rows for a controller in Python, and the answers of the rows.
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "alone.h"
#include "fcl_stpbv/robot/velocity_damper.h"
#include "robot.h"
#include "words.h"

namespace fcl_stpbv {
namespace {

using GivenRows = std::map<int, std::tuple<double, double, double>>;  ///< d_i, d_s (m), xi (m/s) of a row

DamperLevel levelOf(const std::string& name) {
  if (name == "velocity") return DamperLevel::velocity;
  if (name == "acceleration") return DamperLevel::acceleration;
  if (name == "barrier") return DamperLevel::barrier;
  throw Error("level: got \"" + name + R"(", expected "velocity", "acceleration" or "barrier")");
}

/// VelocityDamper for Python. It has its own copy of the robot's constraints, so that other calls on the
/// robot do not change its caches.
class PythonDamper {
 public:
  using Matrix = PythonRobot::Rows;

  PythonDamper(const PythonRobot& robot, const std::string& level, double influence, double security,
               double damping, const GivenRows& rows, double headroom, double period, double barrierGain)
      : constraints_(robot.constraints()), damper_(inPythonsWords([&] {
          DamperOptions options;
          options.level = levelOf(level);
          options.all = {influence, security, damping};
          for (const auto& [row, of] : rows)
            options.rows[row] = {std::get<0>(of), std::get<1>(of), std::get<2>(of)};
          options.headroom = headroom;
          options.period = period;
          options.barrierGain = barrierGain;
          return VelocityDamper(constraints_, options);
        })) {
    constraints_.forget();
  }
  PythonDamper(const PythonDamper&) = delete;  // the damper refers to the constraints beside it
  PythonDamper& operator=(const PythonDamper&) = delete;

  std::pair<Matrix, Eigen::VectorXd> update(const PythonRobot::Given& q, const PythonRobot::Given& qd) {
    requireNumbers(q.value, constraints_.columns(), "q");
    requireNumbers(qd.value, constraints_.columns(), "qd");
    requireUsable(qd.value, "qd");
    const Alone alone(inUse_);
    damper_.update(q.value, qd.value);
    updated_ = true;
    const auto count = static_cast<Eigen::Index>(damper_.near().size());
    Eigen::MatrixXd A(count, constraints_.columns());
    Eigen::VectorXd b(count);
    damper_.dense(A, b);
    return {A, std::move(b)};
  }

  /// A copy of what `part` finds in the damper.
  template <class Part>
  auto of(const Part& part) const {
    const Alone alone(inUse_);
    return part(damper_);
  }
  /// The same, @throws Error before the first update.
  template <class Part>
  auto updated(const Part& part) const {
    const Alone alone(inUse_);
    if (!updated_) throw Error("VelocityDamper: has no rows before the first update(q, qd)");
    return part(damper_);
  }
  RowAnswer answer(int row) const {
    return updated([&](const VelocityDamper&) { return constraints_.answer(row); });
  }
  int rows() const { return constraints_.rows(); }

 private:
  CollisionConstraints constraints_;
  VelocityDamper damper_;
  bool updated_ = false;
  mutable std::mutex inUse_;
};

}  // namespace

std::vector<RowAnswer> PythonRobot::answers(const Given& givenQ, const std::optional<Given>& givenQd) {
  const Eigen::VectorXd& q = checked(givenQ, "q", kinematics_->size());
  if (givenQd) {
    requireUsable(checked(*givenQd, "qd", kinematics_->size()), "qd");
    RowRates rates = constraints_->makeRates();
    Eigen::VectorXd values(constraints_->nonZeros());
    constraints_->evaluateValues(q, givenQd->value, rates, values);
  } else {
    Eigen::VectorXd d(rows());
    constraints_->evaluate(q, d);
  }
  std::vector<RowAnswer> answers;
  for (int row = 0; row < rows(); ++row) answers.push_back(constraints_->answer(row));
  return answers;
}

Eigen::VectorXd PythonRobot::gradientRateBounds(const Given& givenQ, const Given& givenQd) {
  const Eigen::VectorXd &q = checked(givenQ, "q", kinematics_->size()),
                        &qd = checked(givenQd, "qd", kinematics_->size());
  requireUsable(qd, "qd");
  RowRates rates = constraints_->makeRates();
  Eigen::VectorXd values(constraints_->nonZeros()), bounds(rows());
  constraints_->evaluateValues(q, qd, rates, values);
  for (int row = 0; row < rows(); ++row) bounds[row] = constraints_->gradientRateBound(row);
  return bounds;
}

}  // namespace fcl_stpbv

template <>
struct pybind11::detail::type_caster<fcl_stpbv::RowAnswer> : fcl_stpbv::MadeCaster<fcl_stpbv::RowAnswer> {};
template <>
struct pybind11::detail::type_caster<fcl_stpbv::PythonDamper>
    : fcl_stpbv::MadeCaster<fcl_stpbv::PythonDamper> {};

namespace fcl_stpbv {
namespace {

PointArray both(const std::array<Eigen::Vector3d, 2>& vectors) {
  return toArray({vectors.begin(), vectors.end()});
}

double accelerationBound(const ProgramChange& change, double smallestH, double smallestG) {
  const std::pair<const char*, double> given[] = {{"gradient", change.gradient},
                                                  {"bound", change.bound},
                                                  {"multiplier", change.multiplier},
                                                  {"solution", change.solution}};
  for (const auto& [name, value] : given)
    if (!(value >= 0))
      throw Error(std::string(name) + ": got " + std::string(py::str(py::float_(value))) +
                  ", expected 0 or more");
  return collisionAccelerationBound(change, smallestH, smallestG);
}

void addAccelerationBound(py::module_& module) {
  module.def(
      "collision_acceleration_bound",
      [](double smallestH, double smallestG, double gradient, double bound, double multiplier,
         double solution) {
        return accelerationBound({gradient, bound, multiplier, solution}, smallestH, smallestG);
      },
      py::kw_only(), py::arg("smallest_h"), py::arg("smallest_g"), py::arg("gradient") = 0.0,
      py::arg("bound") = 0.0, py::arg("multiplier") = 0.0, py::arg("solution") = 0.0,
      "Most of |dx/dt| that collision rows add in min x'Hx/2 - f'x, A x >= b while the same rows act, in\n"
      "the norm sqrt(x'Hx). smallest_h, smallest_g: smallest eigenvalues of H and of A H^-1 A' of these\n"
      "rows. gradient: most of |dA/dt|, bound: of |db/dt|, multiplier: norm of the rows' multipliers,\n"
      "solution: |x|. inf where an eigenvalue is not above 0, 0 where nothing changes.");
}

void addAnswer(py::module_& module) {
  py::class_<RowAnswer>(module, "RowAnswer", "What was found for a row's pair. World frame.")
      .def_readonly("status", &RowAnswer::status,
                    "Status.invalid where the pair is so far apart that its spheres were enough")
      .def_readonly("distance", &RowAnswer::distance, "signed (m), also where the row bends over")
      .def_readonly("lower", &RowAnswer::lower, "certified")
      .def_readonly("upper", &RowAnswer::upper, "certified")
      .def_readonly("normal", &RowAnswer::normal, "unit, from the first body to the second")
      .def_property_readonly(
          "points", [](const RowAnswer& answer) { return both(answer.points); },
          "(2, 3): witness points on the two surfaces")
      .def_readonly("continuous", &RowAnswer::continuous,
                    "whether the distance and its gradient are continuous over motions")
      .def_readonly("normal_velocity", &RowAnswer::normalVelocity, "(1/s); 0 without qd")
      .def_property_readonly(
          "point_velocities", [](const RowAnswer& answer) { return both(answer.pointVelocity); },
          "(2, 3): of the witness points, which slide on their bodies (m/s); 0 without qd")
      .def_readonly("mesh_distance_most", &RowAnswer::meshDistanceMost,
                    "upper bound on the distance of the meshes behind the bodies (m); nan without "
                    "Robot(measure_meshes=True), and where the bodies are not apart")
      .def("__repr__", [](const RowAnswer& answer) {
        return py::str("<RowAnswer: {} m, {}>").format(answer.distance, py::cast(answer.status).attr("name"));
      });
}

}  // namespace

void addDampers(py::module_& module, py::class_<PythonRobot>& robotClass) {
  addAnswer(module);
  addAccelerationBound(module);
  robotClass
      .def("answers", &PythonRobot::answers, py::arg("q"), py::arg("qd") = py::none(),
           "A RowAnswer for each row at q, while q moves with velocity qd where it is given: points, normal.")
      .def("gradient_rate_bounds", &PythonRobot::gradientRateBounds, py::arg("q"), py::arg("qd"),
           "Most that |dJ/dt| of each row may be there, whatever the patches; inf where nothing bounds it.");
  const DamperOptions usual;
  py::class_<PythonDamper>(module, "VelocityDamper",
                           "Rows A x >= b that brake a robot's pairs, for a controller's quadratic program.")
      .def(
          py::init<const PythonRobot&, const std::string&, double, double, double, const GivenRows&, double,
                   double, double>(),
          py::arg("robot"), py::kw_only(), py::arg("level") = "velocity",
          py::arg("influence") = usual.all.influence, py::arg("security") = usual.all.security,
          py::arg("damping") = usual.all.damping, py::arg("rows") = GivenRows{},
          py::arg("headroom") = usual.headroom, py::arg("period") = usual.period,
          py::arg("barrier_gain") = usual.barrierGain,
          "level: \"velocity\" (x = qd), \"acceleration\" or \"barrier\" (x = qdd). influence d_i, security\n"
          "d_s (m), damping xi (m/s): dd/dt >= -xi (d - d_s) / (d_i - d_s) from d_i on. rows: those three\n"
          "of single rows, by index. headroom (m/s): a pair that enters faster than its row allows gets a\n"
          "larger xi, so that the row does not act at once; negative: never. barrier_gain: g (1/s).\n"
          "period: the controller's (s). It limits a = xi / (d_i - d_s) to 1 / period, to 1 / (3 period) at\n"
          "level \"acceleration\", a + g to 1 / period at level \"barrier\".")
      .def("update", &PythonDamper::update, py::arg("q"), py::arg("qd"),
           "(A, b): the rows within their influence, `near`, at q, while q moves with velocity qd.")
      .def_property_readonly(
          "A",
          [](const PythonDamper& damper) {
            return damper.updated([](const VelocityDamper& of) { return PythonDamper::Matrix(of.A()); });
          },
          "Left sides of all rows, one a row of the robot.")
      .def_property_readonly(
          "b",
          [](const PythonDamper& damper) {
            return damper.updated([](const VelocityDamper& of) { return of.b(); });
          },
          "Right sides of all rows (m/s or m/s^2); -inf beyond their influence.")
      .def_property_readonly(
          "d",
          [](const PythonDamper& damper) {
            return damper.updated([](const VelocityDamper& of) { return of.d(); });
          },
          "Distances at the last update (m).")
      .def_property_readonly(
          "near",
          [](const PythonDamper& damper) {
            return damper.updated([](const VelocityDamper& of) { return of.near(); });
          },
          "Which rows update() gave, as indices into Robot.rows.")
      .def("answer", &PythonDamper::answer, py::arg("row"),
           "What the last update found for a row: points, normal; their velocities but at level "
           "\"velocity\".")
      .def(
          "damping",
          [](const PythonDamper& damper, int row) {
            return damper.of([&](const VelocityDamper& of) { return of.damping(row); });
          },
          py::arg("row"),
          "xi of a row: its own, smaller if the period limits it, or what it got on entering, until it "
          "leaves (m/s).")
      .def(
          "barrier_gain",
          [](const PythonDamper& damper, int row) {
            return damper.of([&](const VelocityDamper& of) { return of.barrierGain(row); });
          },
          py::arg("row"), "g of a row, likewise (1/s).")
      .def("__repr__", [](const PythonDamper& damper) {
        return "<VelocityDamper: " + std::to_string(damper.rows()) + " rows>";
      });
}

}  // namespace fcl_stpbv
