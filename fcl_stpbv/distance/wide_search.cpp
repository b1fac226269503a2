#include "fcl_stpbv/distance/wide_search.h"

#include <algorithm>

#include "fcl_stpbv/distance/expanding_polytope.h"
#include "fcl_stpbv/distance/penetration.h"
#include "fcl_stpbv/distance/polytope_search.h"
#include "fcl_stpbv/distance/separation.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// From any start along which the cores are apart: the widest gap.
Found climb(const BodyPair& pair, Sample x, Work& work) {
  if (!ascend(pair, x, work) && !settleBeside(pair, x, work)) bisectToWidest(pair, x, work);
  return {x, pair.isStationary(x) ? DistanceStatus::exact : DistanceStatus::bounded, 0.0};
}

/// From the polyhedra's closest features to the smooth ones (paper IV.B), and on from there.
bool polyhedralStart(const BodyPair& pair, const VertexSearch& search, Found& found, Work& work) {
  if (!search.apart) return false;
  const Vector3d& n = search.n;
  Sample x = Sample::unevaluated(
      n, {pair.a().owner(n, search.vertex[0]), pair.b().owner(pair.opposite(n), search.vertex[1])});
  work.steps += (x.patch[0] != search.vertex[0]) + (x.patch[1] != search.vertex[1]);
  Vector3d ignored;
  if (settle(pair, x, ignored, work) && x.core > 0.0) {
    found = {x, DistanceStatus::exact, 0.0};
    return true;
  }
  x = pair.sample(n, x.patch);
  if (!(x.core > 0.0)) return false;
  found = climb(pair, x, work);
  return true;
}

/// Cores that overlap, from a maximum in `found`: their widest gap as far as the polytope around that proves
/// it.
bool overlapAround(const BodyPair& pair, Found& found, Work& work) {
  found.status = DistanceStatus::local;
  const bool proven = expandPolytope(pair, found.at, found.bound, work);
  if (found.at.core > 0.0) {
    found = climb(pair, found.at, work);
    return true;
  }
  if (!proven) return false;
  if (!pair.isStationary(found.at))
    ascend(pair, found.at, work);  // the polytope met one next to the top only
  return found.at.core <= 0.0;
}

/// Cores that overlap: the least separating translation, from any normal. A search that was not surrounded
/// has no corners to start from.
Found solveOverlap(const BodyPair& pair, const Vector3d& n, const std::array<int, 2>& patch,
                   const VertexSearch& search, Work& work) {
  Sample x = pair.sampleFrom(n, patch, work.steps);
  Vector3d ignored;
  settle(pair, x, ignored, work);
  if (x.core > 0.0) return climb(pair, x, work);  // apart, by less than the search's rounding
  double bound = 0.0;
  const auto fromCorners = [&] {
    return search.surrounded && expandPolytope(pair, search.corner, x, bound, work);
  };
  const auto fromTop = [&] { return expandPolytope(pair, x, bound, work); };
  if (!fromTop() && !fromCorners()) leastPenetration(pair, x, work);
  if (x.core > 0.0) return climb(pair, x, work);
  ascend(pair, x, work);
  return {x, DistanceStatus::local, bound};
}

}  // namespace

FCL_STPBV_VECTORIZED
void searchWidely(const BodyPair& pair, const Start& start, bool settled, Found& found, Work& work) {
  if (settled && overlapAround(pair, found, work)) return;
  const VertexSearch search = searchVertices(pair, start.n);
  if (polyhedralStart(pair, search, found, work)) return;
  if (search.surrounded) {
    found = solveOverlap(pair, start.n, start.patch, search, work);
    return;
  }
  Sample x = pair.sampleFrom(start.n, start.patch, work.steps);
  switch (separateCores(pair, x, work)) {
    case CoreContact::apart:
      found = climb(pair, x, work);
      break;
    case CoreContact::touching:
      found = {x, DistanceStatus::exact, 0.0};
      break;
    case CoreContact::overlap:
      found = solveOverlap(pair, x.n, x.patch, search, work);
  }
}

}  // namespace fcl_stpbv
