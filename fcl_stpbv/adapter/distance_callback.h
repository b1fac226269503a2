// Callback for FCL's broadphase managers: finds the closest, or the most deeply overlapping, pair of a scene.
#pragma once

#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance_request.h>

#include <cstddef>
#include <functional>
#include <unordered_map>
#include <utility>

#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv {

/// The warm-start caches of all pairs of objects. Allocates when a pair is used for the first time. Not
/// thread-safe: only one thread at a time may use it.
class PairCaches {
 public:
  /// The cache of a pair, in this order of the objects; created on first use.
  PairCache& of(const fcl::CollisionObjectd* object1, const fcl::CollisionObjectd* object2) {
    return caches_[{object1, object2}];
  }
  /// Number of pairs with a cache.
  std::size_t size() const { return caches_.size(); }
  /// Removes all caches. Call it when objects are destroyed: new objects may get the same addresses.
  void clear() { caches_.clear(); }

 private:
  using Key = std::pair<const fcl::CollisionObjectd*, const fcl::CollisionObjectd*>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      const std::hash<const void*> hash;
      return hash(key.first) * 31 + hash(key.second);
    }
  };
  std::unordered_map<Key, PairCache, Hash> caches_;
};

/// Input and output of `distanceCallback`; pass its address to a manager's `distance`.
///
/// The result accumulates over calls, as in FCL's own callback data: use a new object for each query, or call
/// `clear()`.
struct DistanceData {
  /// Only for compatibility with FCL's callback data; it has no effect.
  fcl::DistanceRequestd request = fcl::DistanceRequestd(true);
  /// The closest pair so far. Before the first pair, `distance` is the largest double. If a pair has no
  /// answer, that pair is the result: status `invalid`, distance minus infinity; `object` names the pair.
  DistanceAnswer result;
  bool done = false;  ///< set it to stop the search
  /// Whether to stop at the first pair in contact, as FCL's own callback does. Otherwise the deepest pair is
  /// found.
  bool stopAtContact = false;
  PairCaches* caches = nullptr;  ///< optional: makes repeated queries of a slowly moving scene faster
  /// Optional: counts how good FCL's features were as starting points; makes queries slower.
  MappingCounts* mapping = nullptr;
  StartFrom start = StartFrom::centres;  ///< starting point for pairs without a cached answer
  /// Optional: returns true for pairs to skip, such as two parts of one body, which FCL's managers offer like
  /// any other pair (docs/fcl.md). It gets the objects in the manager's order. FCL's dynamic AABB trees pass
  /// an octree's cells as temporary boxes without user data, unless `octree_as_geometry_distance` is set (for
  /// contacts `octree_as_geometry_collide`).
  std::function<bool(const fcl::CollisionObjectd*, const fcl::CollisionObjectd*)> leaveOut = nullptr;
  bool finite = false;      ///< see QueryContext::finite
  std::size_t pairs = 0;    ///< number of pairs queried
  std::size_t invalid = 0;  ///< number of these pairs that have no answer

  /// Resets the result, `done`, `pairs` and `invalid`; keeps the settings, the caches and the mapping counts.
  void clear() {
    result = {};
    done = false;
    pairs = invalid = 0;
  }
};

/// For `manager.distance(&data, fcl_stpbv::distanceCallback)` with `data` a DistanceData.
///
/// FCL's managers skip a pair if the distance of its bounding boxes is not below `dist`. That distance is 0
/// for boxes that overlap. So `dist` stays above 0, and a deeper pair is still found after the first contact.
bool distanceCallback(fcl::CollisionObjectd* object1, fcl::CollisionObjectd* object2, void* data,
                      double& dist);

}  // namespace fcl_stpbv
