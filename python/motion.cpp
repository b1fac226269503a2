// Motions of a robot in Python: proofs that they are free, or their first contact.
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "alone.h"
#include "fcl_stpbv/number_check.h"
#include "robot.h"

template <>
struct pybind11::detail::type_caster<fcl_stpbv::MotionVerdict>
    : fcl_stpbv::MadeCaster<fcl_stpbv::MotionVerdict> {};
template <>
struct pybind11::detail::type_caster<fcl_stpbv::PythonMotionBracket>
    : fcl_stpbv::MadeCaster<fcl_stpbv::PythonMotionBracket> {};

namespace fcl_stpbv {

MotionCheck& PythonRobot::motions() {
  requireCheckedPairs();
  if (!motions_)
    motions_ = std::make_unique<MotionCheck>(kinematics_, geometry_, checker_->pairs(), scene_->obstacles);
  return *motions_;
}

// A single motion needs at most about 200,000 distances, so Ctrl-C may wait for its end.
bool PythonRobot::isMotionFree(const Given& givenQ0, const Given& givenQ1, double margin) {
  const Eigen::VectorXd &q0 = checked(givenQ0, "q0", kinematics_->size()),
                        &q1 = checked(givenQ1, "q1", kinematics_->size());
  requireMargin(margin);
  MotionCheck& check = motions();
  const Alone alone(motionsInUse_);
  return check.isMotionFree(q0, q1, margin);
}

std::optional<Eigen::Index> PythonRobot::firstUnprovenMotion(GivenRows given, double margin) {
  const Rows& q = checkedRows(given);
  if (q.rows() < 2) throw Error("q: has " + std::to_string(q.rows()) + " way points, a motion needs two");
  requireMargin(margin);
  MotionCheck& check = motions();
  const Alone alone(motionsInUse_);
  Interrupt interrupt;
  for (Eigen::Index i = 0; i + 1 < q.rows(); ++i, interrupt())
    if (!check.isMotionFree(q.row(i).transpose(), q.row(i + 1).transpose(), margin)) return i;
  return std::nullopt;
}

PythonMotionBracket PythonRobot::firstContact(const Given& givenQ0, const Given& givenQ1, double margin,
                                              double tolerance) {
  const Eigen::VectorXd &q0 = checked(givenQ0, "q0", kinematics_->size()),
                        &q1 = checked(givenQ1, "q1", kinematics_->size());
  requireMargin(margin);
  detail::requireNumber("tolerance", tolerance, 1e-12, 1);
  MotionCheck& check = motions();
  const Alone alone(motionsInUse_);
  const MotionBracket found = check.firstContact(q0, q1, {margin, tolerance});
  PythonMotionBracket result{found.verdict, found.from, {}, {}};
  if (found.verdict == MotionVerdict::contact) result.contactAt = found.until;
  if (found.pair >= 0) result.row = rowOf(check.pairs()[static_cast<std::size_t>(found.pair)]);
  return result;
}

std::tuple<Eigen::VectorXd, Eigen::VectorXd, bool> PythonRobot::closestApproach(const Given& givenQ0,
                                                                                const Given& givenQ1,
                                                                                double precision) {
  const Eigen::VectorXd &q0 = checked(givenQ0, "q0", kinematics_->size()),
                        &q1 = checked(givenQ1, "q1", kinematics_->size());
  requireLength(precision, "precision");
  MotionCheck& check = motions();
  const Alone alone(motionsInUse_);
  std::vector<Approach> best;
  const bool proven = check.closest(q0, q1, precision, 0, best);
  constexpr double kNone = std::numeric_limits<double>::infinity(),
                   kLowest = std::numeric_limits<double>::lowest();
  Eigen::VectorXd d = Eigen::VectorXd::Constant(rows(), kNone), time = Eigen::VectorXd::Zero(rows());
  for (std::size_t pair = 0; pair < best.size(); ++pair) {
    const int row = rowOf(check.pairs()[pair]);
    // A distance that could not be measured gets the lowest value, not a large one, as in distances().
    d[row] = std::isfinite(best[pair].distance) ? best[pair].distance : kLowest;
    time[row] = best[pair].time;
  }
  return {std::move(d), std::move(time), proven};
}

void addMotions(py::module_& module, py::class_<PythonRobot>& robotClass) {
  py::enum_<MotionVerdict>(module, "MotionVerdict")
      .value("free", MotionVerdict::free, "proven: at no time does a pair come within the margin")
      .value("contact", MotionVerdict::contact, "a pair does")
      .value("undecided", MotionVerdict::undecided,
             "behind free_until the distance is the margin to rounding, or it took too many queries");

  py::class_<PythonMotionBracket>(module, "MotionBracket",
                                  "What becomes of a motion over the time from 0 to 1.")
      .def_readonly("verdict", &PythonMotionBracket::verdict)
      .def_readonly("free_until", &PythonMotionBracket::freeUntil,
                    "proven free before it; 1 for a free motion")
      .def_readonly("contact_at", &PythonMotionBracket::contactAt,
                    "in contact at it, at most the tolerance later; None without a contact")
      .def_readonly("row", &PythonMotionBracket::row,
                    "of the pair in contact, or not decided; None for a free motion")
      .def("__repr__", [](const PythonMotionBracket& bracket) {
        return py::str("<MotionBracket: {}, free until {}>")
            .format(py::cast(bracket.verdict).attr("name"), bracket.freeUntil);
      });

  robotClass
      .def("is_motion_free", &PythonRobot::isMotionFree, py::arg("q0"), py::arg("q1"), py::kw_only(),
           py::arg("margin") = 0.0,
           "Whether no pair comes within margin (m) anywhere on the straight line from q0 to q1: a proof, "
           "not\nsamples. What cannot be decided is not free.")
      .def("first_unproven_motion", &PythonRobot::firstUnprovenMotion, py::arg("q"), py::kw_only(),
           py::arg("margin") = 0.0,
           "The first i whose motion from q[i] to q[i + 1] is not proven free; None where all are.")
      .def(
          "first_contact", &PythonRobot::firstContact, py::arg("q0"), py::arg("q1"), py::kw_only(),
          py::arg("margin") = 0.0, py::arg("tolerance") = MotionRequest().tolerance,
          "A MotionBracket: the first contact, its time known to the tolerance (1e-12 to 1; 1: any contact).")
      .def("closest_approach", &PythonRobot::closestApproach, py::arg("q0"), py::arg("q1"), py::kw_only(),
           py::arg("precision") = 1e-4,
           "(d, time, proven): the least distance of each row (m), when, and whether it is proven that no "
           "row is\nanywhere less than its d less the precision. Infinite for whole links whose parts have "
           "rows.");
}

}  // namespace fcl_stpbv
