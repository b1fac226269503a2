// The drop-in for fcl::distance: exact distance of every pair of FCL's geometries, C1 where one is an STP-BV;
// a pair asked again and again, and the questions whose answer needs no full distance.
#pragma once

#include <fcl/narrowphase/collision_object.h>
#include <fcl/narrowphase/distance_request.h>
#include <fcl/narrowphase/distance_result.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>

#include "fcl_stpbv/adapter/stp_bv_geometry.h"
#include "fcl_stpbv/distance/distance.h"

namespace fcl_stpbv {

/// How good the mapped patches turned out to be, counted over queries (paper IV.B: 0.3 % were wrong, nearly
/// all of them by one neighbour).
struct MappingCounts {
  long right = 0;      ///< both mapped patches own the answer's normal
  long neighbour = 0;  ///< at least one is a direct neighbour of the patch that does, none is farther
  long farther = 0;    ///< at least one is farther away
  long unmapped = 0;   ///< no feature to map: the polyhedra overlap, or were not decided

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

/// Whether a scalar of FCL's templates is the one that this library answers in.
template <typename S>
constexpr bool isDouble = std::is_same<S, double>::value;

/// Answer about two FCL geometries. World frame, metres.
struct DistanceAnswer {
  DistanceStatus status = DistanceStatus::invalid;  ///< how good the answer is
  /// Signed; in [lower, upper]. Minus infinity where the status is `invalid`, so that no comparison takes it
  /// for clear; the largest double of a tree whose cells are all free, and before a pair was asked
  /// (DistanceData).
  double distance = std::numeric_limits<double>::max();
  double lower = -std::numeric_limits<double>::infinity();  ///< certified lower bound (m)
  double upper = std::numeric_limits<double>::infinity();   ///< certified upper bound (m)
  Eigen::Vector3d normal{0, 0, 0};  ///< unit, from geometry 1 to 2; zero where it is not known
  std::array<Eigen::Vector3d, 2> points{Eigen::Vector3d(0, 0, 0),
                                        Eigen::Vector3d(0, 0, 0)};  ///< witness points
  /// Derivatives with respect to the twist [linear; angular] of each body
  /// about its frame's origin, world axes.
  std::array<TwistGradient, 2> gradient{TwistGradient::Zero(), TwistGradient::Zero()};
  std::array<int, 2> patch{-1, -1};  ///< of the STP-BVs; -1 for any other geometry
  /// Nearest triangle or cell of a mesh or tree, FCL's `b1`, `b2`; -1 for any other geometry.
  std::array<std::intptr_t, 2> element{-1, -1};
  /// Distance to the next triangle or cell (m), infinite where there is none: the nearest one
  /// can switch once both have come nearer to each other by the difference. Equal where the
  /// nearest point is on a shared edge or corner. Of two meshes, clouds or trees it may be less
  /// than that, down to `distance`: where one plane parts them, no next pair is looked for.
  double runnerUp = std::numeric_limits<double>::infinity();
  /// Whether distance and gradient are continuous over motions: true for an STP-BV against
  /// one or a simple shape; false for meshes and trees, whose nearest element switches,
  /// and for two geometries without an STP-BV.
  bool continuous = false;
  std::array<const fcl::CollisionGeometryd*, 2> geometry{nullptr, nullptr};  ///< the two asked about
  std::array<const fcl::CollisionObjectd*, 2> object{nullptr,
                                                     nullptr};  ///< null if asked by geometry and pose
};

/// What a question about a threshold took (isFartherThan()).
struct ProximityCounts {
  long bounds = 0;  ///< pairs of boxes, balls or planes compared
  long solved = 0;  ///< pairs of bodies whose distance had to be searched for
};

/// Where a query of two STP-BVs starts that knows no last answer. Either way the distance is the same.
enum class StartFrom {
  centres,     ///< the line between the centres: the fastest
  fclWitness,  ///< the features of FCL's polyhedral witness: the paper's way (IV.B)
};

/// What a query may remember and report; all optional, all owned by the caller.
struct QueryContext {
  PairCache* cache = nullptr;  ///< starts the query near the pair's last answer
  /// Gets the outcome of the feature mapping: queries without a last answer start from FCL's exact witness
  /// then, which takes longer.
  MappingCounts* mapping = nullptr;
  ProximityCounts* proximity = nullptr;  ///< gets what a question about a threshold took
  StartFrom start = StartFrom::centres;  ///< of queries without a last answer
  /// The caller knows that meshes are sound (hasFiniteCorners()). Each query looks at all of their corners
  /// otherwise, which is most of its time where a large mesh is far away (docs/fcl.md). If it is not true,
  /// the answer is meaningless.
  bool finite = false;
};

/// Whether all corners of a mesh are numbers, below 1e150 m, and its boxes hold its triangles. A mesh with
/// another corner, used by a triangle or not, has no answer. Boxes that FCL has merged since the vertices
/// moved (docs/fcl.md) are not used, but each query has to see that they were. True for all other types:
/// theirs are asked in any case.
bool hasFiniteCorners(const fcl::CollisionGeometryd& geometry);

/// Distance between two geometries. Never throws or allocates, but for boxes in place of those that FCL has
/// merged (hasFiniteCorners()); FCL is never asked for a distance.
///
/// An STP-BV against one, or against any other FCL geometry in either order: exact and signed, with
/// status, bounds and derivatives. Two other shapes, one of them bounded: signed, by this library's
/// own GJK, and at overlap by an expanding polytope (distance/shape_distance.h), `continuous` false.
/// Meshes and trees: of their nearest elements (nearest_pair.h), `continuous` false; two of them
/// that overlap: 0, with the elements that meet. `invalid` for a mesh with a corner that is no number.
DistanceAnswer distance(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                        const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                        const QueryContext& context = {});

/// The same for two collision objects.
DistanceAnswer distance(const fcl::CollisionObjectd& object1, const fcl::CollisionObjectd& object2,
                        const QueryContext& context = {});

/// What a query of two STP-BVs found, as an answer about bodies at these poses.
DistanceAnswer inFclTerms(const Distance& found, const fcl::Transform3d& pose1,
                          const fcl::Transform3d& pose2);

/// An answer as the core's queries give it, without their counts of work.
Distance inCoreTerms(const DistanceAnswer& answer);

/// In the shape of `fcl::distance`: returns the distance and fills `result`
/// afresh, nearest points always included.
///
/// Differs from FCL where FCL sets traps (docs/fcl.md): `result` holds this pair and no earlier one,
/// the distance is always signed where a body is convex, no field is left uninitialised. A query
/// that has no answer is -1, FCL's own value for it.
double distance(const fcl::CollisionObjectd* object1, const fcl::CollisionObjectd* object2,
                const fcl::DistanceRequestd& request, fcl::DistanceResultd& result);
/// The same for two geometries at their poses.
double distance(const fcl::CollisionGeometryd* geometry1, const fcl::Transform3d& pose1,
                const fcl::CollisionGeometryd* geometry2, const fcl::Transform3d& pose2,
                const fcl::DistanceRequestd& request, fcl::DistanceResultd& result);

/// FCL's other scalar is refused here, with the reason. `distance<double>(...)`, as generic code names it, is
/// the function above.
template <typename S>
double distance(const fcl::CollisionObject<S>* object1, const fcl::CollisionObject<S>* object2,
                const fcl::DistanceRequest<S>& request, fcl::DistanceResult<S>& result) {
  static_assert(isDouble<S>, "fcl_stpbv answers about objects in double: make them fcl::CollisionObjectd");
  if constexpr (isDouble<S>) return fcl_stpbv::distance(object1, object2, request, result);
  return -1;
}
/// Refused likewise.
template <typename S>
DistanceAnswer distance(const fcl::CollisionObject<S>& object1, const fcl::CollisionObject<S>& object2,
                        const QueryContext& context = {}) {
  static_assert(isDouble<S>, "fcl_stpbv answers about objects in double: make them fcl::CollisionObjectd");
  if constexpr (isDouble<S>) return fcl_stpbv::distance(object1, object2, context);
  return {};
}

/// An answer in FCL's words.
fcl::DistanceResultd toFclResult(const DistanceAnswer& answer);

/// Distance of a fixed pair of geometries over many poses; each query starts from the last answer. One thread
/// at a time may use one; any number of them may share geometries.
class PairDistance {
 public:
  using Geometry = std::shared_ptr<const fcl::CollisionGeometryd>;  ///< shared with whoever else uses it

  /// `mapping`, optional, gets how good FCL's features were as starts, and
  /// makes the queries that ask FCL slower.
  PairDistance(Geometry geometry1, Geometry geometry2, MappingCounts* mapping = nullptr)
      : geometry1_(std::move(geometry1)), geometry2_(std::move(geometry2)), mapping_(mapping) {}

  /// The distance at these poses, as distance() answers it.
  DistanceAnswer operator()(const fcl::Transform3d& pose1, const fcl::Transform3d& pose2) {
    return distance(*geometry1_, pose1, *geometry2_, pose2, {&cache_, mapping_});
  }

  /// Makes the next query start as the first one did.
  void forget() { cache_ = {}; }

 private:
  Geometry geometry1_, geometry2_;
  PairCache cache_;
  MappingCounts* mapping_;
};

/// Whether the geometries are certainly farther apart than `x` (m; negative: whether they are less deep in
/// each other; two meshes or trees always are, as distance() knows no depth of surfaces).
///
/// For every pair of types, with or without an STP-BV. Meshes and trees are walked down from both
/// roots: pairs of boxes farther apart are left out, and the first pair of elements that is not ends
/// the walk. Of two bodies balls, the supporting planes of the remembered normal, and only then a
/// search are asked, which ends as soon as its bounds tell where neither is an STP-BV. False for a pair
/// without an answer: nothing is certain about it.
bool isFartherThan(double x, const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                   const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                   const QueryContext& context = {});

/// Whether the geometries come within `margin` (m) of each other; what is not known counts as a collision.
inline bool collides(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                     const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                     double margin = 0.0, const QueryContext& context = {}) {
  return !isFartherThan(margin, geometry1, pose1, geometry2, pose2, context);
}

/// Signed distance of a world point to an STP-BV; `normal` points from the volume to the point.
Distance distance(const StpBvGeometry& geometry, const fcl::Transform3d& pose, const Eigen::Vector3d& point,
                  PairCache* cache = nullptr);

}  // namespace fcl_stpbv
