// Exact signed distance of two STP-BVs by a feature walk over their patches (docs/theory.md, 5).
//
// Mirtich's V-Clip walks the Voronoi regions of two polyhedra's features (ACM Transactions on Graphics 17(3),
// 1998); the smooth Voronoi regions of an STP-BV are regions of normals, its patches' normal cones.
// 1. Start from the last answer's patches, else from the line of centres.
// 2. Solve the pair of patches: the normal of its widest gap, in closed form or
//    by two Newton passes (patch_pair.h).
// 3. If that normal is in both normal cones, it is the answer while the cores are
//    apart: any maximum is the only one.
// 4. Else cross the one region boundary, on either body, that it passes furthest, and go to 2.
// 5. If the pair has no maximum on this side of the sphere, go uphill to the first boundary on the way.
// 6. After a dozen pairs, or if the cores overlap, the full search takes over (wide_search.h).
// This walk is separate from GJK and EPA for speed: each step evaluates one closed form and no support
// function.
#include "fcl_stpbv/distance/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/distance/ascent.h"
#include "fcl_stpbv/distance/body_pair.h"
#include "fcl_stpbv/distance/overlap.h"
#include "fcl_stpbv/distance/wide_search.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

using namespace detail;

/// `n` scaled to unit length, without a square root if it is almost of unit length.
Packed renormalized(const Packed& n) {
  const double length2 = dot(n, n);
  return n * (std::abs(length2 - 1.0) < 1e-8 ? 1.5 - 0.5 * length2 : 1.0 / std::sqrt(length2));
}

/// A start for bodies near each other, for which the line of centres is a poor start. For two long or flat
/// bodies whose enclosing balls meet, it comes from their bounding boxes. For other bodies that overlap
/// deeply (their inner balls overlap), it comes from the faces near their centres.
[[gnu::noinline]] bool startNear(const BodyPair& pair, const Packed& between, Sample& start) {
  const double between2 = dot(between, between), inside = pair.a().innerRadius() + pair.b().innerRadius(),
               around = pair.a().enclosingRadius() + pair.b().enclosingRadius();
  if (pair.tablesA().box.isTelling && pair.tablesB().box.isTelling && between2 < around * around)
    start = boxStart(pair);
  else if (between2 < inside * inside)
    start = shallowStart(pair);
  else
    return false;
  return true;
}

/// The first guess without a cache: usually the line of centres. The tables take a direction that is not
/// normalised, so that the lookup need not wait for the square root.
SearchStart fromCentres(const BodyPair& pair) {
  const Packed between = pair.centreDifference();
  const double inside = pair.a().innerRadius() + pair.b().innerRadius();
  if (dot(between, between) < inside * inside || pair.tablesA().box.isTelling) {
    Sample start;
    if (startNear(pair, between, start)) return {start.n, start.patch, false};
  }
  const UnnormalizedNormal h = unnormalizedOr(between, Packed{1, 0, 0, 0});
  return {unpack(h.unit()), pair.near(unpack(h.d)), false};
}

/// A patch near the owner of the unit normal `now`, given the owner of the normal `then`. It is that patch
/// itself, or, if the normal has turned by more than a patch, the neighbour over the boundary that `now`
/// violates most. -1 after a large turn.
int nearby(const StpBv& body, int patch, const Packed& now, const Eigen::Vector3f& then) {
  constexpr double kLarge = 0.1;  // rad
  constexpr double kWide = 3.0;   // squared turn times the number of patches: about a quarter of the sphere
  if (patch < 0 || patch >= body.patchCount()) return -1;
  if (then.isZero()) return patch;
  const Packed turn = now - pack(then.cast<double>());
  const double turn2 = dot(turn, turn);
  if (!(turn2 <= kLarge * kLarge)) return -1;
  if (turn2 * body.patchCount() <= kWide) return patch;
  const Crossing over = body.tables().patches.crossing(patch, now);
  return over.past > 0.0 ? over.neighbour : patch;
}

SearchStart startOf(const BodyPair& pair, const Rotation& toWorld, const PairCache* cache) {
  const Packed last = cache ? toWorld.inverse(pack(cache->normal)) : Packed{};
  const double length2 = dot(last, last);
  if (PairCache::isDirection(length2)) {
    const Packed n = renormalized(last);
    const std::array<int, 2> patch{nearby(pair.a(), cache->patch[0], n, cache->seen[0]),
                                   nearby(pair.b(), cache->patch[1], pair.opposite(n), cache->seen[1])};
    if (patch[0] >= 0 && patch[1] >= 0) return {unpack(n), patch, true};
  }
  return fromCentres(pair);
}

/// The state of the feature walk: a patch of each body, and a normal.
struct SearchState {
  std::array<int, 2> patch;
  PosedPatch a, b;
  Packed n;
  bool far;  ///< far from the last query's patches, so nothing here was prefetched

  void cross(const BodyPair& pair, const Crossing& overA, const Crossing& overB) {
    if (overA.past >= overB.past) {
      a = pair.patchA(patch[0] = overA.neighbour);
      if (far) pair.tablesA().patches.prefetchBeside(patch[0]);
    } else {
      b = pair.patchB(patch[1] = overB.neighbour);
      if (far) pair.tablesB().patches.prefetchBeside(patch[1]);
    }
  }

  /// Crosses the first boundary uphill. For patches whose gap has its maximum far away, or has none on this
  /// side of the sphere, as with two vertices that overlap. Along an edge the gap is curved so strongly that
  /// only the direction across the edge is used. False if no boundary is ahead.
  bool crossUphill(const BodyPair& pair) {
    Packed up = coreGap(a, b, n).across;
    for (const PosedPatch* p : {&a, &b})
      if (p->kind == PatchKind::edge) up -= dot(up, p->axis) * p->axis;
    const Packed h = unnormalizedOr(up, n).unit();
    const Crossing overA = pair.tablesA().patches.ahead(patch[0], n, h),
                   overB = pair.tablesB().patches.ahead(patch[1], pair.opposite(n), pair.opposite(h));
    const double nearness = std::max(overA.past, overB.past);
    if (!(nearness > std::numeric_limits<double>::min())) return false;
    n = unnormalizedOr(nearness * n + h, n).unit();
    cross(pair, overA, overB);
    return true;
  }
};

/// The feature walk: from the given patch pair, it crosses the region boundary that the widest normal
/// violates most, on either body, to the next pair, without evaluating the gap. For cores that are apart, a
/// maximum that it finds is the only one. If it finds none, nothing is proven.
bool walkFeatures(const BodyPair& pair, const SearchStart& start, WidestGap& found, SearchWork& work) {
  constexpr int kTries = 12;    // one to three are usual
  constexpr double kFar = 0.3;  // cosine of the turn above which the boundary passed furthest means little
  SearchState at{start.patch, pair.patchA(start.patch[0]), pair.patchB(start.patch[1]), pack(start.n),
                 !start.near};
  if (at.far) {
    pair.tablesA().patches.prefetchBeside(at.patch[0]);
    pair.tablesB().patches.prefetchBeside(at.patch[1]);
  }
  for (int i = 0; i < kTries; ++i) {
    ++work.pairs;
    const UnnormalizedNormal to = widestNormal(at.a, at.b, at.n);
    const Crossing overA = pair.tablesA().patches.crossing(at.patch[0], to.d, to.length),
                   overB = pair.tablesB().patches.crossing(at.patch[1], pair.opposite(to.d), to.length);
    const bool straysFar = !(dot(to.d, at.n) > kFar * to.length);
    const double past = std::max(overA.past, overB.past);
    if (past <= kOnBoundary * to.length) {
      at.n = to.unit();
      found.at = BodyPair::sample(at.n, at.patch, at.a, at.b);
      if (pair.isStationary(found.at)) return true;
      continue;  // two tori may need a second solve for the last digits
    }
    ++work.steps;
    if (!straysFar) {
      at.n = to.unit();
      at.cross(pair, overA, overB);
    } else if (!at.crossUphill(pair)) {
      return false;
    }
  }
  return false;
}

/// Upper bound on the gap of the cores (m): the distance of the two core points, or, for overlapping cores,
/// the bound that the search has proven. A normal is accurate only to an ulp, so a core point may be
/// displaced along the surface by up to `acrossRounding`.
[[gnu::noinline]] double mostGap(const BodyPair& pair, const WidestGap& found) {
  const Sample& at = found.at;
  const double beside = pair.acrossRounding();
  if (found.status == DistanceStatus::local)
    return std::max(found.bound, at.core) + (at.core > -pair.touching() ? beside : 0.0);
  return std::hypot(at.core, at.across.norm() + beside);
}

}  // namespace

FCL_STPBV_VECTORIZED
Distance distance(const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB,
                  PairCache* cache) {
  Distance result;
  const RelativePose pose(poseA, poseB);
  if (!pose.valid) return result;

  const BodyPair pair(a, b, pose);
  const SearchStart start = startOf(pair, pose.toWorld, cache);
  WidestGap found;
  SearchWork work;
  const bool settled = walkFeatures(pair, start, found, work);
  if (settled && start.near) {  // the data around an unchanged patch has been prefetched
    if (found.at.patch[0] != cache->patch[0]) a.tables().patches.prefetchAround(found.at.patch[0]);
    if (found.at.patch[1] != cache->patch[1]) b.tables().patches.prefetchAround(found.at.patch[1]);
  }
  const bool apart = settled && found.at.core > pair.touching();
  if (!apart) searchWidely(pair, start, settled && found.at.core < -pair.touching(), found, work);

  const Sample& at = found.at;
  result.status = found.status;
  const double upper = apart ? std::sqrt(at.core * at.core + at.across.squaredNorm()) : mostGap(pair, found);
  result.distance = at.core - pair.margins();
  result.lower = result.distance - pair.certificateRounding();
  result.upper = upper - pair.margins() + 2.0 * pair.certificateRounding();
  result.patch = at.patch;
  const Packed n = pack(at.n), pointA = pack(at.point), pointB = pointA + pack(at.across) + at.core * n;
  result.normal = unpack(renormalized(pose.toWorld * n));
  result.point[0] = unpack(pose.origin + pose.toWorld * (pointA + a.radii().r * n));
  result.point[1] = unpack(pose.origin + pose.toWorld * (pointB - b.radii().r * n));
  result.patchPairs = work.pairs;
  result.patchSteps = work.steps;
  if (cache) {
    cache->normal = result.normal;
    cache->patch = result.patch;
    cache->seen = {unpack(n).cast<float>(), unpack(pair.opposite(n)).cast<float>()};
  }
  return result;
}

}  // namespace fcl_stpbv
