// Two simple shapes: GJK between their cores where these are apart, EPA where
// they overlap (convex/gjk.h, epa.h).
//
// 1. Put the pair into a canonical order, so that both orders of the arguments are the same query.
// 2. Half spaces and planes: the distance is the gap along their normal.
// 3. A ball and a shape of few features, two capsules, and most boxes: closed form (closed_forms.cpp).
// 4. Otherwise GJK. Its two starting points come from alternating projections onto both bodies. It stops by
//    the duality gap: the upper bound is the distance of two points of the bodies, the lower bound is the gap
//    between the two supporting planes of the normal.
// 5. Newton's method on the features gives the last digits (shape_newton.cpp), or, for nearly parallel faces,
//    level_faces.cpp. For overlap see shape_depth.cpp.
#include "fcl_stpbv/distance/shape_pair.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/convex/onto_core.h"
#include "fcl_stpbv/convex/vertex_cap.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace detail {

FCL_STPBV_VECTORIZED
Distance ShapePair::inWorld(const Vector3d& n, const Vector3d& onA, const Vector3d& toB) const {
  Distance result;
  result.normal = pose.normalInWorld(n);
  result.point = {pose.inWorld(onA + a.margin * n), pose.inWorld(onA + toB - b.margin * n)};
  return result;
}

ShapePair::Corner ShapePair::nearCorner(int rounds) const {
  constexpr double kGain = 0.996;  // a round that shortens the way by less is the last one
  Corner near;
  near.gap = -kInfinity;
  near.onA = a.centre;
  Vector3d onB = pose.placed(b.centre);
  double least2 = kInfinity;
  for (int i = 0; i < rounds; ++i) {
    if (!isHull(a)) near.onA = ontoCore(a, onB);
    if (!isHull(b)) onB = pose.placed(ontoCore(b, pose.inSecond(near.onA)));
    near.w = onB - near.onA;
    const double apart2 = near.w.squaredNorm();
    if (!(apart2 < kGain * least2)) break;
    least2 = apart2;
    if (isHull(a) || isHull(b)) break;  // its centre stays
  }
  return near;
}

}  // namespace detail

namespace {

using namespace detail;
using Pair = ShapePair;
using Corner = Pair::Corner;
using Gjk = Pair::Gjk;

/// Whether (a, b) is the canonical order of the pair: by kind, size, position, then corners.
bool comesFirst(const Shape& a, const Isometry3d& poseA, const Shape& b, const Isometry3d& poseB) {
  if (a.unbounded() != b.unbounded()) return a.unbounded();
  if (a.kind != b.kind) return a.kind < b.kind;
  if (a.reach != b.reach) return a.reach < b.reach;
  if (a.margin != b.margin) return a.margin < b.margin;
  if (a.vertexCount != b.vertexCount) return a.vertexCount < b.vertexCount;
  if (a.radius != b.radius) return a.radius < b.radius;
  if (a.half != b.half) return a.half < b.half;
  for (int i = 0; i < 3; ++i) {
    if (a.size[i] != b.size[i]) return a.size[i] < b.size[i];
    if (a.centre[i] != b.centre[i]) return a.centre[i] < b.centre[i];
  }
  const double* x = poseA.data();
  const double* y = poseB.data();
  if (!std::equal(x, x + 16, y)) return std::lexicographical_compare(x, x + 16, y, y + 16);
  if (!Pair::isHull(a)) return false;
  const bool areTriangles = a.kind == ShapeKind::triangle;
  const std::ptrdiff_t count = 3 * (areTriangles ? 3 : a.vertexCount);
  const double* u = (areTriangles ? a.corner.data() : a.vertices)->data();
  const double* v = (areTriangles ? b.corner.data() : b.vertices)->data();
  return std::lexicographical_compare(u, u + count, v, v + count);
}

/// Starts from the line of the centres, because a search that starts near the answer evaluates too few
/// normals.
Gjk searchToTheEnd(const Pair& p) {
  return p.search([](double, double) { return false; }, {});
}

/// Whether the bounds are close enough for Newton's method on the features: round bodies have few features,
/// but a polytope's features differ only in the last digits.
bool isNear(const Pair& p, double lower, double upper) {
  const double part = p.curved(p.a) && p.curved(p.b) ? 1e-2 : 1e-5;
  return upper - lower <= part * upper;
}

/// The widest gap that a search has seen, and its normal.
struct SeenGap {
  double gap;
  Vector3d n;

  /// The last normal, which the search did not look at. Rounding can make it worse than an earlier one.
  SeenGap(const Pair& p, const Gjk& found)
      : gap(Pair::Difference(p.a, p.b, p.pose).support(found.n).gap), n(found.n) {
    if (found.lower > gap) gap = found.lower, n = found.widest;
  }
};

/// Cores apart: a gap between them along `n`, and a point of A's with the way of length `upper` to one of
/// B's. `exact` where gap and length agree.
Distance between(const Pair& p, const Vector3d& n, double gap, const Vector3d& onA, const Vector3d& toB,
                 double upper) {
  Distance result = p.inWorld(n, onA, toB);
  result.status = upper - gap <= p.rounding ? DistanceStatus::exact : DistanceStatus::bounded;
  result.distance = upper - p.margins();
  result.lower = gap - p.margins() - p.certificate;
  result.upper = result.distance + p.certificate;
  return result;
}

/// Cores apart, as a search knows them. `invalid` where no gap between them was found.
Distance asFound(const Pair& p, const Gjk& found, const SeenGap& widest) {
  if (!(widest.gap > 0.0)) return {};
  return between(p, widest.n, widest.gap, found.simplex.weighted(&Corner::onA), found.v,
                 std::max(found.upper, widest.gap));
}

/// Sets the features on which the corners of a search's simplex lie. A polytope has so many features within
/// the error of a normal that the simplex tells more than the normal.
void setFeatures(const Pair& p, const Gjk& found, NearNormal& known) {
  const Vector3d &n = known.n, m = p.pose.opposite(n);
  const double topA = n.dot(p.a.support(n)), topB = m.dot(p.b.support(m));
  known.featureA = known.featureB = 0.0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(found.simplex.size); ++i) {
    const Corner& c = found.simplex.corner[i];
    known.featureA = std::max(known.featureA, topA - n.dot(c.onA));
    known.featureB = std::max(known.featureB, topB - m.dot(p.pose.inSecond(c.onA + c.w)));
  }
}

/// Answer for cores that are apart. It is the result of the search if that is accurate. Otherwise Newton's
/// method computes the last digits of normal and points, which chords of a round surface, or rounding of
/// points that almost touch, leave open. If that fails and the search `isLast`, level_faces.cpp is used. The
/// status is `invalid` if the cores overlap or no gap was found.
Distance separated(const Pair& p, const Gjk& found, bool isLast) {
  if (found.verdict == Gjk::Verdict::overlap) return {};
  const SeenGap widest(p, found);
  Distance result = asFound(p, found, widest);
  const bool opposite = (found.v - widest.gap * widest.n).norm() <= 2.0 * p.rounding;
  // A chord of a rim is as good as its arc for the gap, but its normal is off by the root of rounding.
  if (result.status == DistanceStatus::exact && opposite && !p.curved()) return result;
  // Seen from its point nearest to the origin, the difference lies beyond the plane of the widest gap.
  const double open = std::max(found.upper - widest.gap, p.rounding);
  const double angle = std::min(std::sqrt(2.0 * open / found.upper), Pair::kWidest);
  const Vector3d& n = widest.gap > 0.0 ? widest.n : found.n;
  NearNormal known{n, widest.gap, found.simplex.weighted(&Corner::onA), angle};
  if (Pair::isHull(p.a) || Pair::isHull(p.b)) setFeatures(p, found, known);
  auto nearest = nearestOnFeatures(p.a, p.b, p.pose, known, p.rounding);
  if (!nearest && isLast) nearest = oppositeLevel(p, n);
  if (!nearest || !(nearest->gap > 0.0 && nearest->gap >= widest.gap - p.rounding)) {
    if (p.curved() && !opposite && result.status == DistanceStatus::exact)
      result.status = DistanceStatus::bounded;
    return result;
  }
  result = p.inWorld(nearest->n, nearest->onA, nearest->toB);
  result.status = DistanceStatus::exact;
  result.distance = nearest->gap - p.margins();
  result.lower = result.distance - p.certificate;
  result.upper = std::max(nearest->toB.norm(), nearest->gap) - p.margins() + p.certificate;
  return result;
}

/// A half space or a plane `a`. A plane is left by the nearer side.
Distance besidePlane(const Pair& p) {
  const auto side = [&](const Vector3d& n, double offset) {
    const Vector3d q = p.pose.placed(p.b.support(p.pose.opposite(n)));
    const double gap = n.dot(q) - offset;
    Distance result = p.inWorld(n, q - gap * n, gap * n);
    result.status = DistanceStatus::exact;
    result.distance = gap - p.b.margin;
    result.lower = result.distance - p.certificate;
    result.upper = result.distance + p.certificate;
    return result;
  };
  const Vector3d n = p.a.normal.normalized();
  const Distance one = side(n, p.a.offset);
  if (p.a.kind != ShapeKind::plane) return one;
  const Distance other = side(-n, -p.a.offset);
  return other.distance > one.distance ? other : one;
}

/// Cores apart, after a search that goes on to the end, where Newton's method had no success from `found`.
Distance separatedAtTheEnd(const Pair& p, Gjk& found) {
  found = searchToTheEnd(p);
  return separated(p, found, true);
}

Distance solve(const Pair& p) {
  if (!p.valid) return {};
  if (p.a.unbounded()) return besidePlane(p);
  OppositePoints at;
  if (oppositeInClosedForm(p, at))
    return between(p, at.n, at.gap, at.onA, at.toB, at.gap < 0.0 ? at.gap : at.toB.norm());
  constexpr int kRounds = 6;
  Gjk found = p.search([&](double lower, double upper) { return p.curved() && isNear(p, lower, upper); },
                       p.nearCorner(kRounds));
  Distance result = separated(p, found, !p.curved());
  if (result.status == DistanceStatus::bounded && p.curved()) result = separatedAtTheEnd(p, found);
  return result.status == DistanceStatus::invalid ? overlapping(p, found) : result;
}

/// Whether a search ended with corners so far around the origin that the cores overlap whatever rounding did.
/// A tetrahedron that is flat, or has the origin next to a face, proves nothing.
bool overlapForSure(const Gjk& found, double rounding) {
  if (found.verdict != Gjk::Verdict::overlap || found.simplex.size < 4) return false;
  const auto corner = [&](std::size_t i) -> const Vector3d& { return found.simplex.corner[i % 4].w; };
  double longest = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < i; ++j) longest = std::max(longest, (corner(i) - corner(j)).squaredNorm());
  const double error = 4.0 * rounding * longest;  // of a face's normal times a corner
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector3d normal = (corner(i + 1) - corner(i)).cross(corner(i + 2) - corner(i));
    const double plane = normal.dot(corner(i)), opposite = normal.dot(corner(i + 3));
    const double side = std::copysign(1.0, plane);  // of the origin, seen from the face
    if (!(side * plane > error && side * opposite < side * plane - error)) return false;
  }
  return true;
}

/// Sets `normal` to that of a separating plane, if one decides (world).
bool isFarther(double x, const Pair& p, Vector3d& normal) {
  if (!p.valid) return false;
  if (p.a.unbounded()) return besidePlane(p).lower > x;
  OppositePoints at;
  const bool known = oppositeInClosedForm(p, at);
  const bool farther = at.gap - p.margins() - p.certificate > x;
  if (farther) normal = p.pose.normalInWorld(at.n);
  if (known || farther) return farther;
  const double core = x + p.margins();
  constexpr int kRounds = 2;
  const Corner near = p.nearCorner(kRounds);
  if (core >= 0.0 && near.w.norm() <= std::max(core, p.rounding)) return false;
  Gjk found = p.search(
      [&](double lower, double upper) { return lower > core + p.certificate || upper <= core; }, near);
  if (found.lower > core + p.certificate) {  // along whatever normal, apart or not
    normal = p.pose.normalInWorld(found.widest);
    return true;
  }
  if (found.verdict != Gjk::Verdict::overlap && found.upper <= core) return false;
  Distance answer = separated(p, found, !p.curved());
  if (answer.status == DistanceStatus::bounded && p.curved() && answer.lower <= x && x < answer.upper)
    answer = separatedAtTheEnd(p, found);
  if (answer.status != DistanceStatus::invalid) {
    if (answer.lower > x) normal = answer.normal;
    return answer.lower > x;
  }
  if (core >= 0.0 && overlapForSure(found, p.rounding)) return false;
  answer = overlapping(p, found);
  if (answer.lower > x) normal = answer.normal;
  return answer.lower > x;
}

}  // namespace

Distance distance(const Shape& shapeA, const Isometry3d& poseA, const Shape& shapeB,
                  const Isometry3d& poseB) {
  const QueriedShape queriedA(shapeA), queriedB(shapeB);
  const Shape &a = queriedA.shape(), &b = queriedB.shape();
  return comesFirst(a, poseA, b, poseB) ? solve({a, poseA, b, poseB})
                                        : solve({b, poseB, a, poseA}).mirrored();
}

bool isFartherThan(double x, const Shape& shapeA, const Isometry3d& poseA, const Shape& shapeB,
                   const Isometry3d& poseB, PairCache* cache) {
  const QueriedShape queriedA(shapeA), queriedB(shapeB);
  const Shape &a = queriedA.shape(), &b = queriedB.shape();
  Vector3d normal = Vector3d::Zero();
  const bool asGiven = comesFirst(a, poseA, b, poseB);
  const bool farther =
      asGiven ? isFarther(x, {a, poseA, b, poseB}, normal) : isFarther(x, {b, poseB, a, poseA}, normal);
  if (cache && !normal.isZero(0)) *cache = {asGiven ? normal : Vector3d(-normal)};
  return farther;
}

// The corners around the origin of the difference weigh points of the bodies that coincide; cores that are
// apart meet where their margins do.
Vector3d commonPoint(const Shape& a, const Isometry3d& poseA, const Shape& b, const Isometry3d& poseB) {
  const Pair p(a, poseA, b, poseB);
  Simplex<Corner> around;
  const NearestPoint nearest = reduceToNearest(searchToTheEnd(p).simplex, around);
  const double share = p.margins() > 0.0 ? a.margin / p.margins() : 0.5;
  return p.pose.inWorld(around.weighted(&Corner::onA) + share * nearest.point);
}

}  // namespace fcl_stpbv
