// Callback for FCL's broadphase managers: the closest, or the deepest, pair of a scene.
#pragma once

#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance_request.h>

#include <cstddef>
#include <functional>
#include <unordered_map>
#include <utility>

#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv {

/// What each pair of objects remembers between queries. Allocates when it sees a pair for the first time. One
/// thread at a time may use it.
class PairCaches {
 public:
  /// The memory of a pair, in this order of the objects; made when first asked for.
  PairCache& of(const fcl::CollisionObjectd* object1, const fcl::CollisionObjectd* object2) {
    return caches_[{object1, object2}];
  }
  /// Number of pairs remembered.
  std::size_t size() const { return caches_.size(); }
  /// To be called when objects go away: their addresses may come back as others'.
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

/// What `distanceCallback` reads and writes; pass its address to a manager's `distance`.
///
/// The result accumulates over calls, as FCL's own callback data does: give
/// each query fresh data, or `clear()` it.
struct DistanceData {
  /// For code that shares FCL's callback data; nothing in it changes the answer.
  fcl::DistanceRequestd request = fcl::DistanceRequestd(true);
  /// The closest pair so far; `distance` is the largest double before the first. Once a pair has no answer
  /// that pair, which `object` names: status `invalid`, distance minus infinity.
  DistanceAnswer result;
  bool done = false;  ///< set it to stop the search
  /// Stop at the first pair in contact, as FCL's own callback does; else the deepest pair is found.
  bool stopAtContact = false;
  PairCaches* caches = nullptr;          ///< optional: makes repeated queries of a slowly moving scene faster
  MappingCounts* mapping = nullptr;      ///< optional: gets how good FCL's features were as starts; slower
  StartFrom start = StartFrom::centres;  ///< of pairs without a last answer
  /// Optional: pairs that are not asked, as two parts of one body, which FCL's managers offer like any others
  /// (docs/fcl.md). Takes the objects in the manager's order; an octree's side is a box without marks unless
  /// the manager takes trees whole.
  std::function<bool(const fcl::CollisionObjectd*, const fcl::CollisionObjectd*)> leaveOut = nullptr;
  bool finite = false;      ///< as QueryContext's
  std::size_t pairs = 0;    ///< pairs asked
  std::size_t invalid = 0;  ///< of these, pairs without an answer

  /// Forgets everything found, keeps the settings, caches and counts.
  void clear() {
    result = {};
    done = false;
    pairs = invalid = 0;
  }
};

/// For `manager.distance(&data, fcl_stpbv::distanceCallback)` with `data` a DistanceData.
///
/// FCL's managers prune by the distance of bounding boxes, which is 0 at overlap, against `dist`. So that
/// pruning does not hide a deeper pair behind the first contact, `dist` stays above 0.
bool distanceCallback(fcl::CollisionObjectd* object1, fcl::CollisionObjectd* object2, void* data,
                      double& dist);

}  // namespace fcl_stpbv
