// Moves one link through a course of FCL's shapes and a mesh, and prints signed distance, witness points and
// the obstacle's part.
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "docs/examples/reported.h"
#include "fcl_stpbv/adapter/fcl_distance.h"

namespace {

int run() {
  using Eigen::Vector3d;
  const std::vector<Vector3d> corners{
      {-0.1, -0.05, -0.05}, {0.1, -0.05, -0.05}, {0, 0.1, -0.05}, {0, 0, 0.1}};
  const fcl_stpbv::StpBvGeometry link(fcl_stpbv::StpBv::build(corners, {0.01, 5.0}));

  const auto mesh = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  fcl::generateBVHModel(*mesh, fcl::Boxd(0.3, 0.3, 0.3), fcl::Transform3d::Identity());
  const std::vector<std::pair<std::string, std::shared_ptr<fcl::CollisionGeometryd>>> course{
      {"sphere", std::make_shared<fcl::Sphered>(0.2)},
      {"capsule", std::make_shared<fcl::Capsuled>(0.1, 0.4)},
      {"ellipsoid", std::make_shared<fcl::Ellipsoidd>(0.1, 0.2, 0.3)},
      {"box", std::make_shared<fcl::Boxd>(0.3, 0.3, 0.3)},
      {"cylinder", std::make_shared<fcl::Cylinderd>(0.2, 0.3)},
      {"cone", std::make_shared<fcl::Coned>(0.2, 0.3)},
      {"triangle",
       std::make_shared<fcl::TrianglePd>(Vector3d(0, -1, -1), Vector3d(0, 1, -1), Vector3d(0, 0, 1))},
      {"plane", std::make_shared<fcl::Planed>(Vector3d(1, 0, 0), 0.0)},
      {"half space", std::make_shared<fcl::Halfspaced>(Vector3d(-1, 0, 0), 0.0)},
      {"mesh", mesh}};

  bool good = true;
  for (const auto& [name, obstacle] : course) {
    double last = 0;
    for (int i = 0; i <= 100; ++i) {  // from 1.5 m to 0.5 m in front of the obstacle
      fcl::Transform3d at = fcl::Transform3d::Identity();
      at.translation().x() = -1.5 + 0.01 * i;
      const auto answer = fcl_stpbv::distance(link, at, *obstacle, fcl::Transform3d::Identity());
      good = good && answer.status == fcl_stpbv::DistanceStatus::exact &&
             (i == 0 || std::abs(answer.distance - last) <= 0.01 + 1e-12);
      last = answer.distance;
      if (i == 100)
        std::printf("%-10s distance %8.5f m, slope along x %7.4f, part %ld\n", name.c_str(), answer.distance,
                    answer.gradient[0][0], static_cast<long>(answer.element[1]));
    }
  }
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) { return reported(argc, argv, run); }
