// See loading.h.
#include "loading.h"

#include <algorithm>

#include "fcl_stpbv/robot/load_warnings.h"

namespace py = pybind11;

namespace fcl_stpbv {
namespace {

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

RobotModel loaded(const Path& urdf, std::vector<std::string>& warnings) {
  LoadFaults faults;
  RobotModel model = loadUrdf(urdf.string(), faults);
  faults.refuse();
  append(warnings, faults.warnings);
  return model;
}

}  // namespace

RobotModel Loading::robot(const Path& urdf) {
  RobotModel model = loaded(urdf, warnings);
  append(warnings, detail::stillJoints(model));
  return model;
}

RobotModel Loading::obstacles(const Path& urdf) {
  RobotModel model = loaded(urdf, warnings);
  append(warnings, detail::stillObstacles(model));
  return model;
}

Srdf Loading::srdf(const Path& path, const RobotModel& robot) {
  Srdf srdf = loadSrdf(path.string(), robot);
  append(warnings, srdf.warnings);
  return srdf;
}

RobotGeometry Loading::geometry(const RobotModel& robot, const GeometryOptions& options) {
  RobotGeometry geometry = loadGeometry(robot, options);
  append(warnings, geometry.warnings);
  return geometry;
}

void Loading::warnOfR(const RobotModel& robot, const RobotGeometry& covered, const GeometryOptions& options) {
  append(warnings, detail::raisedR(robot, covered, options, "give a larger R"));
}

void Loading::warnOfPairs(const RobotModel& robot, const RobotGeometry& geometry, const Srdf& srdf) {
  append(warnings, detail::leavesOutNone(robot, geometry, srdf));
}

std::vector<std::string> warningsOfModel(const RobotModel& robot, const RobotGeometry& geometry,
                                         const std::vector<std::string>& known) {
  std::vector<std::string> all = geometry.warnings, fresh;
  const std::string open = detail::openParts(geometry);
  if (!open.empty()) all.push_back(robot.path + ": " + open);
  for (const std::string& warning : all)
    if (std::find(known.begin(), known.end(), warning) == known.end()) fresh.push_back(warning);
  return fresh;
}

void warn(const std::vector<std::string>& warnings) {
  const py::object warn = py::module_::import("warnings").attr("warn");
  for (const std::string& warning : warnings)
    warn(decoded(warning), py::reinterpret_borrow<py::object>(PyExc_UserWarning));
}

py::str decoded(const std::string& text) {
  auto decoded = py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "surrogateescape"));
  if (!decoded) throw py::error_already_set();
  return decoded;
}

py::list decoded(const std::vector<std::string>& texts) {
  py::list list;
  for (const std::string& text : texts) list.append(decoded(text));
  return list;
}

}  // namespace fcl_stpbv
