// shape_differences [POSES]: the table of docs/fcl_differences.md. A sphere is both an FCL shape and the
// STP-BV of one point, so plain FCL and this library answer about the very same bodies.
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "test/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

int main(int argc, char** argv) {
  const int poses = argc > 1 ? std::atoi(argv[1]) : 2000;
  const fcl::Sphered ball(0.1);
  const StpBvGeometry point(StpBv::build({{0, 0, 0}}, {0.1, 10}));
  const std::vector<std::pair<const char*, std::shared_ptr<fcl::CollisionGeometryd>>> shapes{
      {"sphere", std::make_shared<fcl::Sphered>(0.2)},
      {"capsule", std::make_shared<fcl::Capsuled>(0.1, 0.4)},
      {"box", std::make_shared<fcl::Boxd>(0.3, 0.2, 0.1)},
      {"cylinder", std::make_shared<fcl::Cylinderd>(0.2, 0.3)},
      {"cone", std::make_shared<fcl::Coned>(0.2, 0.3)},
      {"ellipsoid", std::make_shared<fcl::Ellipsoidd>(0.1, 0.2, 0.3)}};
  std::printf(
      "| shape | tolerance | over 1e-6 m | worst (m) | throws | -1 apart | bad points | worst at |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (const auto& [name, shape] : shapes)
    for (const double tolerance : {1e-6, 1e-10}) {
      Random random(1);
      int wrong = 0, thrown = 0, lost = 0, garbage = 0;
      double worst = 0;
      Eigen::Vector3d where(0, 0, 0);
      for (int i = 0; i < poses; ++i) {
        const Eigen::Isometry3d here = pose(random.rotation(), {0, 0, 0});
        const Eigen::Isometry3d there =
            pose(Eigen::Matrix3d::Identity(), random.uniform(0.3, 1.0) * random.direction());
        const DistanceAnswer truth = distance(*shape, here, point, there);
        if (truth.distance < 1e-3) continue;
        const fcl::DistanceRequestd request(true, false, 0.0, 0.0, tolerance, fcl::GST_LIBCCD);
        fcl::DistanceResultd result;
        try {
          fcl::distance(shape.get(), here, &ball, there, request, result);
        } catch (...) {
          ++thrown;
          continue;
        }
        if (result.min_distance < 0) {
          ++lost;
          continue;
        }
        const double error = std::abs(result.min_distance - truth.distance);
        wrong += error > 1e-6;
        if (error > worst) {
          worst = error;
          where = here.linear().transpose() * there.translation();
        }
        const double span = (result.nearest_points[0] - result.nearest_points[1]).norm();
        garbage += !(std::abs(span - result.min_distance) <= 1e-6);
      }
      std::printf("| %s | %.0e | %d | %.1e | %d | %d | %d | (%.6g, %.6g, %.6g) |\n", name, tolerance, wrong,
                  worst, thrown, lost, garbage, where.x(), where.y(), where.z());
    }
  return 0;
}
