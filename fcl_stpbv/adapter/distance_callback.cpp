// The callback for FCL's broadphase managers, for each pair that they offer
// and the caller does not leave out:
// 1. ask fcl_stpbv::distance, from the pair's cache if the caller keeps one;
// 2. keep the answer if it is the closest, or deepest, so far, or if there is none: nothing is nearer than
//    what was not checked;
// 3. return a bound above 0, so that the manager goes on to overlapping pairs.
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
