// GJK: the point of a convex set nearest to the origin (Gilbert, Johnson, Keerthi 1988).
//
// The set is the Minkowski difference B - A of two bodies' cores. Only its support points are used:
// 1. Begin with a few points of the difference, or with the one that is furthest against the first normal.
// 2. Find the point v of their simplex nearest to the origin, and drop the corners that do not contribute to
//    v. A tetrahedron around the origin proves that the bodies overlap.
// 3. |v| is an upper bound on the distance, because it is the distance of two points. The unit normal n along
//    v gives a lower bound n.w, where w is the support point of the difference along -n. It is the gap of two
//    supporting planes.
// 4. Stop if the two bounds agree (duality gap), if the caller stops the search, or if rounding allows no
//    improvement. Otherwise add w to the simplex and go to 2.
// The duality gap proves the result. FCL's own criterion, two norms that agree, does not (docs/fcl.md).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>
#include <utility>

#include "fcl_stpbv/convex/simplex.h"

namespace fcl_stpbv::detail {

/// What GJK found.
template <typename Corner>
struct GjkResult {
  enum class Verdict {
    apart,    ///< `v` is the nearest point, within the bounds
    overlap,  ///< the origin is inside, or within rounding of the set
    capped,   ///< the limit of steps was reached
  };
  Verdict verdict = Verdict::capped;
  Simplex<Corner>
      simplex;  ///< holds `v`; at overlap four corners around the origin, if the search had as many
  Eigen::Vector3d v{0, 0, 0};                               ///< the difference's point nearest to the origin
  Eigen::Vector3d n{0, 0, 0};                               ///< unit, from A to B, along `v`
  double lower = -std::numeric_limits<double>::infinity();  ///< widest gap seen along any normal (m)
  Eigen::Vector3d widest{0, 0, 0};  ///< its normal; zero if the gap is that of a corner of `start`
  double upper = std::numeric_limits<double>::infinity();  ///< least distance of two points seen, `|v|` (m)
};

/// Runs GJK from the corners in `start` (none to four) and the unit normal `n`.
///
/// `difference.support(n)` returns the support corner along -n: its point `w`, and `gap`, which is n.w as
/// accurately as the bodies can compute it. A corner that was found in another way has the gap minus
/// infinity. `enough(lower, upper)` returns true to end the search. Cores within `rounding` (m) of overlap
/// count as overlapping.
template <typename Corner, typename Difference, typename Enough>
GjkResult<Corner> gjk(Difference& difference, const Simplex<Corner>& start, const Eigen::Vector3d& n,
                      double rounding, int steps, const Enough& enough) {
  using Verdict = typename GjkResult<Corner>::Verdict;
  GjkResult<Corner> result;
  result.n = n;
  Simplex<Corner> one = start, other;  // they take turns, which copies less
  Simplex<Corner>*simplex = &one, *reduced = &other;
  const auto finished = [&](Verdict verdict) {
    result.simplex = *simplex;
    result.verdict = verdict;
    return result;
  };
  if (simplex->size == 0) {
    simplex->add(difference.support(n));
    result.widest = n;
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(simplex->size); ++i)
    result.lower = std::max(result.lower, simplex->corner[i].gap);
  for (int step = 0; step < steps; ++step) {
    const NearestPoint nearest = reduceToNearest(*simplex, *reduced);
    const double length = nearest.point.norm();
    if (nearest.inside || !(length > rounding)) return finished(Verdict::overlap);
    if (!(length < result.upper)) {  // rounding: no improvement
      --simplex->size;               // the new corner
      return finished(Verdict::apart);
    }
    std::swap(simplex, reduced);
    result.v = nearest.point;
    result.upper = length;
    const bool hasDirection = nearest.direction.squaredNorm() > std::numeric_limits<double>::min();
    result.n = (hasDirection ? nearest.direction : nearest.point).normalized();
    if (enough(result.lower, result.upper)) return finished(Verdict::apart);
    const Corner next = difference.support(result.n);
    if (next.gap > result.lower) {
      result.lower = next.gap;
      result.widest = result.n;
    }
    if (enough(result.lower, result.upper) || simplex->holds(next.w)) return finished(Verdict::apart);
    simplex->add(next);
  }
  --simplex->size;
  return finished(Verdict::capped);
}

}  // namespace fcl_stpbv::detail
