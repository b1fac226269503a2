// An STP-BV against another FCL geometry: a simple shape is solved at once, a
// mesh or tree by its nearest element.
#include "fcl_stpbv/adapter/other_geometry.h"

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/adapter/nearest_element.h"

namespace fcl_stpbv::detail {

OtherDistance distanceToOther(const StpBv& volume, const Eigen::Isometry3d& poseVolume,
                              const fcl::CollisionGeometryd& other, const Eigen::Isometry3d& poseOther,
                              PairCache* cache, bool finite, const ElementTree* tree) {
  OtherDistance result;
  Shape shape;
  if (shapeOf(other, shape)) {
    result.found = distance(volume, poseVolume, shape, poseOther, cache);
    return result;
  }
  const ElementTree elements = tree ? *tree : ElementTree(other, finite);
  if (!elements.any() || !(finite || elements.finite())) return result;
  const NearestElement search(volume, poseVolume, elements, poseOther, cache);
  if (!search.any()) return result;
  return {search.best(), search.element(), search.runnerUp(), /*continuous=*/false};
}

}  // namespace fcl_stpbv::detail
