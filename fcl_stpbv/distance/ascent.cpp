// Ascent of the gap s(n) over the sphere of normals (docs/theory.md, 5).
//
// 1. Solve the pair of patches that own the normal. If its widest normal is
//    in both regions, that is a maximum.
// 2. Otherwise move towards it along a great circle as long as the gap grows, to where its slope is about
//    zero. Repeat.
// 3. If the gap grows by less than its rounding, try the patches beyond the region boundaries on the way.
//    Last, bisect the remaining directions, which cannot fail (convex/direction_cone.h).
#include "fcl_stpbv/distance/ascent.h"

#include <cmath>

#include "fcl_stpbv/convex/direction_cone.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

constexpr int kMaxPairs =
    40;  // two to four are usual; docs/theory.md, 5 describes what follows if they are not enough

/// Slope of the gap at `m` along the great circle with this pole.
double slopeAlong(const Sample& m, const Vector3d& pole) { return m.across.dot(pole.cross(m.n)); }

/// A normal on the arc from `x` towards `to` where the gap has grown and its slope along the
/// arc is about zero. The slope is continuous, so a bracket of its change of sign contains a maximum. Returns
/// `x` itself if the gap cannot grow.
Sample ascendArc(const BodyPair& pair, const Sample& x, const Vector3d& to, const Sample* atEnd,
                 SearchWork& work) {
  constexpr int kTrials = 60;     // enough for bisection alone to go from 1 rad to an ulp
  constexpr double kFlat = 0.05;  // of the slope at the start; the next patch pair solves for the rest
  const Vector3d cross = x.n.cross(to);
  const double sine = cross.norm();
  if (sine < 1e-16) return x;
  const Vector3d pole = cross / sine;

  const double startSlope = slopeAlong(x, pole);
  if (!(startSlope > 0.0)) return x;
  Sample low = x, high = atEnd ? *atEnd : pair.sampleFrom(to, x.patch, work.steps);
  double lowAt = 0.0, highAt = 1.0;
  double lowSlope = startSlope, highSlope = slopeAlong(high, pole);
  if (high.core > x.core && highSlope >= 0.0) return high;
  double lowWeight = lowSlope,
         highWeight = highSlope;  // the Illinois method halves the weight of the end that stays
  int lastSide = 0;
  for (int i = 0; i < kTrials; ++i) {
    double at = 0.5 * (lowAt + highAt);
    if (highSlope < 0.0 && i % 4 != 3) at = lowAt + (highAt - lowAt) * lowWeight / (lowWeight - highWeight);
    if (!(at > lowAt && at < highAt)) break;
    const Vector3d m = ((1.0 - at) * x.n + at * to).normalized();
    const Sample mid = pair.sampleFrom(m, low.patch, work.steps);
    const double slope = slopeAlong(mid, pole);
    const bool grew = mid.core > x.core;
    if (grew && std::abs(slope) <= kFlat * startSlope) return mid;
    if (grew && slope > 0.0) {
      low = mid;
      lowAt = at;
      lowSlope = lowWeight = slope;
      if (lastSide == 1) highWeight *= 0.5;
      lastSide = 1;
    } else {
      high = mid;
      highAt = at;
      highSlope = highWeight = slope;
      if (lastSide == -1) lowWeight *= 0.5;
      lastSide = -1;
    }
  }
  return high.core > low.core ? high : low;
}

DirectionTrial asTrial(const Sample& s) { return {s.n, s.core, s.core * s.n + s.across}; }

}  // namespace

FCL_STPBV_VECTORIZED
bool settle(const BodyPair& pair, Sample& x, Vector3d& next, SearchWork& work) {
  const PosedPatch a = pair.patchA(x.patch[0]), b = pair.patchB(x.patch[1]);
  Packed n = pack(x.n);
  ++work.pairs;
  for (int attempt = 0; attempt < 2; ++attempt) {  // two tori may need a second solve for the last digits
    n = widestNormal(a, b, n).unit();
    next = unpack(n);
    if (pair.tablesA().patches.crossing(x.patch[0], n).past > kOnBoundary ||
        pair.tablesB().patches.crossing(x.patch[1], pair.opposite(n)).past > kOnBoundary)
      return false;
    const Sample there = BodyPair::sample(n, x.patch, a, b);
    // At deep overlap the pair's other maximum may lie in the same regions;
    // moving there must not lower the gap.
    if (there.core < x.core - pair.gapRounding()) return false;
    if (pair.isStationary(there)) {
      x = there;
      return true;
    }
  }
  return false;
}

bool settleBeside(const BodyPair& pair, Sample& x, SearchWork& work) {
  Vector3d next;
  if (settle(pair, x, next, work)) return true;
  const Vector3d opposite = pair.opposite(next);
  const auto tryBeside = [&](int patchA) {
    const auto tryPair = [&](int patchB) {
      Sample y = x;
      y.patch = {patchA, patchB};
      Vector3d ignored;
      if (!settle(pair, y, ignored, work)) return false;
      x = y;
      return true;
    };
    if (patchA != x.patch[0] && tryPair(x.patch[1])) return true;
    for (const RegionBoundary s : pair.tablesB().patches.boundaries(x.patch[1]))
      if (opposite.dot(s.normal) > s.limit && tryPair(s.neighbour)) return true;
    return false;
  };
  if (tryBeside(x.patch[0])) return true;
  for (const RegionBoundary s : pair.tablesA().patches.boundaries(x.patch[0]))
    if (next.dot(s.normal) > s.limit && tryBeside(s.neighbour)) return true;
  return false;
}

FCL_STPBV_VECTORIZED
bool ascend(const BodyPair& pair, Sample& x, SearchWork& work) {
  for (int i = 0; i < kMaxPairs; ++i) {
    Vector3d next;
    if (settle(pair, x, next, work)) return true;
    if (pair.isStationary(x)) return true;  // a maximum on a region boundary, up to rounding

    Sample y;
    if (next.dot(x.n) > 0.1) {
      const Sample atEnd = pair.sampleFrom(next, x.patch, work.steps);
      y = ascendArc(pair, x, next, &atEnd, work);
    } else {
      y = x;
    }
    if (!(y.core > x.core)) {
      // The pair's maximum is not uphill. This happens only for deep overlaps and at the rounding level.
      // Follow the gradient instead.
      y = ascendArc(pair, x, (x.n + x.across.normalized()).normalized(), nullptr, work);
      if (!(y.core > x.core)) return false;
    }
    x = y;
  }
  return false;
}

CoreContact separateCores(const BodyPair& pair, Sample& x, SearchWork& work) {
  const double touch = pair.gapRounding();
  Sample trial = x;
  const auto touches = [&] { return asTrial(trial).difference.norm() <= touch; };
  if (trial.core > touch) return CoreContact::apart;
  if (touches()) return CoreContact::touching;

  bisectDirections(
      asTrial(trial), 0.0,
      [&](const Vector3d& n) {
        trial = pair.sampleFrom(n, trial.patch, work.steps);
        if (trial.core > x.core) x = trial;
        return asTrial(trial);
      },
      [&](const DirectionTrial&) { return x.core > touch || touches(); });
  if (x.core > touch) return CoreContact::apart;
  if (!touches()) return CoreContact::overlap;
  x = trial;
  return CoreContact::touching;
}

bool bisectToWidest(const BodyPair& pair, Sample& x, SearchWork& work) {
  Sample flattest = x, trial = x;
  bool settled = false;
  bisectDirections(
      asTrial(x), 0.0,
      [&](const Vector3d& n) {
        trial = pair.sampleFrom(n, x.patch, work.steps);
        if (trial.core > x.core) x = trial;
        if (trial.core > 0.0 && trial.across.squaredNorm() < flattest.across.squaredNorm()) flattest = trial;
        return asTrial(trial);
      },
      [&](const DirectionTrial&) {
        if (pair.isStationary(flattest)) return true;
        Vector3d next;
        settled = trial.core > 0.0 && settle(pair, trial, next, work);
        return settled;
      });
  if (settled) {
    x = trial;
    return true;
  }
  // The gap is flat at its maximum. So if two values are equal up to rounding, the gradient decides which
  // normal is better.
  if (flattest.core >= x.core - pair.gapRounding()) x = flattest;
  return pair.isStationary(x);
}

}  // namespace fcl_stpbv::detail
