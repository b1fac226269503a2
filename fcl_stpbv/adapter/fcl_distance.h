// Replacement for fcl::distance: exact distance of every pair of FCL's geometries, C1 if one of them is an
// STP-BV. Also repeated queries of one pair, threshold tests that need no full distance, and the callback for
// FCL's broadphase managers.
#pragma once

#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance_request.h>
#include <fcl/narrowphase/distance_result.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv {

/// How good the mapped patches were as starting points, counted over queries (paper IV.B: 0.3 % were wrong,
/// nearly all of them off by one neighbour).
struct MappingCounts {
  long right = 0;      ///< both mapped patches own the answer's normal
  long neighbour = 0;  ///< at least one is a direct neighbour of the right patch, and none is farther away
  long farther = 0;    ///< at least one is farther away
  long unmapped = 0;   ///< no feature to map: the polyhedra overlap, or their distance was not found

  /// Queries counted.
  long total() const { return right + neighbour + farther + unmapped; }
  /// Adds another count.
  MappingCounts& operator+=(const MappingCounts& other) {
    right += other.right;
    neighbour += other.neighbour;
    farther += other.farther;
    unmapped += other.unmapped;
    return *this;
  }
};

/// Whether the scalar type of an FCL template is double, the only one that this library supports.
template <typename S>
constexpr bool isDouble = std::is_same<S, double>::value;

/// Answer about two FCL geometries. World frame, metres.
struct DistanceAnswer {
  DistanceStatus status = DistanceStatus::invalid;  ///< how good the answer is
  /// Signed distance (m), in [lower, upper]. Minus infinity if the status is `invalid`, so that no comparison
  /// takes the pair for clear. The largest double for an octree whose cells are all free, and in DistanceData
  /// before the first pair.
  double distance = -std::numeric_limits<double>::infinity();
  double lower = -std::numeric_limits<double>::infinity();  ///< certified lower bound (m)
  double upper = std::numeric_limits<double>::infinity();   ///< certified upper bound (m)
  Eigen::Vector3d normal{0, 0, 0};  ///< unit vector from geometry 1 to geometry 2; zero if it is not known
  std::array<Eigen::Vector3d, 2> points{Eigen::Vector3d(0, 0, 0),
                                        Eigen::Vector3d(0, 0, 0)};  ///< witness points
  /// Derivatives of the distance with respect to each body's twist, [linear; angular], about the origin of
  /// its frame, in world axes.
  std::array<TwistGradient, 2> gradient{TwistGradient::Zero(), TwistGradient::Zero()};
  std::array<int, 2> patch{-1, -1};  ///< patches of the STP-BVs; -1 for any other geometry
  /// Nearest triangle of a mesh or nearest cell of an octree, FCL's `b1` and `b2`; -1 for any other geometry.
  std::array<std::intptr_t, 2> element{-1, -1};
  /// Distance of the second nearest triangle or cell (m); infinite if there is none. The nearest element can
  /// change only after the two distances have approached each other by `runnerUp - distance`. It equals
  /// `distance` if the nearest point is on a shared edge or corner. For two meshes, clouds or octrees it is
  /// only a lower bound, which may be as low as `distance`: if one plane separates them, or if they overlap,
  /// no second pair is searched.
  double runnerUp = std::numeric_limits<double>::infinity();
  /// Whether distance and gradient are continuous under motions. True for an STP-BV against an STP-BV or a
  /// simple shape. False for meshes and octrees, because their nearest element switches, and for two
  /// geometries without an STP-BV.
  bool continuous = false;
  /// The two geometries of the query.
  std::array<const fcl::CollisionGeometryd*, 2> geometry{nullptr, nullptr};
  /// Null if the query was by geometry and pose.
  std::array<const fcl::CollisionObjectd*, 2> object{nullptr, nullptr};
};

/// Work of a threshold test (isFartherThan()).
struct ProximityCounts {
  long bounds = 0;  ///< pairs of boxes, balls or planes compared
  long solved = 0;  ///< pairs of bodies for which a distance search was needed
};

/// Starting point for a query of two STP-BVs without a cached answer. The distance is the same for both.
enum class StartFrom {
  centres,     ///< the line between the centres: the fastest
  fclWitness,  ///< the features of the polyhedra at FCL's witness points: the paper's method (IV.B)
};

/// Optional inputs and outputs of a query. The caller owns all objects.
struct QueryContext {
  PairCache* cache = nullptr;  ///< warm start: the query starts near the pair's last answer
  /// Receives the outcome of the feature mapping. Queries without a cached answer then start from FCL's exact
  /// witness points, which takes longer.
  MappingCounts* mapping = nullptr;
  ProximityCounts* proximity = nullptr;  ///< receives the work of a threshold test
  StartFrom start = StartFrom::centres;  ///< starting point for queries without a cached answer
  /// Set it if you have checked all meshes with hasFiniteCorners(). Otherwise each query checks all vertices
  /// of a mesh, which takes most of its time if a large mesh is far away (docs/fcl.md). If it is set and a
  /// mesh is not sound, the answer is meaningless.
  bool finite = false;
};

/// Whether all vertices of a mesh are finite and below 1e150 m, and its bounding volumes contain its
/// triangles. A mesh with another vertex, used by a triangle or not, has no answer. Boxes that FCL merged
/// after the vertices had moved (docs/fcl.md) may miss triangles. They are never used, but without this check
/// each query has to look for them. True for all other types, which each query checks itself.
bool hasFiniteCorners(const fcl::CollisionGeometryd& geometry);

/// Distance between two geometries. Never throws. Allocates only to replace boxes that FCL has merged
/// (hasFiniteCorners()). Never uses FCL's distance functions.
///
/// The result depends on the types:
/// - An STP-BV and an STP-BV, or any other FCL geometry, in either order: exact and signed, with status,
///   bounds and derivatives.
/// - Two other shapes, one of them bounded: signed, by this library's own GJK and, if they overlap, EPA
///   (distance/distance.h); `continuous` is false.
/// - A mesh or an octree: the distance of the nearest elements; `continuous` is false. Two of them that
///   overlap have the distance 0, with the elements that meet.
///
/// The status is `invalid` for a mesh with a vertex that is not finite.
DistanceAnswer distance(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                        const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                        const QueryContext& context = {});

/// distance() for two collision objects.
DistanceAnswer distance(const fcl::CollisionObjectd& object1, const fcl::CollisionObjectd& object2,
                        const QueryContext& context = {});

/// Converts a Distance of two STP-BVs at these poses to a DistanceAnswer.
DistanceAnswer inFclTerms(const Distance& found, const fcl::Transform3d& pose1,
                          const fcl::Transform3d& pose2);

/// Converts a DistanceAnswer to a Distance, without the counts of work.
Distance inCoreTerms(const DistanceAnswer& answer);

/// Replaces `fcl::distance`, with the same arguments: returns the distance (m) and overwrites `result`,
/// always with the nearest points.
///
/// Differences from FCL (docs/fcl.md): `result` describes this pair only, never an earlier one; the distance
/// is always signed if one body is convex; no field is left uninitialised. Without an answer the result
/// is -1, as in FCL.
double distance(const fcl::CollisionObjectd* object1, const fcl::CollisionObjectd* object2,
                const fcl::DistanceRequestd& request, fcl::DistanceResultd& result);
/// The replacement of `fcl::distance` for two geometries at their poses.
double distance(const fcl::CollisionGeometryd* geometry1, const fcl::Transform3d& pose1,
                const fcl::CollisionGeometryd* geometry2, const fcl::Transform3d& pose2,
                const fcl::DistanceRequestd& request, fcl::DistanceResultd& result);

/// For generic code that calls `distance<double>(...)`: the same as the function above. `float` is a compile
/// error with an explanation.
template <typename S>
double distance(const fcl::CollisionObject<S>* object1, const fcl::CollisionObject<S>* object2,
                const fcl::DistanceRequest<S>& request, fcl::DistanceResult<S>& result) {
  static_assert(isDouble<S>, "fcl_stpbv answers about objects in double: make them fcl::CollisionObjectd");
  if constexpr (isDouble<S>) return fcl_stpbv::distance(object1, object2, request, result);
  return -1;
}
/// For generic code, as above: double only.
template <typename S>
DistanceAnswer distance(const fcl::CollisionObject<S>& object1, const fcl::CollisionObject<S>& object2,
                        const QueryContext& context = {}) {
  static_assert(isDouble<S>, "fcl_stpbv answers about objects in double: make them fcl::CollisionObjectd");
  if constexpr (isDouble<S>) return fcl_stpbv::distance(object1, object2, context);
  return {};
}

/// Converts an answer to FCL's result type. `min_distance` is -1 without an answer, and the largest double in
/// the `result` of DistanceData before the first pair.
fcl::DistanceResultd toFclResult(const DistanceAnswer& answer);

/// Distance of a fixed pair of geometries at many poses; each query starts from the last answer. Only one
/// thread at a time may use a PairDistance, but any number of them may share geometries.
class PairDistance {
 public:
  using Geometry = std::shared_ptr<const fcl::CollisionGeometryd>;  ///< shared ownership

  /// `mapping`, optional, counts how good FCL's features were as starting points. Queries without a cached
  /// answer are then slower.
  PairDistance(Geometry geometry1, Geometry geometry2, MappingCounts* mapping = nullptr)
      : geometry1_(std::move(geometry1)), geometry2_(std::move(geometry2)), mapping_(mapping) {}

  /// The distance at these poses; the same answer as distance(), up to what PairCache says.
  DistanceAnswer operator()(const fcl::Transform3d& pose1, const fcl::Transform3d& pose2) {
    return distance(*geometry1_, pose1, *geometry2_, pose2, {&cache_, mapping_});
  }

  /// Drops the cached answer: the next query starts like the first one.
  void forget() { cache_ = {}; }

 private:
  Geometry geometry1_, geometry2_;
  PairCache cache_;
  MappingCounts* mapping_;
};

/// Whether the geometries are certainly farther apart than `x` (m). A negative `x` tests whether they overlap
/// by less than `-x`; this is always true for two meshes or octrees, because surfaces have no depth in
/// distance().
///
/// Works for every pair of types, with or without an STP-BV. In meshes and octrees it descends from both
/// roots, skips pairs of boxes that are farther apart than `x`, and stops at the first pair of elements that
/// is not. For two convex bodies it tries balls, then the supporting planes of the cached normal, and only
/// then a search. Without an STP-BV the search stops as soon as its bounds decide. False for a pair without
/// an answer, since nothing is certain about it.
bool isFartherThan(double x, const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                   const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                   const QueryContext& context = {});

/// Whether the geometries come within `margin` (m) of each other. A pair without an answer counts as a
/// collision.
inline bool collides(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                     const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                     double margin = 0.0, const QueryContext& context = {}) {
  return !isFartherThan(margin, geometry1, pose1, geometry2, pose2, context);
}

/// Signed distance of a point (world, m) to an STP-BV; `normal` points from the volume to the point.
Distance distance(const StpBvGeometry& geometry, const fcl::Transform3d& pose, const Eigen::Vector3d& point,
                  PairCache* cache = nullptr);

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
  /// The closest pair so far. Before the first pair, `distance` is the largest double, and the status is
  /// `invalid`. If a pair has no answer, that pair is the result: status `invalid`, distance minus infinity;
  /// `object` names the pair.
  DistanceAnswer result = beforeFirstPair();
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
    result = beforeFirstPair();
    done = false;
    pairs = invalid = 0;
  }
  /// The result before the first pair.
  static DistanceAnswer beforeFirstPair() {
    DistanceAnswer none;
    none.distance = std::numeric_limits<double>::max();
    return none;
  }
};

/// For `manager.distance(&data, fcl_stpbv::distanceCallback)` with `data` a DistanceData.
///
/// FCL's managers skip a pair if the distance of its bounding boxes is not below `dist`. That distance is 0
/// for boxes that overlap. So `dist` stays above 0, and a deeper pair is still found after the first contact.
bool distanceCallback(fcl::CollisionObjectd* object1, fcl::CollisionObjectd* object2, void* data,
                      double& dist);

}  // namespace fcl_stpbv
