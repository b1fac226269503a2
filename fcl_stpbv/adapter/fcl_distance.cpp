// The distance of two FCL geometries, by type: STP-BVs and simple shapes by distance/distance.h, meshes and
// octrees by nearest_pair.h.
#include "fcl_stpbv/adapter/fcl_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/adapter/feature_map.h"
#include "fcl_stpbv/adapter/nearest_pair.h"
#include "fcl_stpbv/adapter/polyhedral_witness.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using fcl::CollisionGeometryd;
using fcl::Transform3d;

/// A start from FCL's polyhedral witness (paper IV.B). The feature walk continues from it. The walk is
/// cheaper than GJK's last steps and than the choice of neighbours, so both are omitted.
PairCache startFromFcl(const StpBvGeometry& a, const Transform3d& poseA, const StpBvGeometry& b,
                       const Transform3d& poseB) {
  constexpr double kGap = 0.9;  // share of the distance: any plane well between the hulls will do
  const PolyhedralWitness witness = polyhedralWitness(a.hull(), poseA, b.hull(), poseB, {}, kGap);
  return {witness.direction, {a.patchOf(witness.feature[0]), b.patchOf(witness.feature[1])}};
}

/// Starts from the exact polyhedral witness points, maps them in full and counts how good the mapping was.
Distance countedDistance(const StpBvGeometry& a, const Transform3d& poseA, const StpBvGeometry& b,
                         const Transform3d& poseB, PairCache& start, MappingCounts& counts) {
  const PolyhedralWitness witness = polyhedralWitness(a.hull(), poseA, b.hull(), poseB);
  const std::array<int, 2> mapped = mapFeatures(a, poseA, b, poseB, witness);
  start = {witness.direction, mapped};
  const Distance found = distance(a.volume(), poseA, b.volume(), poseB, &start);
  countMapping(a.volume(), poseA, b.volume(), poseB, mapped, found, counts);
  return found;
}

/// Distance of two STP-BVs. It starts from the last answer if there is one, otherwise as the caller wants.
Distance smoothDistance(const StpBvGeometry& a, const Transform3d& poseA, const StpBvGeometry& b,
                        const Transform3d& poseB, const QueryContext& context) {
  PairCache start;
  PairCache& cache = context.cache ? *context.cache : start;
  if (!PairCache::isDirection(cache.normal.squaredNorm())) {
    if (context.mapping) return countedDistance(a, poseA, b, poseB, cache, *context.mapping);
    if (context.start == StartFrom::fclWitness) cache = startFromFcl(a, poseA, b, poseB);
  }
  return distance(a.volume(), poseA, b.volume(), poseB, &cache);
}

/// Distance of an STP-BV and any other geometry. Both orders make the same query, so the answers agree.
DistanceAnswer mixedDistance(const StpBvGeometry* a, const CollisionGeometryd& geometry1,
                             const Transform3d& pose1, const StpBvGeometry* b,
                             const CollisionGeometryd& geometry2, const Transform3d& pose2,
                             const QueryContext& context, const KnownTrees& trees) {
  PairCache cache;  // with the STP-BV first
  if (context.cache) cache = *context.cache;
  if (!a) cache = cache.mirrored();
  Shape shape;
  const bool isShape = shapeOf(a ? geometry2 : geometry1, shape);
  ElementsDistance other;
  if (isShape)
    other.found = a ? distance(a->volume(), pose1, shape, pose2, &cache)
                    : distance(b->volume(), pose2, shape, pose1, &cache);
  else
    other =
        a ? nearestElements(geometry1, pose1, geometry2, pose2, context.finite, trees, &cache)
          : nearestElements(geometry2, pose2, geometry1, pose1, context.finite, {trees[1], trees[0]}, &cache);
  if (!a) {
    cache = cache.mirrored();
    other.found = other.found.mirrored();
  }
  if (context.cache) *context.cache = cache;
  DistanceAnswer answer = inFclTerms(other.found, pose1, pose2);
  if (answer.status == DistanceStatus::invalid) return answer;
  answer.element[a ? 1 : 0] = other.element[1];
  answer.runnerUp = other.runnerUp;
  answer.continuous = isShape;  // the nearest element of a mesh or a tree switches
  return answer;
}

/// Distance of two geometries without an STP-BV: two simple shapes, or meshes and trees.
DistanceAnswer plainDistance(const CollisionGeometryd& geometry1, const Transform3d& pose1,
                             const CollisionGeometryd& geometry2, const Transform3d& pose2,
                             const QueryContext& context, const KnownTrees& trees) {
  Shape a, b;
  ElementsDistance elements;
  if (shapeOf(geometry1, a) && shapeOf(geometry2, b))
    elements.found = distance(a, pose1, b, pose2);
  else
    elements = nearestElements(geometry1, pose1, geometry2, pose2, context.finite, trees);
  DistanceAnswer answer = inFclTerms(elements.found, pose1, pose2);
  answer.element = elements.element;
  answer.runnerUp = elements.runnerUp;
  answer.continuous = false;
  return answer;
}

DistanceAnswer anyDistance(const CollisionGeometryd& geometry1, const Transform3d& pose1,
                           const CollisionGeometryd& geometry2, const Transform3d& pose2,
                           const QueryContext& context, const KnownTrees& trees) {
  const StpBvGeometry* a = asStpBv(&geometry1);
  const StpBvGeometry* b = asStpBv(&geometry2);
  if (a && b) return inFclTerms(smoothDistance(*a, pose1, *b, pose2, context), pose1, pose2);
  if (a || b) return mixedDistance(a, geometry1, pose1, b, geometry2, pose2, context, trees);
  return plainDistance(geometry1, pose1, geometry2, pose2, context, trees);
}

}  // namespace

FCL_STPBV_VECTORIZED
DistanceAnswer inFclTerms(const Distance& found, const Transform3d& pose1, const Transform3d& pose2) {
  DistanceAnswer answer;
  answer.status = found.status;
  if (found.status == DistanceStatus::invalid) return answer;
  answer.distance = found.distance;
  answer.lower = found.lower;
  answer.upper = found.upper;
  answer.normal = found.normal;
  answer.points = found.point;
  answer.patch = found.patch;
  answer.gradient = {found.gradient(0, pose1.translation()), found.gradient(1, pose2.translation())};
  answer.continuous = true;
  return answer;
}

Distance inCoreTerms(const DistanceAnswer& answer) {
  return {answer.status, answer.distance, answer.lower, answer.upper,
          answer.normal, answer.points,   answer.patch};
}

bool hasFiniteCorners(const CollisionGeometryd& geometry) { return isSound(geometry); }

DistanceAnswer distance(const CollisionGeometryd& geometry1, const Transform3d& pose1,
                        const CollisionGeometryd& geometry2, const Transform3d& pose2,
                        const QueryContext& context) {
  return detail::distance(geometry1, pose1, geometry2, pose2, context, {});
}

DistanceAnswer detail::distance(const CollisionGeometryd& geometry1, const Transform3d& pose1,
                                const CollisionGeometryd& geometry2, const Transform3d& pose2,
                                const QueryContext& context, const KnownTrees& trees) {
  DistanceAnswer answer = anyDistance(geometry1, pose1, geometry2, pose2, context, trees);
  answer.geometry = {&geometry1, &geometry2};
  return answer;
}

DistanceAnswer distance(const fcl::CollisionObjectd& object1, const fcl::CollisionObjectd& object2,
                        const QueryContext& context) {
  DistanceAnswer answer = distance(*object1.collisionGeometry(), object1.getTransform(),
                                   *object2.collisionGeometry(), object2.getTransform(), context);
  answer.object = {&object1, &object2};
  return answer;
}

Distance distance(const StpBvGeometry& geometry, const fcl::Transform3d& pose, const Eigen::Vector3d& point,
                  PairCache* cache) {
  return distance(geometry.volume(), pose, point, cache);
}

fcl::DistanceResultd toFclResult(const DistanceAnswer& answer) {
  fcl::DistanceResultd result;
  // The largest double before the first pair of a scene; minus infinity for a pair without an answer.
  result.min_distance = std::isfinite(answer.distance) ? answer.distance : -1;
  result.nearest_points[0] = answer.points[0];
  result.nearest_points[1] = answer.points[1];
  result.o1 = answer.geometry[0];
  result.o2 = answer.geometry[1];
  result.b1 = answer.element[0];
  result.b2 = answer.element[1];
  return result;
}

// The request's flags say how FCL should compute and what it may leave out. Here everything is exact and
// available.
double distance(const fcl::CollisionObjectd* object1, const fcl::CollisionObjectd* object2,
                const fcl::DistanceRequestd& /*request*/, fcl::DistanceResultd& result) {
  result = toFclResult(distance(*object1, *object2));
  return result.min_distance;
}

double distance(const CollisionGeometryd* geometry1, const Transform3d& pose1,
                const CollisionGeometryd* geometry2, const Transform3d& pose2,
                const fcl::DistanceRequestd& /*request*/, fcl::DistanceResultd& result) {
  result = toFclResult(distance(*geometry1, pose1, *geometry2, pose2));
  return result.min_distance;
}

// For each pair that the caller does not skip:
// 1. compute fcl_stpbv::distance, with the pair's cache if there is one;
// 2. keep the answer if its distance is the least so far. A pair without an answer has the distance minus
//    infinity, so it is kept;
// 3. set `dist` above 0, so that the manager goes on to overlapping pairs.
bool distanceCallback(fcl::CollisionObjectd* object1, fcl::CollisionObjectd* object2, void* data,
                      double& dist) {
  DistanceData& query = *static_cast<DistanceData*>(data);
  if (!query.done && !(query.leaveOut && query.leaveOut(object1, object2))) {
    ++query.pairs;
    QueryContext context;
    context.mapping = query.mapping;
    context.start = query.start;
    context.finite = query.finite;
    if (query.caches) context.cache = &query.caches->of(object1, object2);
    const DistanceAnswer answer = distance(*object1, *object2, context);
    query.invalid += answer.status == DistanceStatus::invalid;
    // Without an answer it is minus infinity. A map of free cells is as far away as no pair at all.
    const bool isFirst = !query.result.geometry[0];
    if (answer.distance < query.result.distance || (isFirst && answer.distance == query.result.distance))
      query.result = answer;
  }
  // `dist` is above 0, so that pairs of overlapping boxes are still asked: the distance of such boxes is 0,
  // and FCL prunes by `<`. It is below the largest double, with which the sweeping managers begin: they would
  // always take that value for "not called yet".
  dist = std::clamp(query.result.distance, std::numeric_limits<double>::min(),
                    0.5 * std::numeric_limits<double>::max());
  return query.done || (query.stopAtContact && query.result.distance <= 0);
}

}  // namespace fcl_stpbv
