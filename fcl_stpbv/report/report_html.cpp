// The page's data; see report_formats.h and report_page.h.
#include <fcl/geometry/shape/convex.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/report/report_formats.h"
#include "fcl_stpbv/report/report_page.h"
#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::report {
namespace {

using nlohmann::json;

// Coarse: a page with thirty links stays below a few megabytes and turns smoothly.
constexpr double kAngle = 0.7;
// Margin that a primitive is drawn with (m).
constexpr double kPrimitiveRadius = 1e-3;

double rounded(double value) { return std::round(value * 1e5) / 1e5; }

// What FCL's shapes look like, near enough for a picture: the hull of points of their surface.
std::vector<Eigen::Vector3d> pointsOf(const fcl::CollisionGeometryd& geometry) {
  const Eigen::Vector3d half = (geometry.aabb_local.max_ - geometry.aabb_local.min_) / 2;
  std::vector<Eigen::Vector3d> points;
  if (geometry.getNodeType() == fcl::GEOM_CONVEX)
    return static_cast<const fcl::Convexd&>(geometry).getVertices();
  const bool round = geometry.getNodeType() != fcl::GEOM_BOX;
  constexpr int kSides = 12;
  for (int i = 0; i < (round ? kSides : 4); ++i) {
    const double angle = round ? 2 * M_PI * i / kSides : M_PI / 4 + M_PI / 2 * i;
    const double x = round ? std::cos(angle) : std::copysign(1.0, std::cos(angle));
    const double y = round ? std::sin(angle) : std::copysign(1.0, std::sin(angle));
    const bool tapered =
        geometry.getNodeType() == fcl::GEOM_SPHERE || geometry.getNodeType() == fcl::GEOM_CAPSULE;
    for (double z : {-1.0, -0.7, 0.7, 1.0}) {
      const double width = tapered && std::abs(z) == 1.0 ? 0.4 : 1.0;
      points.emplace_back(half.x() * x * width, half.y() * y * width, half.z() * z);
    }
  }
  return points;
}

json shapeOf(const std::string& name, const fcl::CollisionGeometryd& geometry, bool obstacle) {
  const StpBvGeometry* smooth = asStpBv(&geometry);
  const StpBv::Ptr primitive =
      smooth ? nullptr
             : StpBv::build(pointsOf(geometry), {kPrimitiveRadius, 10 + 100 * geometry.aabb_radius});
  const TriangleMesh mesh = tessellate(smooth ? smooth->volume() : *primitive, kAngle);
  json shape{{"name", name}, {"obstacle", obstacle}, {"v", json::array()}, {"t", json::array()}};
  for (const Eigen::Vector3d& v : mesh.vertices)
    shape["v"].push_back({rounded(v.x()), rounded(v.y()), rounded(v.z())});
  for (const auto& t : mesh.triangles) shape["t"].push_back(t);
  return shape;
}

json rowsOf(const Eigen::Isometry3d& pose) {
  json rows = json::array();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 4; ++k) rows.push_back(rounded(pose(i, k)));
  return rows;
}

// Poses of all bodies and obstacles at a configuration.
json posesAt(const CollisionReport& report, const Eigen::VectorXd& q) {
  Kinematics::State state = report.kinematics->makeState();
  report.kinematics->forward(q, state);
  json poses = json::array();
  for (const Body& body : report.geometry->bodies)
    poses.push_back(rowsOf(state.link[static_cast<std::size_t>(body.link)] * body.pose));
  for (const Obstacle& obstacle : report.obstacles) poses.push_back(rowsOf(obstacle.pose));
  return poses;
}

// "</script>" in a name must not end the script.
std::string inScript(std::string text) {
  for (std::size_t i = text.find('<'); i != std::string::npos; i = text.find('<', i))
    text.replace(i, 1, "\\u003c");
  return text;
}

}  // namespace

std::string toHtml(const CollisionReport& report, const std::string& title) {
  json data = json::parse(toJson(report));
  data["title"] = title;
  data["bodies"] = json::array();
  for (const Body& body : report.geometry->bodies)
    data["bodies"].push_back(shapeOf(body.name, *body.geometry, false));
  for (const Obstacle& obstacle : report.obstacles)
    data["bodies"].push_back(shapeOf(obstacle.name, *obstacle.geometry, true));
  data["poses"] = json::array();
  std::vector<Eigen::VectorXd> known;
  for (std::size_t i = 0; i < report.pairs.size(); ++i) {
    const PairReport& pair = report.pairs[i];
    const auto found = std::find(known.begin(), known.end(), pair.configuration);
    json& item = data["pairs"][i];
    item["pose"] = found - known.begin();
    item["body1"] = pair.body1;
    item["body2"] = pair.body2;
    item["cover"] = pair.overCover1 + pair.overCover2;
    item.erase("closest");
    if (found != known.end()) continue;
    known.push_back(pair.configuration);
    data["poses"].push_back(posesAt(report, pair.configuration));
  }
  return kPageHead + inScript(data.dump(-1, ' ', false, json::error_handler_t::replace)) + kPageTail;
}

}  // namespace fcl_stpbv::report
