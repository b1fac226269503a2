// See page.h. Bodies are drawn as the outlines of their volumes, seen along the y axis.
#include "page.h"

#include <cstdio>

#include "fcl_stpbv/report/outline.h"
#include "fcl_stpbv/volume/convex_polygon.h"

namespace example {

using namespace fcl_stpbv;
using Eigen::Vector2d;

namespace {

constexpr double kScale = 400;  // pixels a metre
constexpr int kWidth = 580, kHeight = 655;

std::string polygonOf(const fcl::CollisionGeometryd& geometry, const Eigen::Isometry3d& pose,
                      const std::string& style) {
  std::vector<Vector2d> seen;
  for (const Eigen::Vector3d& p : report::outline(geometry, 2e-3, 60).vertices) {
    const Eigen::Vector3d w = pose * p;
    seen.push_back({200 + kScale * w.x(), kHeight - 20 - kScale * w.z()});
  }
  if (seen.size() < 3) return "";
  std::string text = "<polygon points=\"";
  for (const int corner : detail::convexPolygon(seen)) {
    const Vector2d& p = seen[static_cast<std::size_t>(corner)];
    char point[40];
    std::snprintf(point, sizeof point, "%.1f,%.1f ", p.x(), p.y());
    text += point;
  }
  return text + "\" style=\"" + style + "\"/>\n";
}

std::string robotAt(const Scene& scene, const Eigen::VectorXd& q, const std::string& style) {
  Kinematics::State state = scene.kinematics->makeState();
  scene.kinematics->forward(q, state);
  std::string text;
  for (const Body& body : scene.smooth->bodies)
    text += polygonOf(*body.geometry, state.link[static_cast<std::size_t>(body.link)] * body.pose, style);
  return text;
}

}  // namespace

std::string pageOf(const Scene& scene, const report::TrajectoryReport& followed, const std::string& figures) {
  std::string picture = "<svg viewBox=\"0 0 " + std::to_string(kWidth) + " " + std::to_string(kHeight) +
                        "\" style=\"max-width:" + std::to_string(kWidth) +
                        "px\" role=\"img\" aria-label=\"the robot along its way\">\n";
  for (const Obstacle& obstacle : scene.obstacles)
    picture += polygonOf(*obstacle.geometry, obstacle.pose, "fill:#d9a441;fill-opacity:0.35;stroke:#8a6410");
  constexpr int kDrawn = 7;
  const double last = followed.trajectory.time.back();
  for (int i = 0; i < kDrawn; ++i) {
    picture += robotAt(scene, followed.at(last * i / (kDrawn - 1)),
                       i == 0            ? "fill:#b0528f;fill-opacity:0.25;stroke:#7a2e60"
                       : i == kDrawn - 1 ? "fill:#3b6ea8;fill-opacity:0.25;stroke:#24476e"
                                         : "fill:none;stroke:#3b6ea8;stroke-opacity:0.35");
  }
  return "<!DOCTYPE html>\n<html lang=\"en\"><meta charset=\"utf-8\"><meta name=\"viewport\" "
         "content=\"width=device-width\"><title>A planned way to the can</title>\n"
         "<style>body{font:15px sans-serif;max-width:60em;margin:2em auto;padding:0 1em}svg{width:100%}"
         "pre{white-space:pre-wrap}</style>\n<h1>A planned way to the can</h1>\n<pre>" +
         figures +
         "</pre>\n<h2>From the side</h2>\n<p>Magenta: the start. Blue: the end, with the hand around the "
         "can. "
         "Outlines: five times in between. Yellow: the fridge.</p>\n" +
         picture + "</svg>\n<h2>Least distance of all pairs along the way</h2>\n" +
         report::chartOf(followed, 0) + "</html>\n";
}

}  // namespace example
