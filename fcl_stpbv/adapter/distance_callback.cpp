// The callback for FCL's broadphase managers. For each pair that the caller does not skip:
// 1. compute fcl_stpbv::distance, with the pair's cache if there is one;
// 2. keep the answer if its distance is the least so far. A pair without an answer has the distance minus
//    infinity, so it is kept;
// 3. set `dist` above 0, so that the manager goes on to overlapping pairs.
#include "fcl_stpbv/adapter/distance_callback.h"

#include <algorithm>
#include <limits>

namespace fcl_stpbv {

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
    // Without an answer it is minus infinity.
    if (answer.distance < query.result.distance) query.result = answer;
  }
  // `dist` is above 0, so that pairs of overlapping boxes are still asked: the distance of such boxes is 0,
  // and FCL prunes by `<`. It is below the largest double, with which the sweeping managers begin: they would
  // always take that value for "not called yet".
  dist = std::clamp(query.result.distance, std::numeric_limits<double>::min(),
                    0.5 * std::numeric_limits<double>::max());
  return query.done || (query.stopAtContact && query.result.distance <= 0);
}

}  // namespace fcl_stpbv
