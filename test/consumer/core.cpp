// Uses the drop-in from an installed tree: two boxes through an FCL manager.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl_stpbv/fcl_stpbv.h>

#include <cmath>
#include <cstdio>

int main() {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 8; ++i) points.emplace_back(i & 1 ? 0.1 : -0.1, i & 2 ? 0.1 : -0.1, i & 4 ? 0.1 : -0.1);
  const auto link = std::make_shared<fcl_stpbv::StpBvGeometry>(fcl_stpbv::StpBv::build(points, {0.01, 10.0}));
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  fcl::CollisionObjectd first(link, pose);
  pose.translation() = Eigen::Vector3d(0.5, 0, 0);
  fcl::CollisionObjectd second(link, pose);
  fcl::DynamicAABBTreeCollisionManagerd manager;
  manager.registerObject(&first);
  manager.registerObject(&second);
  manager.setup();
  fcl_stpbv::DistanceData data;
  manager.distance(&data, fcl_stpbv::distanceCallback);
  // Between parallel faces, the tops of the two big spheres face each other: 0.3 m minus twice the
  // over-cover.
  const double expected = 0.3 - 2 * fcl_stpbv::overCover(link->volume()).max;
  std::printf("distance %.15g, expected %.15g\n", data.result.distance, expected);
  return std::abs(data.result.distance - expected) <= 1e-14 ? 0 : 1;
}
