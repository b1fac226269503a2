// The sliding motions of docs/motion.md: cost of the proof of a motion near a mesh or a tree, down to 1 um of
// clearance. Usage: slide_figures
#include <fcl/config.h>
#include <fcl/geometry/shape/box.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/adapter/continuous_collide.h"
#include "test/reference/arguments.h"
#include "test/reference/fcl_bodies.h"
#include "tools/bench/measurement.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;
using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

namespace {

#if FCL_HAVE_OCTOMAP
/// A floor of cells of 5 cm whose top is at 0, and a wall along it, beside y = 0.5.
Geometry floorAndWall() {
  const auto cells = std::make_shared<octomap::OcTree>(0.05);
  for (int i = -24; i < 24; ++i)
    for (int j = 0; j < 24; ++j) {
      const auto at = [](int k) { return static_cast<float>(0.05 * (k + 0.5)); };
      for (const int k : {j, -1 - j}) cells->updateNode(octomap::point3d(at(i), at(k), at(-1)), true);
      cells->updateNode(octomap::point3d(at(i), at(10), at(j)), true);
    }
  return std::make_shared<fcl::OcTreed>(cells);
}
#endif

struct Body {
  std::string name;
  Geometry geometry;
  double low;  ///< how far the body reaches below its frame's origin (m)
};

/// A motion of 0.8 m with `room` (m) above the height `top` (m), turned by `turn` (rad) about the vertical.
SteadyMotion over(const Body& body, double top, double room, double turn) {
  SteadyMotion motion;
  motion.begin.translation() = Vector3d(-0.4, 0.02, top + body.low + room);
  motion.linear = Vector3d(0.8, 0.1, 0);
  motion.angular = Vector3d(0, 0, turn);
  return motion;
}

std::string figures(const Geometry& surface, const Body& body, const SteadyMotion& motion) {
  std::vector<double> times;
  MotionAnswer answer;
  for (int i = 0; i < 21; ++i) {
    const double start = benchmark::threadTime();
    answer = firstContact(*surface, {}, *body.geometry, motion);
    times.push_back(benchmark::threadTime() - start);
  }
  if (answer.verdict != MotionVerdict::free) return "not free";
  return std::to_string(answer.queries) + ", " +
         benchmark::shown(benchmark::significant(1e-6 * benchmark::median(times), 2)) + " ms";
}

}  // namespace

int main(int argc, char** argv) {
  const Arguments arguments(argc, argv, "", 0);
  struct Surface {
    std::string name;
    Geometry geometry;
    double top;  // m
  };
  std::vector<Surface> surfaces{{"flat mesh, 200 triangles", bumpyGround<fcl::OBBRSSd>(10, 0), 0},
                                {"bumpy mesh, 7200 triangles", bumpyGround<fcl::OBBRSSd>(60, 0.02), 0.02}};
#if FCL_HAVE_OCTOMAP
  surfaces.push_back({"octree, a wall beside", floorAndWall(), 0});
#endif
  const auto volume = std::make_shared<StpBvGeometry>(StpBv::build(box(0.1, 0.08, 0.06), {0.01, 10}));
  const std::vector<Body> bodies{{"box", std::make_shared<fcl::Boxd>(0.1, 0.08, 0.06), 0.03},
                                 {"STP-BV", volume, volume->volume().support(-Vector3d::UnitZ())}};
  std::printf("| over | body | turn | 1 mm of clearance | 10 µm | 1 µm |\n|---|---|---|---|---|---|\n");
  for (const Surface& surface : surfaces)
    for (const Body& body : bodies)
      for (const double turn : {0.0, 1.0}) {
        std::printf("| %s | %s | %s |", surface.name.c_str(), body.name.c_str(), turn > 0 ? "1 rad" : "none");
        for (const double room : {1e-3, 1e-5, 1e-6})
          std::printf(" %s |", figures(surface.geometry, body, over(body, surface.top, room, turn)).c_str());
        std::printf("\n");
      }
}
