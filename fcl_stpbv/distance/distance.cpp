#include "fcl_stpbv/distance/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/distance/ascent.h"
#include "fcl_stpbv/distance/body_pair.h"
#include "fcl_stpbv/distance/expanding_polytope.h"
#include "fcl_stpbv/distance/penetration.h"
#include "fcl_stpbv/distance/polytope_search.h"
#include "fcl_stpbv/distance/separation.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Makes a nearly orthonormal matrix orthonormal: poses come from integrated joints, files and single
/// precision. False for a matrix that is not finite or no rotation.
bool orthonormalize(Matrix3d& q) {
  constexpr double kFine = 2e-15, kOneStep = 1e-8, kRotation = 0.1;
  for (int i = 0; i < 5; ++i) {
    const Vector3d x = q.col(0), y = q.col(1), z = q.col(2);
    const double xx = x.dot(x) - 1.0, yy = y.dot(y) - 1.0, zz = z.dot(z) - 1.0;
    const double xy = x.dot(y), yz = y.dot(z), zx = z.dot(x);
    const double off2 = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx);
    if (!(off2 < kRotation * kRotation)) return false;  // also what is not a number
    if (off2 <= kFine * kFine) return true;
    // Newton for the polar factor, q (3 - q^T q) / 2: the error squares.
    q.col(0) -= 0.5 * (xx * x + xy * y + zx * z);
    q.col(1) -= 0.5 * (xy * x + yy * y + yz * z);
    q.col(2) -= 0.5 * (zx * x + yz * y + zz * z);
    if (off2 <= kOneStep * kOneStep) return true;
  }
  return true;
}

/// `n` of unit length, without the root where it is already close.
Vector3d renormalized(const Vector3d& n) {
  const double length2 = n.squaredNorm();
  return std::abs(length2 - 1.0) < 1e-8 ? Vector3d((1.5 - 0.5 * length2) * n) : n.normalized();
}

/// The first guess when nothing is remembered: from centre to centre.
Vector3d centreLine(const BodyPair& pair) {
  const Vector3d d = pair.rotation() * pair.b().centre() + pair.translation() - pair.a().centre();
  const double length = d.norm();
  return length > 0.0 ? Vector3d(d / length) : Vector3d::UnitX();
}

constexpr std::array<int, 2> kNoHint{-1, -1};

struct Found {
  Sample at;
  DistanceStatus status;
  double bound = 0.0;  ///< for cores that overlap: along no normal is their gap wider (m)
};

/// A start for `settle` that any gap is better than.
Sample unevaluated(const Vector3d& n, const std::array<int, 2>& patch) {
  return {n, patch, -std::numeric_limits<double>::infinity(), Vector3d(0, 0, 0), Vector3d(0, 0, 0)};
}

/// From any start along which the cores are apart: the widest gap.
Found climb(const BodyPair& pair, Sample x, Work& work) {
  if (!ascend(pair, x, work) && !settleBeside(pair, x, work)) bisectToWidest(pair, x, work);
  const bool flat = x.across.squaredNorm() <= pair.acrossRounding() * pair.acrossRounding();
  return {x, flat ? DistanceStatus::exact : DistanceStatus::bounded};
}

/// From the polyhedra's closest features to the smooth ones (paper IV.B), and on from there.
bool polyhedralStart(const BodyPair& pair, const VertexSearch& search, Found& found, Work& work) {
  if (!search.apart) return false;
  const Vector3d& n = search.n;
  Sample x = unevaluated(
      n, {pair.a().owner(n, search.vertex[0]), pair.b().owner(pair.opposite(n), search.vertex[1])});
  work.steps += (x.patch[0] != search.vertex[0]) + (x.patch[1] != search.vertex[1]);
  Vector3d ignored;
  if (settle(pair, x, ignored, work) && x.core > 0.0) {
    found = {x, DistanceStatus::exact};
    return true;
  }
  x = pair.sample(n, x.patch);
  if (!(x.core > 0.0)) return false;
  found = climb(pair, x, work);
  return true;
}

/// Cores that overlap, from a normal with its gap: their widest gap as far as the polytope around that normal
/// proves it.
bool overlapAround(const BodyPair& pair, Sample x, Found& found, Work& work) {
  found = {x, DistanceStatus::local};
  if (!(x.core < 0.0) || !expandPolytope(pair, found.at, found.bound, work)) return false;
  ascend(pair, found.at, work);  // a sample that the polytope met may be next to the top only
  return found.at.core <= 0.0;
}

/// Cores that overlap: the least separating translation, from any normal. A search that was not surrounded
/// has no corners to start from.
Found solveOverlap(const BodyPair& pair, const Vector3d& n, const std::array<int, 2>& patch,
                   const VertexSearch& search, Work& work) {
  Sample x = pair.sampleFrom(n, patch, work.steps);
  Vector3d ignored;
  const bool top = settle(pair, x, ignored, work);
  if (x.core > 0.0) return climb(pair, x, work);  // apart, by less than the search's rounding
  double bound = 0.0;
  const auto fromCorners = [&] {
    return search.surrounded && expandPolytope(pair, search.corner, x, bound, work);
  };
  const auto fromTop = [&] { return expandPolytope(pair, x, bound, work); };
  if (top ? !fromTop() && !fromCorners() : !fromCorners() && !fromTop()) leastPenetration(pair, x, work);
  if (x.core > 0.0) return climb(pair, x, work);
  ascend(pair, x, work);
  return {x, DistanceStatus::local, bound};
}

/// From the line of centres.
Found solveCold(const BodyPair& pair, Work& work) {
  const Vector3d n = centreLine(pair);
  Found found;
  const VertexSearch search = searchVertices(pair, n);
  if (polyhedralStart(pair, search, found, work)) return found;
  if (search.surrounded) return solveOverlap(pair, n, kNoHint, search, work);
  Sample x = pair.sampleFrom(n, kNoHint, work.steps);
  switch (separateCores(pair, x, work)) {
    case CoreContact::apart:
      return climb(pair, x, work);
    case CoreContact::touching:
      return {x, DistanceStatus::exact};
    case CoreContact::overlap:
      break;
  }
  return solveOverlap(pair, x.n, x.patch, search, work);
}

/// From what the last query left: first its patch pair, which most small motions keep, then its normal.
bool solveWarm(const BodyPair& pair, const Vector3d& normal, const std::array<int, 2>& patch, bool deep,
               Found& found, Work& work) {
  if (patch[0] >= pair.a().patchCount() || patch[1] >= pair.b().patchCount()) return false;
  const double length2 = normal.squaredNorm();
  if (!(length2 > 0.25 && length2 < 4.0)) return false;
  const Vector3d n = renormalized(normal);
  // In a small motion the bodies carry their patches along; in a large one the world's normal is the better
  // memory.
  constexpr double kSmallMotion =
      0.1;  // rad from the last normal to the region of the patch, which has moved
  const bool small = patch[0] >= 0 && patch[1] >= 0 && nearRegion(pair.a(), patch[0], n, kSmallMotion) &&
                     nearRegion(pair.b(), patch[1], pair.opposite(n), kSmallMotion);
  if (small) {
    Sample x = unevaluated(n, patch);
    Vector3d ignored;
    if (settle(pair, x, ignored, work)) {
      found = {x, DistanceStatus::exact};
      if (x.core > 0.0 || overlapAround(pair, x, found, work)) return true;
    } else if (deep && overlapAround(pair, pair.sampleFrom(n, patch, work.steps), found, work)) {
      return true;
    }
  }
  const VertexSearch search = small ? searchVertices(pair, n, patch) : searchVertices(pair, n);
  if (polyhedralStart(pair, search, found, work)) return true;
  if (search.surrounded) found = solveOverlap(pair, n, small ? patch : kNoHint, search, work);
  return search.surrounded;
}

}  // namespace

FCL_STPBV_VECTORIZED
Distance distance(const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB,
                  PairCache* cache) {
  constexpr double kHuge = 1e300;  // squares must not overflow
  Distance result;
  result.lower = -std::numeric_limits<double>::infinity();
  result.upper = std::numeric_limits<double>::infinity();
  Matrix3d rotation = poseA.linear().transpose() * poseB.linear();
  const Vector3d translation = poseA.linear().transpose() * (poseB.translation() - poseA.translation());
  if (!orthonormalize(rotation) || !(translation.squaredNorm() < kHuge)) return result;

  const BodyPair pair(a, b, rotation, translation);
  Work work;
  Found found;
  if (!cache ||
      !solveWarm(pair, poseA.linear().transpose() * cache->normal, cache->patch, cache->overlap, found, work))
    found = solveCold(pair, work);

  const Sample& x = found.at;
  result.status = found.status;
  result.lower = x.core - pair.margins();
  result.upper =
      (found.status == DistanceStatus::local ? std::max(found.bound, x.core)
                                             : std::sqrt(x.core * x.core + x.across.squaredNorm())) -
      pair.margins();
  result.distance = result.lower;
  result.patch = x.patch;
  result.normal = renormalized(poseA.linear() * x.n);
  result.point[0] = poseA * Vector3d(x.point + a.radii().r * x.n);
  result.point[1] = poseA * Vector3d(x.point + x.core * x.n + x.across - b.radii().r * x.n);
  result.patchPairs = work.pairs;
  result.patchSteps = work.steps;
  if (cache) {
    cache->normal = result.normal;
    cache->patch = result.patch;
    cache->overlap = x.core <= 0.0;
  }
  return result;
}

}  // namespace fcl_stpbv
