// See page.h. Bodies are drawn as the outlines of their volumes, seen along the y axis.
#include "page.h"

#include <cstdio>

#include "docs/examples/page_head.h"
#include "fcl_stpbv/report/outline.h"
#include "fcl_stpbv/volume/convex_polygon.h"

namespace example {

using namespace fcl_stpbv;
using Eigen::Vector2d;

namespace {

constexpr double kScale = 400;  // pixels per metre
constexpr int kWidth = 580, kHeight = 655;

// How the bodies look; the colours are those of pageHead.
constexpr const char* kStyle =
    ".wide svg{min-width:800px}.side svg{min-width:330px;max-width:580px}\n"
    ".thing{fill:var(--thing);fill-opacity:.2;stroke:var(--thing)}\n"
    ".start{fill:var(--start);fill-opacity:.3;stroke:var(--start)}\n"
    ".between{fill:none;stroke:var(--smooth);stroke-opacity:.6}\n"
    ".end{fill:var(--smooth);fill-opacity:.3;stroke:var(--smooth)}\n";

std::string polygonOf(const fcl::CollisionGeometryd& geometry, const Eigen::Isometry3d& pose,
                      const std::string& look) {
  std::vector<Vector2d> seen;
  for (const Eigen::Vector3d& p : report::outline(geometry, 2e-3, 60).vertices) {
    const Eigen::Vector3d w = pose * p;
    seen.push_back({200 + kScale * w.x(), kHeight - 20 - kScale * w.z()});
  }
  if (seen.size() < 3) return "";
  std::string text = "<polygon class=\"" + look + "\" points=\"";
  for (const int corner : detail::convexPolygon(seen)) {
    const Vector2d& p = seen[static_cast<std::size_t>(corner)];
    char point[40];
    std::snprintf(point, sizeof point, "%.1f,%.1f ", p.x(), p.y());
    text += point;
  }
  return text + "\"/>\n";
}

/// All bodies; with `moved` only those that are elsewhere there.
std::string robotAt(const Scene& scene, const Eigen::VectorXd& q, const std::string& look,
                    const Eigen::VectorXd* moved = nullptr) {
  Kinematics::State state = scene.kinematics->makeState(), other = scene.kinematics->makeState();
  scene.kinematics->forward(q, state);
  scene.kinematics->forward(moved ? *moved : q, other);
  std::string text;
  for (const Body& body : scene.smooth->bodies) {
    const auto link = static_cast<std::size_t>(body.link);
    constexpr double kSame = 1e-9;  // of what did not move, above all rounding
    if (moved && state.link[link].isApprox(other.link[link], kSame)) continue;
    text += polygonOf(*body.geometry, state.link[link] * body.pose, look);
  }
  return text;
}

std::string tableOf(const std::vector<std::vector<std::string>>& rows) {
  std::string text = "<div class=\"chart\"><table>\n";
  for (const auto& row : rows) {
    const std::string cell = &row == rows.data() ? "th" : "td";
    text += "<tr>";
    for (const std::string& words : row) text += "<" + cell + ">" + words + "</" + cell + ">";
    text += "</tr>\n";
  }
  return text + "</table></div>\n";
}

}  // namespace

std::string pageOf(const Scene& scene, const report::TrajectoryReport& followed, const Findings& findings) {
  std::string picture = "<svg viewBox=\"0 0 " + std::to_string(kWidth) + " " + std::to_string(kHeight) +
                        "\" role=\"img\" aria-label=\"the robot along its way\">\n";
  for (const Obstacle& obstacle : scene.obstacles)
    picture += polygonOf(*obstacle.geometry(), obstacle.pose(), "thing");
  const double last = followed.trajectory.time.back();
  const Eigen::VectorXd start = followed.at(0), end = followed.at(last);
  picture += robotAt(scene, start, "start", &end) + robotAt(scene, followed.at(0.5 * last), "between", &end) +
             robotAt(scene, end, "end");
  return pageHead(findings.verdict, kStyle) + "<p>" + findings.about + "</p>\n" + tableOf(findings.table) +
         "<h2>From the side</h2>\n<p>Magenta: the start, where it differs from the end. "
         "Outlines: half of the way. Blue: the end, with the hand around the can. Yellow: the fridge.</p>\n"
         "<div class=\"chart side\">" +
         picture +
         "</svg></div>\n<h2>Least distance of all pairs along the way</h2>\n<div class=\"chart wide\">" +
         report::chartOf(followed, 0) + "</div></html>\n";
}

}  // namespace example
