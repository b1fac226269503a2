// The program of before.cpp with continuous gradients: the link's geometry, the callback and its data change.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/narrowphase/collision_object.h>

#include <cstdio>
#include <memory>

#include "docs/examples/reported.h"
#include "fcl_stpbv/adapter/fcl_distance.h"

namespace {

int run() {
  const std::vector<fcl::Vector3d> points{{0, 0, 0}, {0.3, 0, 0}, {0, 0.2, 0}, {0, 0, 0.1}};
  const auto link = std::make_shared<fcl_stpbv::StpBvGeometry>(fcl_stpbv::StpBv::build(points, {0.01, 10.0}));

  fcl::CollisionObjectd arm(link);
  fcl::CollisionObjectd table(std::make_shared<fcl::Boxd>(1.0, 1.0, 0.05));
  fcl::CollisionObjectd post(std::make_shared<fcl::Cylinderd>(0.05, 1.0));
  table.setTranslation({0, 0, -0.3});
  post.setTranslation({0.6, 0, 0});
  for (fcl::CollisionObjectd* object : {&arm, &table, &post}) object->computeAABB();

  fcl::DynamicAABBTreeCollisionManagerd scene;
  scene.registerObjects({&table, &post});
  scene.setup();

  fcl_stpbv::DistanceData data;
  scene.distance(&arm, &data, fcl_stpbv::distanceCallback);
  const Eigen::Vector3d n = data.result.normal;
  std::printf("distance %.6f m, normal %.3f %.3f %.3f\n", data.result.distance, n.x(), n.y(), n.z());
  return data.result.distance > 0.2 && data.result.status == fcl_stpbv::DistanceStatus::exact ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) { return reported(argc, argv, run); }
