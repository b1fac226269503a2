// The Python class Robot.
#include "robot.h"

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fcl_stpbv {

void addRobot(py::module_& module) {
  py::class_<PythonRobot> robotClass(module, "Robot",
                                     "Distances d(q) and Jacobian J(q) of a robot's pairs of bodies.");
  robotClass
      .def(
          py::init([](const Path& urdf, const std::optional<Path>& srdf, const std::optional<Path>& obstacles,
                      const BodyOptions::Length& r, const std::optional<BodyOptions::Length>& R,
                      const BodyOptions::OfLinks& links, const BodyOptions::Names& flat,
                      const std::string& base, const Folders& packagePath, double influence,
                      std::optional<double> exactUpTo, double handOver, bool measureMeshes) {
            return std::make_unique<PythonRobot>(urdf, srdf, obstacles, BodyOptions{r, R, links, flat}, base,
                                                 packagePath, influence, exactUpTo, handOver, measureMeshes);
          }),
          py::arg("urdf"), py::arg("srdf") = py::none(), py::arg("obstacles") = py::none(), py::kw_only(),
          py::arg("r") = 0.01, py::arg("R") = py::none(), py::arg("links") = BodyOptions::OfLinks{},
          py::arg("flat") = std::vector<std::string>{}, py::arg("base") = "fixed",
          py::arg("package_path") = Folders{}, py::arg("influence") = std::numeric_limits<double>::infinity(),
          py::arg("exact_up_to") = py::none(), py::arg("hand_over") = std::numeric_limits<double>::infinity(),
          py::arg("measure_meshes") = false,
          "Loads a URDF, and the bodies of another one as obstacles. Pairs that the SRDF disables (without\n"
          "one, adjacent and rigid links) are left out. r, R: of all volumes (m), or \"auto\", by which "
          "they\n"
          "fit each link; R is 10 unless given, or auto where r is. links: (r, R) of single links by name, "
          "or\n"
          "(r, R, over-cover). flat: links whose meshes stay convex polyhedra, and \"obstacles\". base:\n"
          "\"fixed\", \"planar\" or \"floating\". package_path: a folder, or several, for package:// names.\n"
          "influence: farther pairs are constant (m); a row is its distance up to exact_up_to (m), half of\n"
          "influence unless given, and then goes over smoothly to a constant. hand_over: links farther\n"
          "apart than this (m) are one row, nearer ones a row for each pair of their parts (model_for).\n"
          "measure_meshes: each RowAnswer bounds the distance of the meshes (mesh_distance_most); loading\n"
          "takes about a tenth of a second longer for each mesh.")
      .def("model_for", &PythonRobot::modelFor, py::arg("needs"), py::kw_only(),
           py::arg("budgets") = std::vector<double>{}, py::arg("threads") = 1,
           "(a Robot as fine as the needs ask for, indices of the needs that no bodies meet).\n"
           "A need: (link, link or obstacle, q, clearance in m that their distance is to exceed at q).\n"
           "budgets: coarser volumes to start from may exceed the hulls by each of these (m, falling).")
      .def_property_readonly(
          "warnings", [](const PythonRobot& robot) { return decoded(robot.warnings()); },
          "What loading warned of, which it also raised as UserWarnings: whole sentences.")
      .def_property_readonly("vertices", &PythonRobot::vertices, "of all volumes that its rows ask")
      .def_property_readonly(
          "names", [](const PythonRobot& robot) { return robot.kinematics().names(); }, "of the coordinates")
      .def_property_readonly("rows", &PythonRobot::rowNames, "names of the pairs, in the order of d")
      .def_property_readonly(
          "exact_up_to", &PythonRobot::exactUpTo,
          "Up to where each row is its distance (m); then it goes over smoothly to a constant.")
      .def_property_readonly(
          "lower", [](const PythonRobot& robot) { return robot.kinematics().lower(); },
          "Least coordinates (m or rad), in the order of names; -inf where there is no limit.")
      .def_property_readonly(
          "upper", [](const PythonRobot& robot) { return robot.kinematics().upper(); },
          "Largest coordinates, likewise; inf where there is no limit.")
      .def_property_readonly(
          "neutral", [](const PythonRobot& robot) { return robot.kinematics().neutral(); },
          "The coordinates nearest to 0 within the limits (m or rad).")
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
  robotClass.def("__repr__", &PythonRobot::described);
  addDampers(module, robotClass);
  addMotions(module, robotClass);
}

}  // namespace fcl_stpbv
