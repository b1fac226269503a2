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
    if (answer.distance < query.result.distance) query.result = answer;  // of no answer minus infinity
  }
  // Above 0, so that pairs of overlapping boxes are still asked (their distance is 0, and FCL
  // prunes by `<`). Below the largest double, at which the sweeping managers begin and which
  // they would take for "not called" for ever.
  dist = std::clamp(query.result.distance, std::numeric_limits<double>::min(),
                    0.5 * std::numeric_limits<double>::max());
  return query.done || (query.stopAtContact && query.result.distance <= 0);
}

}  // namespace fcl_stpbv
