// The drop-ins for fcl::collide and its broadphase callback: contacts of the smooth bodies.
#pragma once

#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>

#include <cstddef>
#include <functional>

#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv {

/// In the shape of `fcl::collide`: adds the contacts of the pair to `result`, up to
/// `request.num_max_contacts` in all, and returns how many it then holds. Never throws.
///
/// Two convex bodies have one contact, a mesh or a tree one for each element that meets the other geometry,
/// `b1` and `b2` as FCL numbers them. With `enable_contact`: `penetration_depth` is that of `distance()`,
/// whose bounds a contact has no place for, not below 0, `normal` that of the smooth surface, from geometry 1
/// to 2 in the order of the call, `pos` half way between the deepest points (world, m). Without, each pair of
/// elements costs no more than `isFartherThan`. Touching is a contact. A pair without an answer (a pose that
/// is not rigid, an invalid shape, a corner that is no number, two planes) counts as one too, of infinite
/// depth and without a normal: nobody has found it clear. A geometry that FCL's marks call free or unknown
/// (`cost_density` below `threshold_occupied`; not a tree, whose cells tell) meets nothing, as in FCL. Cost
/// sources are not made; the other fields of the request change nothing. `finite`: as QueryContext's.
std::size_t collide(const fcl::CollisionObjectd* object1, const fcl::CollisionObjectd* object2,
                    const fcl::CollisionRequestd& request, fcl::CollisionResultd& result,
                    PairCache* cache = nullptr, bool finite = false);
/// The same for two geometries at their poses.
std::size_t collide(const fcl::CollisionGeometryd* geometry1, const fcl::Transform3d& pose1,
                    const fcl::CollisionGeometryd* geometry2, const fcl::Transform3d& pose2,
                    const fcl::CollisionRequestd& request, fcl::CollisionResultd& result,
                    PairCache* cache = nullptr, bool finite = false);

/// FCL's other scalar is refused here, with the reason. `collide<double>(...)`, as generic code names it, is
/// the function above.
template <typename S>
std::size_t collide(const fcl::CollisionObject<S>* object1, const fcl::CollisionObject<S>* object2,
                    const fcl::CollisionRequest<S>& request, fcl::CollisionResult<S>& result) {
  static_assert(isDouble<S>, "fcl_stpbv answers about objects in double: make them fcl::CollisionObjectd");
  if constexpr (isDouble<S>) return fcl_stpbv::collide(object1, object2, request, result);
  return 0;
}

class PairCaches;

/// What `collisionCallback` reads and writes; pass its address to a manager's `collide`. The result
/// accumulates: give each query fresh data.
struct CollisionData {
  fcl::CollisionRequestd request;  ///< as collide() reads it
  fcl::CollisionResultd result;    ///< contacts of all pairs so far
  bool done = false;               ///< set it to stop; set where the result holds all the contacts asked for
  PairCaches* caches = nullptr;    ///< optional: makes repeated queries of a slowly moving scene faster
  /// Optional: pairs that are not asked, as DistanceData's.
  std::function<bool(const fcl::CollisionObjectd*, const fcl::CollisionObjectd*)> leaveOut = nullptr;
  bool finite = false;  ///< as QueryContext's
};

/// For `manager.collide(&data, fcl_stpbv::collisionCallback)` with `data` a CollisionData.
bool collisionCallback(fcl::CollisionObjectd* object1, fcl::CollisionObjectd* object2, void* data);

}  // namespace fcl_stpbv
