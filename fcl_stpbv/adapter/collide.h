// Replacements for fcl::collide and for its broadphase callback. They report contacts of the smooth bodies.
#pragma once

#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/collision_request.h>
#include <fcl/narrowphase/collision_result.h>

#include <cstddef>
#include <functional>

#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv {

/// Replaces `fcl::collide`, with the same first arguments: adds the contacts of the pair to `result`, up to
/// `request.num_max_contacts` in total, and returns the number of contacts in `result`. Never throws.
///
/// Two convex bodies have one contact. A mesh or an octree has one contact for each of its elements
/// (triangles, cells) that meets the other geometry; `b1` and `b2` are FCL's numbers of the elements. With
/// `enable_contact`, a contact has these fields: `penetration_depth`, minus the result of `distance()` but
/// not below 0 (m); `normal`, of the smooth surface, from geometry 1 to geometry 2 in the order of the call;
/// `pos`, half way between the deepest points (world, m). Without `enable_contact`, each pair of elements
/// costs no more than `isFartherThan`. Touching is a contact.
/// A pair without an answer (a pose that is not rigid, an invalid shape, a vertex that is not finite, two
/// planes) also counts as a contact, because it is not known to be clear. With `enable_contact` its depth is
/// infinite; its normal is zero. A geometry that FCL marks as free or unknown (`cost_density` below
/// `threshold_occupied`) has no contacts, as in FCL; in an octree each cell has its own mark. Cost sources
/// are not made, and the other fields of the request have no effect. Of the context, `cache` and `finite` are
/// used.
std::size_t collide(const fcl::CollisionObjectd* object1, const fcl::CollisionObjectd* object2,
                    const fcl::CollisionRequestd& request, fcl::CollisionResultd& result,
                    const QueryContext& context = {});
/// The same for two geometries at their poses.
std::size_t collide(const fcl::CollisionGeometryd* geometry1, const fcl::Transform3d& pose1,
                    const fcl::CollisionGeometryd* geometry2, const fcl::Transform3d& pose2,
                    const fcl::CollisionRequestd& request, fcl::CollisionResultd& result,
                    const QueryContext& context = {});

/// For generic code that calls `collide<double>(...)`: the same as the function above. `float` is a compile
/// error with an explanation.
template <typename S>
std::size_t collide(const fcl::CollisionObject<S>* object1, const fcl::CollisionObject<S>* object2,
                    const fcl::CollisionRequest<S>& request, fcl::CollisionResult<S>& result) {
  static_assert(isDouble<S>, "fcl_stpbv answers about objects in double: make them fcl::CollisionObjectd");
  if constexpr (isDouble<S>) return fcl_stpbv::collide(object1, object2, request, result);
  return 0;
}

/// Input and output of `collisionCallback`; pass its address to a manager's `collide`. Contacts accumulate in
/// `result`: use a new object for each query.
struct CollisionData {
  fcl::CollisionRequestd request;  ///< the request, as collide() reads it
  fcl::CollisionResultd result;    ///< contacts of all pairs so far
  /// Set it to stop the search; also set when `result` has reached the requested number of contacts.
  bool done = false;
  PairCaches* caches = nullptr;  ///< optional: makes repeated queries of a slowly moving scene faster
  /// Optional: returns true for pairs to skip; see DistanceData.
  std::function<bool(const fcl::CollisionObjectd*, const fcl::CollisionObjectd*)> leaveOut = nullptr;
  bool finite = false;  ///< see QueryContext::finite
};

/// For `manager.collide(&data, fcl_stpbv::collisionCallback)` with `data` a CollisionData.
bool collisionCallback(fcl::CollisionObjectd* object1, fcl::CollisionObjectd* object2, void* data);

}  // namespace fcl_stpbv
