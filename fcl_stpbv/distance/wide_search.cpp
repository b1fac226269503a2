// The full search for the widest gap of two STP-BVs, for the few pairs in which the feature walk fails.
//
// 1. A maximum between cores that overlap: prove that it is the widest, or find the one that is (overlap.h).
// 2. GJK on the vertices gives the polyhedra's closest features, whose patches
//    are a start (paper IV.B). Solve there.
// 3. Else ascend from there (ascent.h).
// 4. If the origin is inside the difference of the vertex sets, the cores overlap: go to step 1 from there.
// 5. If both fail because of rounding, bisect the remaining directions. The result is a plane between the
//    cores, a common point, or overlap.
#include "fcl_stpbv/distance/wide_search.h"

#include "fcl_stpbv/distance/overlap.h"
#include "fcl_stpbv/distance/vertex_gjk.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

/// The widest gap, from any start along which the cores are apart.
WidestGap ascendToWidest(const BodyPair& pair, Sample x, SearchWork& work) {
  if (!ascend(pair, x, work) && !settleBeside(pair, x, work)) bisectToWidest(pair, x, work);
  return {x, pair.isStationary(x) ? DistanceStatus::exact : DistanceStatus::bounded, 0.0};
}

/// Searches from the patches of the polyhedra's closest features (paper IV.B). False if they have no gap.
bool polyhedralStart(const BodyPair& pair, const VertexGjk& search, WidestGap& found, SearchWork& work) {
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
  found = ascendToWidest(pair, x, work);
  return true;
}

/// For cores that overlap, from a maximum in `found`: the widest gap. False if the polytope does not prove
/// it.
bool overlapAround(const BodyPair& pair, WidestGap& found, SearchWork& work) {
  found.status = DistanceStatus::local;
  const bool proven = expandPolytope(pair, found.at, found.bound, work);
  if (found.at.core > 0.0) {
    found = ascendToWidest(pair, found.at, work);
    return true;
  }
  if (!proven) return false;
  if (!pair.isStationary(found.at))
    ascend(pair, found.at, work);  // the polytope found only a normal near the maximum
  return found.at.core <= 0.0;
}

/// For cores that overlap: the shortest separating translation, from any normal. The corners of `search` are
/// a start if they surround the origin.
WidestGap solveOverlap(const BodyPair& pair, const Vector3d& n, const std::array<int, 2>& patch,
                       const VertexGjk& search, SearchWork& work) {
  Sample x = pair.sampleFrom(n, patch, work.steps);
  Vector3d ignored;
  settle(pair, x, ignored, work);
  if (x.core > 0.0) return ascendToWidest(pair, x, work);  // apart by less than the rounding of GJK
  double bound = 0.0;
  const auto fromCorners = [&] {
    return search.surrounded && expandPolytope(pair, search.corner, x, bound, work);
  };
  const auto fromTop = [&] { return expandPolytope(pair, x, bound, work); };
  if (!fromTop() && !fromCorners()) leastPenetration(pair, x, work);
  if (x.core > 0.0) return ascendToWidest(pair, x, work);
  ascend(pair, x, work);
  return {x, DistanceStatus::local, bound};
}

}  // namespace

FCL_STPBV_VECTORIZED
void searchWidely(const BodyPair& pair, const SearchStart& start, bool settled, WidestGap& found,
                  SearchWork& work) {
  if (settled && overlapAround(pair, found, work)) return;
  const VertexGjk search = vertexGjk(pair, start.n);
  if (polyhedralStart(pair, search, found, work)) return;
  if (search.surrounded) {
    found = solveOverlap(pair, start.n, start.patch, search, work);
    return;
  }
  Sample x = pair.sampleFrom(start.n, start.patch, work.steps);
  switch (separateCores(pair, x, work)) {
    case CoreContact::apart:
      found = ascendToWidest(pair, x, work);
      break;
    case CoreContact::touching:
      found = {x, DistanceStatus::exact, 0.0};
      break;
    case CoreContact::overlap:
      found = solveOverlap(pair, x.n, x.patch, search, work);
  }
}

}  // namespace fcl_stpbv::detail
