// Volumes and their distance in Python.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

#include "bodies.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/io/volume_files.h"
#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/robot/fitted_radii.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/radii_advice.h"
#include "fcl_stpbv/volume/stp_bv.h"
#include "fcl_stpbv/volume/tessellate.h"
#include "made.h"
#include "parts.h"
#include "words.h"

namespace py = pybind11;

namespace fcl_stpbv {
namespace {

/// The answer, and the origins of the bodies' frames. The gradients are about these origins.
struct PlacedDistance : Distance {
  PlacedDistance(const Distance& found, const Eigen::Vector3d& origin1, const Eigen::Vector3d& origin2)
      : Distance(found), origins{origin1, origin2} {}
  std::array<Eigen::Vector3d, 2> origins;
};

/// The over-cover over the hull of points is meaningless if a point is outside of the volume. @throws Error
/// for such a point.
void requireInside(const StpBv& volume, const std::vector<Eigen::Vector3d>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Distance found = distance(volume, Eigen::Isometry3d::Identity(), points[i]);
    const bool unknown = found.status == DistanceStatus::invalid && points[i].allFinite();
    if (unknown || found.lower > 0.0)
      throw Error("points: point " + std::to_string(i) +
                  " is outside the volume; give those that it was built from");
  }
}

}  // namespace
}  // namespace fcl_stpbv

template <>
struct pybind11::detail::type_caster<fcl_stpbv::StpBv> : fcl_stpbv::MadeCaster<fcl_stpbv::StpBv> {};
template <>
struct pybind11::detail::type_caster<fcl_stpbv::Verification>
    : fcl_stpbv::MadeCaster<fcl_stpbv::Verification> {};
template <>
struct pybind11::detail::type_caster<fcl_stpbv::DistanceStatus>
    : fcl_stpbv::MadeCaster<fcl_stpbv::DistanceStatus> {};
template <>
struct pybind11::detail::type_caster<fcl_stpbv::PairCache>
    : fcl_stpbv::MadeCaster<fcl_stpbv::PairCache, true> {};
template <>
struct pybind11::detail::type_caster<fcl_stpbv::PlacedDistance>
    : fcl_stpbv::MadeCaster<fcl_stpbv::PlacedDistance> {};
template <>
struct pybind11::detail::type_caster<fcl_stpbv::RadiiAdvice> : fcl_stpbv::MadeCaster<fcl_stpbv::RadiiAdvice> {
};

namespace fcl_stpbv {
namespace {

/// A pointer to a volume that is not const, because pybind11 has no holder for pointers to const. No bound
/// method changes a volume.
std::shared_ptr<StpBv> held(const StpBv::Ptr& volume) { return std::const_pointer_cast<StpBv>(volume); }

// Makes a pose. A pose that is not finite is accepted, and gives the answer `invalid`.
Eigen::Isometry3d toPose(const Floats<Eigen::Matrix4d>& given, const char* name) {
  const Eigen::Matrix4d& matrix = given.value;
  if (matrix.allFinite() && matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw py::value_error(std::string(name) + ": its last row must be 0 0 0 1");
  Eigen::Isometry3d pose;
  pose.matrix() = matrix;
  if (!matrix.allFinite()) pose.matrix().setConstant(std::numeric_limits<double>::quiet_NaN());
  return pose;
}

PlacedDistance ask(const StpBv& a, const Floats<Eigen::Matrix4d>& poseA, const StpBv& b,
                   const Floats<Eigen::Matrix4d>& poseB, PairCache* cache) {
  const Eigen::Isometry3d first = toPose(poseA, "first_pose"), second = toPose(poseB, "second_pose");
  return {distance(a, first, b, second, cache), first.translation(), second.translation()};
}

Eigen::Vector3d direction(const Floats<Eigen::Vector3d>& given) {
  const Eigen::Vector3d& n = given.value;
  requireFinite(n, "direction");
  const Eigen::Vector3d scaled = n / std::max(n.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
  if (scaled.isZero()) throw Error("direction: is zero, expected a vector of any other length");
  return scaled.normalized();
}

std::string described(double r, double R) { return detail::formatted("r = %.6g m, R = %.6g m", r, R); }

void addStpBv(py::module_& module) {
  py::class_<Verification>(module, "Verification",
                           "Whether a volume is what it should be; its str() says what is not.")
      .def_readonly("ok", &Verification::ok, "whether nothing is off by more than rounding")
      .def_readonly("message", &Verification::message, "\"ok\", or what is wrong")
      .def_readonly("containment", &Verification::containment,
                    "most by which a point given is less than r below the surface (m)")
      .def("__bool__", [](const Verification& found) { return found.ok; })
      .def("__str__", [](const Verification& found) { return found.message; })
      .def("__repr__", [](const Verification& found) { return "<Verification: " + found.message + ">"; });

  py::class_<StpBv, std::shared_ptr<StpBv>>(module, "StpBv", "A volume; immutable. Its own frame.")
      .def_static(
          "build",
          [](const Floats<PointArray>& points, const BodyOptions::Length& r,
             const std::optional<BodyOptions::Length>& R) {
            const std::vector<Eigen::Vector3d> list = toPoints(points.value);
            const GeometryOptions asked = BodyOptions{r, R}.ofAll();
            py::gil_scoped_release others;
            return held(
                StpBv::build(list, detail::withFitted(asked.radii, asked.fitSmallRadius, asked.fitBigRadius,
                                                      [&] { return detail::sizeOf(list); })));
          },
          py::arg("points"), py::arg("r") = 0.01, py::arg("R") = py::none(),
          "Volume around an (n, 3) array of points; raises Error naming what would work. r, R: lengths (m), "
          "or\n"
          "\"auto\", by which they fit the points; R is 10 unless given, or auto where r is.")
      .def_static(
          "load", [](const Path& path) { return held(loadStpBv(path.string())); }, py::arg("path"),
          "Reads a .stpbv file; raises Error naming it.")
      .def(
          "save", [](const StpBv& volume, const Path& path) { saveStpBv(path.string(), volume); },
          py::arg("path"), "Writes a .stpbv file, whole or not at all.")
      .def_property_readonly(
          "r", [](const StpBv& volume) { return volume.radii().r; }, "Radius of the small spheres (m).")
      .def_property_readonly(
          "R", [](const StpBv& volume) { return volume.radii().R; }, "Radius of the big spheres (m).")
      .def_property_readonly(
          "vertices", [](const StpBv& volume) { return toArray(volume.vertices()); },
          "(n, 3), m, in the volume's own frame.")
      .def_property_readonly(
          "faces", [](const StpBv& volume) { return volume.faces(); },
          "Lists of vertex indices, counter-clockwise seen from outside.")
      .def(
          "support",
          [](const StpBv& volume, const Floats<Eigen::Vector3d>& n) { return volume.support(direction(n)); },
          py::arg("direction"),
          "Height of the supporting plane with this outward normal above the own frame's origin (m).")
      .def(
          "surface_point",
          [](const StpBv& volume, const Floats<Eigen::Vector3d>& n) {
            return volume.surfacePoint(direction(n));
          },
          py::arg("direction"), "The surface point with this outward normal.")
      .def(
          "signed_distance",
          [](const StpBv& volume, const Floats<Eigen::Vector3d>& point) {
            requireFinite(point.value, "point");
            return signedDistance(volume, point.value);
          },
          py::arg("point"), "Of a point of the volume's own frame from its surface (m), negative inside.")
      .def(
          "over_cover",
          [](const StpBv& volume, const std::optional<Floats<PointArray>>& points) {
            const std::vector<Eigen::Vector3d> cloud = points ? toPoints(points->value) : volume.vertices();
            if (points) requireInside(volume, cloud);
            const OverCover cover = overCover(volume, cloud);
            return std::make_pair(cover.max, cover.mean);
          },
          py::arg("points") = py::none(),
          "Largest and mean excess (m) over the convex hull of the vertices, or of the points it was built "
          "from; Error where one of them is outside.")
      .def(
          "verify",
          [](const StpBv& volume, const std::optional<Floats<PointArray>>& points) {
            return verify(volume, points ? toPoints(points->value) : std::vector<Eigen::Vector3d>());
          },
          py::arg("points") = py::none(),
          "A Verification of the volume against its own definition, and of points that must be r below its "
          "surface; false where something is wrong.")
      .def(py::pickle(
          [](const StpBv& volume) {
            std::ostringstream out;
            saveStpBv(out, volume);
            return py::bytes(out.str());
          },
          [](const py::bytes& state) {
            std::istringstream in(state);
            return held(loadStpBv(in, "pickled StpBv"));
          }))
      .def("__repr__", [](const StpBv& volume) {
        return "<StpBv: " + std::to_string(volume.vertexCount()) + " vertices, " +
               std::to_string(volume.faceCount()) + " faces, " +
               described(volume.radii().r, volume.radii().R) + ">";
      });
}

void addDistance(py::module_& module) {
  py::enum_<DistanceStatus>(module, "Status")
      .value("exact", DistanceStatus::exact,
             "to rounding: apart, touching, or overlapping by at most r1 + r2")
      .value("local", DistanceStatus::local,
             "deeper: a locally best way out; the true value is in [lower, upper]")
      .value("bounded", DistanceStatus::bounded,
             "not solved to rounding; the true value is in [lower, upper]")
      .value("invalid", DistanceStatus::invalid, "a pose is not a finite rotation and translation");

  py::class_<PairCache>(module, "PairCache", "Starts a pair's next query near its last answer.")
      .def(py::init<>());

  py::class_<PlacedDistance>(module, "Distance", "Answer to a query. World frame.")
      .def_readonly("status", &PlacedDistance::status)
      .def_readonly("distance", &PlacedDistance::distance, "signed (m); minus infinity for Status.invalid")
      .def_readonly("lower", &PlacedDistance::lower, "certified")
      .def_readonly("upper", &PlacedDistance::upper, "certified")
      .def_readonly("normal", &PlacedDistance::normal, "unit, from the first body to the second")
      .def_property_readonly(
          "points",
          [](const PlacedDistance& d) {
            Eigen::Matrix<double, 2, 3, Eigen::RowMajor> points;
            points << d.point[0].transpose(), d.point[1].transpose();
            return points;
          },
          "(2, 3): witness points on the two surfaces")
      .def_property_readonly(
          "gradient",
          [](const PlacedDistance& d) {
            Eigen::Matrix<double, 2, 6, Eigen::RowMajor> gradient;
            gradient << d.gradient(0, d.origins[0]).transpose(), d.gradient(1, d.origins[1]).transpose();
            return gradient;
          },
          "(2, 6): derivative with each body's twist [linear; angular] about its frame's origin, world axes")
      .def("__repr__", [](const PlacedDistance& d) {
        return py::str("<Distance: {} m, {}>").format(d.distance, py::cast(d.status).attr("name"));
      });

  module.def("distance", &ask, py::arg("first"), py::arg("first_pose"), py::arg("second"),
             py::arg("second_pose"), py::arg("cache") = static_cast<PairCache*>(nullptr),
             "Signed distance of two volumes at 4x4 poses. Poses that are no rigid motion give "
             "Status.invalid; a last\n"
             "row other than 0 0 0 1 raises ValueError.");
}

void addAdvice(py::module_& module) {
  py::class_<RadiiAdvice>(module, "RadiiAdvice",
                          "r and R from clearance and acceleration, and what they reach.")
      .def_property_readonly("r", [](const RadiiAdvice& advice) { return advice.radii.r; })
      .def_property_readonly("R", [](const RadiiAdvice& advice) { return advice.radii.R; })
      .def_readonly("meets_both", &RadiiAdvice::meetsBoth, "whether both promises are kept")
      .def_readonly("acceleration", &RadiiAdvice::acceleration, "most that the shapes add to d'' (m/s^2)")
      .def_readonly("over_cover", &RadiiAdvice::overCover, "of the volume of these radii (m)")
      .def_readonly("per_period", &RadiiAdvice::perPeriod,
                    "most that d falls below a linear row in a period (m)")
      .def_readonly("least_clearance", &RadiiAdvice::leastClearance, "for the stated acceleration (m)")
      .def("__repr__", [](const RadiiAdvice& advice) {
        std::string kept = "meets both demands";
        if (!advice.meetsBoth)
          kept = detail::formatted("keeps the clearance, but may add %.4g m/s^2", advice.acceleration);
        if (!advice.meetsBoth && std::isfinite(advice.leastClearance))
          kept += detail::formatted("; that asked for needs %.4g m", advice.leastClearance);
        return "<RadiiAdvice: " + described(advice.radii.r, advice.radii.R) + ", " + kept + ">";
      });
  const RadiiTask usual;
  module.def(
      "advise_radii",
      [](const Floats<PointArray>& points, double clearance, double acceleration, double speed,
         double turning, double period, double distance, bool bothRound) {
        const std::vector<Eigen::Vector3d> list = toPoints(points.value);
        py::gil_scoped_release others;
        return inPythonsWords([&] {
          return adviseRadii(list, {clearance, acceleration, speed, turning, period, distance, bothRound});
        });
      },
      py::arg("points"), py::kw_only(), py::arg("clearance") = usual.clearance,
      py::arg("acceleration") = usual.acceleration, py::arg("speed") = usual.speed,
      py::arg("turning") = usual.turning, py::arg("period") = usual.period,
      py::arg("distance") = usual.distance, py::arg("both_round") = usual.bothRound,
      "r and R for a body near others: m, m/s^2, m/s, rad/s, s, m.");
}

}  // namespace

void addVolume(py::module_& module) {
  addStpBv(module);
  addDistance(module);
  addAdvice(module);
  module.def(
      "load_points", [](const Path& path) { return toArray(loadPoints(path.string())); }, py::arg("path"),
      "(n, 3) array: the points of a mesh, of a qhull file or of a text with three coordinates a line.");
}

}  // namespace fcl_stpbv
