// Posture search in Python, one start per call, so that the starts can run in parallel.
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bodies.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/posture/find_posture.h"
#include "interrupt.h"
#include "loading.h"
#include "made.h"
#include "parts.h"

namespace py = pybind11;

namespace fcl_stpbv {
namespace {

/// A robot among obstacles, loaded once for any number of tasks.
class PythonPostureSearch {
 public:
  PythonPostureSearch(const Path& urdf, const std::optional<Path>& srdf, const std::optional<Path>& obstacles,
                      const BodyOptions& bodies, const Folders& packagePath) {
    named(srdf, "srdf"), named(obstacles, "obstacles");
    GeometryOptions options = bodies.ofRobot(obstacles.has_value());
    options.packagePath = packagePath.existing();
    scene_.robot = std::make_shared<const RobotModel>(loading_.robot(urdf));
    if (srdf) scene_.srdf = std::make_shared<const Srdf>(loading_.srdf(*srdf, *scene_.robot));
    scene_.geometry = std::make_shared<const RobotGeometry>(loading_.geometry(*scene_.robot, options));
    if (obstacles) {
      const auto around = std::make_shared<const RobotModel>(loading_.obstacles(*obstacles));
      scene_.obstacles = obstaclesOf(around, loading_.geometry(*around, options));
    }
    if (scene_.srdf)
      loading_.warnOfPairs(*scene_.robot, *scene_.geometry, *scene_.srdf);
    else
      scene_.selfPairs = searchedPairs(scene_.robot, scene_.geometry);
    warn(warnings());
  }

  py::str described() const {
    const std::string around =
        scene_.obstacles.empty() ? "" : " among " + detail::counted(scene_.obstacles.size(), "obstacle");
    return decoded("<PostureSearch " + scene_.robot->name + ": " +
                   std::to_string(scene_.geometry->bodies.size()) + " bodies" + around + ">");
  }
  const std::vector<std::string>& warnings() const { return loading_.warnings; }

  /// Solves from one start with a problem of its own, because other starts would leave caches that change the
  /// last bits.
  Posture solve(const std::string& task, const std::string& path, int start, std::uint64_t seed,
                const std::optional<Floats<Eigen::VectorXd>>& from) const {
    PostureSetup setup = setUp(taskOf(task, path), scene_);
    if (setup.pairs.empty())  // no robot's path in the message: a job's result is the same on every machine
      throw Error(
          path +
          ": no pair of bodies is checked (the task and the robot's joints leave none), so that nothing "
          "can be said about collisions; leave pairs to be checked in \"collisions\"");
    if (from) {
      requireNumbers(from->value, setup.start.size(), "start_from");
      setup.start = from->value;
    }
    PostureOptions options;
    options.firstStart = start;
    options.starts = 1;
    options.repairs = options.anywhere = 0;
    options.seed = seed;
    Interrupt interrupt;
    options.solver.stop = [&] { return interrupt(), false; };
    Posture posture = findPosture(setup, options);
    requireFinite(posture, path + ": start " + std::to_string(start));
    return posture;
  }

  std::vector<std::string> names(const std::string& task, const std::string& path) const {
    return setUp(taskOf(task, path), scene_).problem->kinematics().names();
  }

 private:
  static PostureTask taskOf(const std::string& text, const std::string& path) {
    PostureTask task = parseTask(text, path);
    if (task.partsAuto || task.parts > 1)
      throw Error(path + ": collisions.parts: only the program find_posture splits links; leave it out here");
    return task;
  }

  // Refuses postures with values that are not finite. They are no answer, and JSON has no word for them.
  static void requireFinite(const Posture& posture, const std::string& where) {
    double sum = posture.cost;
    for (const auto* list : {&posture.violations, &posture.conflict})
      for (const Violation& violation : *list)
        sum += violation.amount / 1e3;  // divided, because a few amounts may be the largest double
    if (!posture.q.allFinite() || !std::isfinite(sum))
      throw Error(where + ": leads to numbers that are not finite; start nearer to the origin");
  }

  PostureScene scene_;
  Loading loading_;
};

py::dict asDict(const Posture& posture) {
  const auto list = [](const std::vector<Violation>& violations) {
    std::vector<std::pair<std::string, double>> named;
    for (const Violation& violation : violations) named.emplace_back(violation.name, violation.amount);
    return named;
  };
  py::dict result;
  result["feasible"] = posture.feasible;
  result["status"] = posture.status;
  result["cost"] = posture.cost;
  result["iterations"] = posture.iterations;
  result["distance_calls"] = posture.distanceCalls;
  result["q"] = std::vector<double>(posture.q.begin(), posture.q.end());
  result["violations"] = list(posture.violations);
  result["conflict"] = list(posture.conflict);
  return result;
}

}  // namespace
}  // namespace fcl_stpbv

template <>
struct pybind11::detail::type_caster<fcl_stpbv::PythonPostureSearch>
    : fcl_stpbv::MadeCaster<fcl_stpbv::PythonPostureSearch> {};

namespace fcl_stpbv {

void addPostures(py::module_& module) {
  py::class_<PythonPostureSearch>(module, "PostureSearch",
                                  "Postures of a robot among obstacles, in independent pieces.")
      .def(py::init([](const Path& urdf, const std::optional<Path>& srdf,
                       const std::optional<Path>& obstacles, const BodyOptions::Length& r,
                       const std::optional<BodyOptions::Length>& R, const Folders& packagePath) {
             return std::make_unique<PythonPostureSearch>(urdf, srdf, obstacles, BodyOptions{r, R},
                                                          packagePath);
           }),
           py::arg("urdf"), py::arg("srdf") = py::none(), py::arg("obstacles") = py::none(), py::kw_only(),
           py::arg("r") = 0.01, py::arg("R") = py::none(), py::arg("package_path") = Folders{},
           "Without an SRDF the robot's own pairs are those that samples leave to be checked. r, R: as of "
           "Robot.")
      .def_property_readonly(
          "warnings", [](const PythonPostureSearch& search) { return decoded(search.warnings()); },
          "What loading warned of, as Robot.warnings.")
      .def(
          "solve",
          [](const PythonPostureSearch& search, const std::string& task, const std::string& path, int start,
             std::uint64_t seed, const std::optional<Floats<Eigen::VectorXd>>& from) {
            requireCount(start, 0, "start");
            Posture posture;
            {
              const py::gil_scoped_release others;
              posture = search.solve(task, path, start, seed, from);
            }
            return asDict(posture);
          },
          py::arg("task"), py::arg("path") = "task", py::arg("start") = 0, py::arg("seed") = 1,
          py::arg("start_from") = py::none(),
          "What one start of a task leads to: start 0 is the task's own, or `start_from`, the others are\n"
          "random. `task` is the text of a task file and `path` its name in messages.")
      .def("__repr__", &PythonPostureSearch::described)
      .def("names", &PythonPostureSearch::names, py::arg("task"), py::arg("path") = "task",
           "Names of the coordinates of a task's postures; raises Error where the task does not fit.");
}

}  // namespace fcl_stpbv
