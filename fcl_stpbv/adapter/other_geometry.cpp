#include "fcl_stpbv/adapter/other_geometry.h"

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/adapter/mesh_traversal.h"
#include "fcl_stpbv/adapter/octree_traversal.h"

namespace fcl_stpbv {

bool distanceToOther(const StpBv& volume, const Eigen::Isometry3d& poseVolume,
                     const fcl::CollisionGeometryd& other, const Eigen::Isometry3d& poseOther,
                     PairCache* cache, OtherDistance& result) {
  Shape shape;
  if (shapeOf(other, shape)) {
    result.found = distance(volume, poseVolume, shape, poseOther, cache);
    return true;
  }
  NearestElement search(volume, poseVolume, poseOther, cache);
  if (!searchMesh(other, search) && !searchOcTree(other, search)) return false;
  if (!search.any()) return false;
  result.found = search.best();
  result.element = search.element();
  result.runnerUp = search.runnerUp();
  result.continuous = false;
  return true;
}

}  // namespace fcl_stpbv
