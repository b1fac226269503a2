// The README's ten lines with two boxes, and the second derivatives of docs/fcl.md.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>

#include <cstdio>

#include "docs/examples/reported.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_hessian.h"

namespace {

int run() {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 8; ++i) points.emplace_back(i & 1 ? 0.1 : -0.1, i & 2 ? 0.1 : -0.1, i & 4 ? 0.1 : -0.1);
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.translation() = Eigen::Vector3d(0.5, 0, 0);

  // clang-format off
auto volume = fcl_stpbv::StpBv::build(points, {0.01, 10.0});    // r, R in m; or loadStpBv("link.stpbv")
auto link   = std::make_shared<fcl_stpbv::StpBvGeometry>(volume);  // is an fcl::Convex<double>
fcl::CollisionObjectd object(link, pose);                          // any FCL code takes it
  // clang-format on

  fcl::CollisionObjectd other(link, fcl::Transform3d::Identity());
  fcl::DynamicAABBTreeCollisionManagerd manager;
  manager.registerObjects({&object, &other});
  manager.setup();

  // clang-format off
fcl_stpbv::DistanceData data;
manager.distance(&data, fcl_stpbv::distanceCallback);              // instead of FCL's own callback
// data.result.distance, .normal, .points, .gradient, .lower, .upper, .status

fcl_stpbv::DistanceHessian second;
const bool known = fcl_stpbv::hessian(*data.result.object[0], *data.result.object[1], data.result, second);
// second.matrix, 12 x 12 over both twists; .normal, .point: velocities of normal and witness points
  // clang-format on

  std::printf("distance %.6f m\n", data.result.distance);
  const auto& found = data.result;
  const bool good = known && second.matrix.allFinite() && found.status == fcl_stpbv::DistanceStatus::exact &&
                    found.distance > 0.27 && found.distance < 0.28 && found.lower <= found.distance &&
                    found.distance <= found.upper;
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) { return reported(argc, argv, run); }
