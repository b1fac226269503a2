// An ordinary FCL program: the closest pair of a robot's link and the obstacles around it.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/narrowphase/collision_object.h>

#include <cstdio>
#include <memory>

#include "docs/examples/reported.h"

namespace {

int run() {
  const auto points = std::make_shared<const std::vector<fcl::Vector3d>>(
      std::vector<fcl::Vector3d>{{0, 0, 0}, {0.3, 0, 0}, {0, 0.2, 0}, {0, 0, 0.1}});
  const auto faces = std::make_shared<const std::vector<int>>(
      std::vector<int>{3, 0, 2, 1, 3, 0, 1, 3, 3, 0, 3, 2, 3, 1, 2, 3});
  const auto link = std::make_shared<fcl::Convexd>(points, 4, faces);

  fcl::CollisionObjectd arm(link);
  fcl::CollisionObjectd table(std::make_shared<fcl::Boxd>(1.0, 1.0, 0.05));
  fcl::CollisionObjectd post(std::make_shared<fcl::Cylinderd>(0.05, 1.0));
  table.setTranslation({0, 0, -0.3});
  post.setTranslation({0.6, 0, 0});
  for (fcl::CollisionObjectd* object : {&arm, &table, &post}) object->computeAABB();

  fcl::DynamicAABBTreeCollisionManagerd scene;
  scene.registerObjects({&table, &post});
  scene.setup();

  fcl::DefaultDistanceData<double> data;
  scene.distance(&arm, &data, fcl::DefaultDistanceFunction);
  std::printf("distance %.6f m\n", data.result.min_distance);
  return data.result.min_distance > 0.2 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) { return reported(argc, argv, run); }
