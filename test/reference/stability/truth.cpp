// STP-BVs: 1. The distance of reference.h, if its own gap proves it. 2. Otherwise, for example if cores
// overlap, the widest gap over a spiral of directions, with the best ones refined. Polyhedra: 1. The nearest
// difference by polyhedra.h. 2. If they share a point, their least overlap.
#include "test/reference/stability/truth.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "test/reference/stability/polyhedra.h"

namespace fcl_stpbv::stability {

using Eigen::Vector3d;
using test::ReferenceBody;

namespace {

// If the bodies are deep in each other, many directions are tried, and the best ones are improved in steps
// down to kFinest. A step changes the gap by its square times the big radius.
constexpr int kDirections = 400, kClimbs = 4, kMoves = 60;
constexpr long double kFinest = 1e-6L;

ReferenceBody placed(const Body& body, const Eigen::Isometry3d& pose) {
  return test::referenceBody(body.smooth->volume().vertices(), body.radii.r, body.radii.R, pose);
}

/// Both bodies with the first one's position as origin, because the difference of two doubles is exact in
/// long double.
struct Pair {
  ReferenceBody a, b;
  Vector3L centres;  ///< from the middle of a's points to that of b's
};

Vector3L middle(const std::vector<Vector3L>& points) {
  Vector3L sum(0, 0, 0);
  for (const Vector3L& p : points) sum += p;
  return sum / static_cast<long double>(points.size());
}

Pair pairOf(const Situation& s, const Placement& at) {
  const Vector3L offset = at.b.translation().cast<long double>() - at.a.translation().cast<long double>();
  Eigen::Isometry3d qa = at.a, qb = at.b;
  qa.translation().setZero();
  qb.translation().setZero();
  Pair pair{placed(*s.a, qa), placed(*s.b, qb), {0, 0, 0}};
  for (Vector3L& p : pair.b.points) p += offset;
  pair.centres = middle(pair.b.points) - middle(pair.a.points);
  return pair;
}

/// A direction less than a right angle from every normal along which the cores are apart. The difference of
/// the core points of any normal is one, because along such a normal it is at least as long as their gap.
Vector3L towardsAllGaps(const Situation& s, const Pair& pair) {
  Vector3L n = s.towards.isZero() ? pair.centres : Vector3L(s.towards.cast<long double>());
  if (!(n.norm() > 0)) n = Vector3L::UnitX();
  n.normalize();
  Vector3L ya, yb;
  referenceSupport(pair.a, n, &ya);
  referenceSupport(pair.b, -n, &yb);
  const Vector3L d = yb - ya;
  return d.dot(n) > 0 || !(d.norm() > 0) ? n : Vector3L(d.normalized());
}

/// Climbs from `n` by shorter and shorter steps across it, in eight directions each.
long double climbed(const Pair& pair, Vector3L n) {
  long double best = referenceGap(pair.a, pair.b, n);
  for (long double step = 0.05L, left = kMoves; step > kFinest && left > 0; --left) {
    const Vector3L x = n.unitOrthogonal(), y = n.cross(x);
    bool better = false;
    for (int k = 0; k < 8; ++k) {
      const long double angle = 0.7853981633974483L * k;
      const Vector3L m = (n + step * (std::cos(angle) * x + std::sin(angle) * y)).normalized();
      const long double gap = referenceGap(pair.a, pair.b, m);
      if (gap > best) best = gap, n = m, better = true;
    }
    if (!better) step /= 3;
  }
  return best;
}

}  // namespace

SmoothTruth smoothTruth(const Situation& s, const Placement& at) {
  const Pair pair = pairOf(s, at);
  const long double size = static_cast<long double>(sizeOf(s, at));
  SmoothTruth truth;
  const test::ReferenceDistance found = referenceDistance(pair.a, pair.b, towardsAllGaps(s, pair));
  // Proven if the points' distance exceeds the planes' gap by no more than rounding.
  if (std::isfinite(static_cast<double>(found.distance)) && found.gap <= 1e-15L * size) {
    truth.known = true;
    truth.distance = found.distance;
    truth.normal = found.normal;
    return truth;
  }
  truth.widest = -std::numeric_limits<long double>::infinity();
  std::vector<std::pair<long double, Vector3L>> tried;
  const long double golden = std::acos(-1.0L) * (3 - std::sqrt(5.0L));
  for (int i = 0; i < kDirections; ++i) {
    const long double z = 1 - (2 * i + 1) / static_cast<long double>(kDirections), w = std::sqrt(1 - z * z);
    const Vector3L n(w * std::cos(golden * i), w * std::sin(golden * i), z);
    tried.emplace_back(referenceGap(pair.a, pair.b, n), n);
  }
  const Vector3L hint = s.towards.cast<long double>();
  if (!hint.isZero()) tried.emplace_back(referenceGap(pair.a, pair.b, hint.normalized()), hint.normalized());
  std::partial_sort(tried.begin(), tried.begin() + kClimbs, tried.end(),
                    [](const auto& x, const auto& y) { return x.first > y.first; });
  for (int i = 0; i < kClimbs; ++i)
    truth.widest = std::max(truth.widest, climbed(pair, tried[static_cast<std::size_t>(i)].second));
  return truth;
}

SharpTruth sharpTruth(const Situation& s, const Placement& at) {
  const std::vector<Vector3L> a = placedCorners(s.a->corners, at.a, at.a.translation());
  const std::vector<Vector3L> b = placedCorners(s.b->corners, at.b, at.a.translation());
  const Nearest nearest = nearestDifference(a, b);
  SharpTruth truth;
  truth.overlap = nearest.overlap;
  if (nearest.difference.norm() <= 1e-15L * static_cast<long double>(sizeOf(s, at)) && !nearest.overlap) {
    truth.known = true;  // they touch, to rounding
  } else if (!nearest.overlap) {
    truth.known = nearest.proven;
    truth.distance = nearest.difference.norm();
    truth.normal = nearest.difference / truth.distance;
  } else if (std::optional<long double> depth = leastOverlap(a, b)) {
    truth.known = true;
    truth.distance = -*depth;
  }
  return truth;
}

long double smoothGap(const Situation& s, const Placement& at, const Vector3d& normal) {
  const Pair pair = pairOf(s, at);
  return referenceGap(pair.a, pair.b, normal.cast<long double>().normalized());
}

}  // namespace fcl_stpbv::stability
