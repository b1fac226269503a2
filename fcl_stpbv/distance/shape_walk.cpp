// An STP-BV and a simple shape apart: a feature walk over the volume's patches and the shape's corners,
// edges, faces, rims and sides, as distance.cpp walks over two volumes' patches (docs/theory.md, 5).
//
// 1. Start from the last answer's patch, else from a vertex that a table names for the line of centres, and
//    from the shape's feature nearest to it (convex/shape_feature.h).
// 2. Solve the pair of patch and feature: the normal of its widest gap, in closed form, or by Newton's method
//    where an edge of the volume meets an edge, a rim or a cone's side.
// 3. If that normal is past the patch's boundaries, cross the one that it passes furthest, and go to 2.
// 4. If the nearest feature to the patch's point is another feature of the shape, take that one and go to 2.
// 5. Test the result against the whole shape. If it fails, or after some pairs, the searches of shape_query.h
//    take over.
#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/distance/ascent.h"
#include "fcl_stpbv/distance/known_features.h"
#include "fcl_stpbv/distance/shape_query.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

namespace {

using FeatureKind = ShapeFeature::Kind;

constexpr int kPasses = 8;             // of Newton's method; two or three are usual
constexpr double kConverged2 = 1e-17;  // of a step, squared: the next one is rounding
constexpr double kWide =
    0.3;  // sine past a boundary: beyond this, the direction table is faster than the walk

/// The unit vector perpendicular to the unit vector `t` and nearest to `v`; `otherwise` if `v` is along `t`.
Packed unitAcross(const Packed& v, const Packed& t, const Packed& otherwise) {
  Packed side = v - dot(v, t) * t;
  side -= dot(side, t) * t;  // again, to remove the rounding error along `t`
  return unnormalizedOr(side, otherwise).unit();
}

/// The widest normal of an edge's torus and a line, by Newton's method on the great circle across the line.
Packed widestOfLine(const PosedPatch& edge, const ShapeFeature& line, Packed n) {
  constexpr double kCrossing2 = 0.01;  // squared sine between the edge and the line
  const Packed &t = line.axis, common = cross(edge.axis, t), anchors = line.point - edge.anchor;
  const double sine2 = dot(common, common), along = dot(common, n);
  if (sine2 > kCrossing2 &&
      along * along > 0.25 * sine2)  // an edge's normals are almost perpendicular to the edge
    n = std::copysign(1.0, along) * common;
  n = unitAcross(n, t, n);
  for (int i = 0; i < kPasses; ++i) {
    const EdgeView view = viewEdge(edge, n);
    const Packed difference = anchors - view.offset, e = cross(t, n);
    const double around = dot(cross(edge.axis, n), e) / view.c, gap = dot(n, anchors) - view.rise,
                 curvature = edge.radii->rho + (view.around - edge.radii->rho) * around * around + gap;
    if (!(curvature > 0.0)) {
      n = unitAcross(difference, t, n);
      continue;
    }
    const double step = dot(difference, e) / curvature;
    n = unnormalizedOr(n + step * e, n).unit();
    if (step * step <= kConverged2) break;
  }
  return n;
}

/// A round feature along a normal: its support point, and its radii of curvature in the axes of the tangent
/// plane (m).
struct RoundView {
  Packed point;
  double m11, m12, m22;
};

/// The widest normal of a patch and a round feature, by Newton's method on the sphere, from the unit vector
/// `n`. `look(n, e1, e2)` returns the feature's RoundView; e1 and e2 are perpendicular to n.
template <typename Look>
Packed widestOfRound(const PosedPatch& a, Packed n, const Look& look) {
  for (int i = 0; i < kPasses; ++i) {
    Packed offset, e1;
    double rise, around, along;  // of the patch; its radii of curvature along e1 and e2
    if (a.kind == PatchKind::edge) {
      const EdgeView view = viewEdge(a, n);
      offset = view.offset, rise = view.rise;
      e1 = cross(a.axis, n) / view.c;
      around = view.around, along = a.radii->rho;
    } else {
      const CoreView view = viewCore(a, n);
      offset = view.offset, rise = view.rise;
      e1 = cross(std::abs(n[0]) < 0.5 ? Packed{1, 0, 0, 0} : Packed{0, 1, 0, 0}, n);
      e1 /= std::sqrt(dot(e1, e1));
      around = along = a.kind == PatchKind::face ? a.radii->rho : 0.0;
    }
    const Packed e2 = cross(n, e1);
    const RoundView f = look(n, e1, e2);
    const Packed anchors = f.point - a.anchor, difference = anchors - offset;
    const double gap = dot(n, anchors) - rise, m11 = around + f.m11 + gap, m22 = along + f.m22 + gap,
                 g1 = dot(difference, e1), g2 = dot(difference, e2), det = m11 * m22 - f.m12 * f.m12;
    if (!(det > 0.0 && m11 > 0.0)) {
      n = unnormalizedOr(difference, n).unit();
      continue;
    }
    const double x1 = (m22 * g1 - f.m12 * g2) / det, x2 = (m11 * g2 - f.m12 * g1) / det;
    n = unnormalizedOr(n + x1 * e1 + x2 * e2, n).unit();
    if (x1 * x1 + x2 * x2 <= kConverged2) break;
  }
  return n;
}

/// The widest normal of an edge's torus and a rim, from the rim's point nearest to the edge's middle.
Packed widestOfRim(const PosedPatch& edge, const ShapeFeature& rim, const Packed& n) {
  constexpr double kUpright = 1e-6;  // sine to the rim's axis, where the radius of curvature is unbounded
  const Packed towards = rim.point - edge.anchor,
               nearest = towards - rim.radius * unitAcross(towards, rim.axis, n);
  return widestOfRound(
      edge, circlePoint(edge, nearest, n).unit(), [&](const Packed& m, const Packed& e1, const Packed& e2) {
        const Packed out = unitAcross(m, rim.axis, m), along = cross(rim.axis, out);
        const double bent = rim.radius / std::max(dot(m, out), kUpright), f1 = dot(along, e1),
                     f2 = dot(along, e2);
        return RoundView{rim.point - rim.radius * out, bent * f1 * f1, bent * f1 * f2, bent * f2 * f2};
      });
}

/// The widest normal of a patch and a cone's side, by Newton's method on the angle around the cone's axis.
/// For a vertex and a face, which are balls, it is the normal of the generator nearest to the centre.
Packed widestOfSide(const PosedPatch& a, const ShapeFeature& side, const Packed& n) {
  const auto normalOf = [&](const Packed& e) { return -(side.cosine * e + side.sine * side.axis); };
  Packed e = unitAcross(a.centre() - side.apex, side.axis, n);
  if (a.kind != PatchKind::edge) return normalOf(e);
  const Packed anchors = side.apex - a.anchor;
  for (int i = 0; i < kPasses; ++i) {
    const Packed m = normalOf(e), turning = -side.cosine * cross(side.axis, e);
    const EdgeView view = viewEdge(a, m);
    const Packed difference = anchors - view.offset;
    const double around = dot(cross(a.axis, m), turning) / view.c,
                 curvature = side.cosine * dot(e, difference) - a.radii->rho * dot(turning, turning) -
                             (view.around - a.radii->rho) * around * around;
    if (!(curvature < 0.0)) break;
    const double turn = -dot(turning, difference) / curvature;
    e = unitAcross(e + turn * cross(side.axis, e), side.axis, e);
    if (turn * turn <= kConverged2) break;
  }
  return normalOf(e);
}

/// The widest normal of a patch and an ellipsoid.
Packed widestOfEllipsoid(const ShapeQuery& q, const PosedPatch& a, const ShapeFeature& f, const Packed& n) {
  const Packed size = pack(q.shape.size);
  const Rotation& axes = q.pose.rotation;
  return widestOfRound(a, n, [&](const Packed& m, const Packed& e1, const Packed& e2) {
    const Packed local = size * axes.inverse(m);
    const double height = std::sqrt(dot(local, local));
    const Packed ball = local / height, out = axes * (size * ball),
                 c1 = size * axes.inverse(e1) - dot(out, e1) * ball,
                 c2 = size * axes.inverse(e2) - dot(out, e2) * ball;
    return RoundView{f.point - out, dot(c1, c1) / height, dot(c1, c2) / height, dot(c2, c2) / height};
  });
}

/// The normal from the patch to the feature with the widest gap. Iterations start from the unit vector `n`.
UnnormalizedNormal widestNormal(const ShapeQuery& q, const PosedPatch& a, const ShapeFeature& f,
                                const Packed& n) {
  const bool edge = a.kind == PatchKind::edge;
  if (f.kind == FeatureKind::face) return {-f.axis, 1.0};
  if (f.kind == FeatureKind::whole) return {widestOfEllipsoid(q, a, f, n), 1.0};
  if (f.kind == FeatureKind::side) return {widestOfSide(a, f, n), 1.0};
  if (f.kind == FeatureKind::line && edge) return {widestOfLine(a, f, n), 1.0};
  if (f.kind == FeatureKind::rim && edge) return {widestOfRim(a, f, n), 1.0};
  Packed d = f.point - a.centre();
  if (edge) return circlePoint(a, d, n);
  if (f.kind == FeatureKind::line) return {unitAcross(d, f.axis, n), 1.0};
  if (f.kind == FeatureKind::rim) d -= f.radius * unitAcross(d, f.axis, n);
  return unnormalizedOr(d, n);
}

/// The feature's point furthest against `n`. For a side and a face it is the stored point.
Packed facing(const ShapeQuery& q, const ShapeFeature& f, const Packed& n) {
  if (f.kind == FeatureKind::whole) {
    const Packed size = pack(q.shape.size), local = size * q.pose.rotation.inverse(n);
    return f.point - q.pose.rotation * (size * local) / std::sqrt(dot(local, local));
  }
  if (f.kind == FeatureKind::rim) return f.point - f.radius * unitAcross(n, f.axis, n);
  return f.kind == FeatureKind::line ? Packed(f.point - f.radius * n) : f.point;
}

/// Crosses the first boundary uphill from the unit vector `from`, if the pair's widest normal is far away
/// (distance.cpp does the same). False if no boundary is ahead.
bool crossUphill(const ShapeQuery& q, const PosedPatch& a, const ShapeFeature& f, const Packed& from,
                 int& patch, Packed& n) {
  const Packed difference = facing(q, f, from) - a.anchor - viewCore(a, from).offset;
  Packed up = difference - dot(difference, from) * from;
  if (a.kind == PatchKind::edge) up -= dot(up, a.axis) * a.axis;
  const Packed h = unnormalizedOr(up, from).unit();
  const Crossing over = q.body.tables().patches.ahead(patch, from, h);
  if (!(over.past > std::numeric_limits<double>::min())) return false;
  n = unnormalizedOr(over.past * from + h, from).unit();
  patch = over.neighbour;
  return true;
}

/// The start of the walk: near the last answer, or else in the direction of the shape's point nearest to the
/// volume's centre.
int startingPatch(const ShapeQuery& q, const StartNormal& start, KnownFeatures& features, Packed& n) {
  const QueryTables& tables = q.body.tables();
  n = pack(start.n);
  if (start.patch >= 0) {
    if (tables.patches.crossing(start.patch, n).past < kWide) return start.patch;
  } else {
    const Packed centre = pack(q.body.centre());
    n = unnormalizedOr(features.near(centre).point - centre, n).unit();
  }
  return tables.vertexNear[unpack(n)];
}

}  // namespace

FCL_STPBV_VECTORIZED
Span awayFromCentre(const ShapeQuery& q, double enough) {
  const Packed x = q.pose.rotation.inverse(pack(q.body.centre()) - q.pose.translation);
  if (q.shape.unbounded()) {
    const Packed n = pack(q.shape.normal);
    const double height = dot(n, x - q.shape.offset * n) / std::sqrt(dot(n, n)),
                 away = q.shape.kind == ShapeKind::plane ? std::abs(height) : height;
    return {away, away};
  }
  // The normal of a narrow triangle is not accurate enough for this.
  const ShapeFeature f = q.shape.kind == ShapeKind::triangle ? ShapeFeature{} : nearestFeature(q.shape, x);
  if (f.kind == FeatureKind::inside) return {-q.shape.reach, 0.0};
  const bool few = f.kind != FeatureKind::none && f.kind != FeatureKind::whole;
  const Packed d = few ? wayFrom(f, x) : x - pack(q.shape.centre);
  const double length = std::sqrt(dot(d, d));
  if (few) return {length, length};
  if (q.shape.kind == ShapeKind::polytope && length - q.shape.reach < enough) {
    // The segment from the polytope's centre to its corner furthest towards `x`.
    const Packed corner = pack(q.shape.support(unpack(d))), along = corner - pack(q.shape.centre);
    const double t = std::min(dot(d, along) / std::max(dot(along, along), 1e-300), 1.0);
    const Packed rest = d - t * along;
    return {length - q.shape.reach, std::sqrt(dot(rest, rest))};
  }
  return {length - q.shape.reach, length - (f.kind == FeatureKind::whole ? q.shape.size.minCoeff() : 0.0)};
}

FCL_STPBV_VECTORIZED
WalkEnd walkShapeFeatures(ShapeQuery& q, const StartNormal& start, int tries, Nearest& found) {
  constexpr double kFar = 0.3;  // cosine of the turn above which the boundary passed furthest means little
  const PatchTable& patches = q.body.tables().patches;
  KnownFeatures features(q, start.n);
  Packed n;
  int patch = startingPatch(q, start, features, n);
  PosedPatch a = posedPatch(q.body, patch);
  ShapeFeature f = features.near(a.anchor);
  bool again = false;  // the pair is the same, but its last digits are missing
  for (int i = 0; i < tries && f.kind > FeatureKind::inside; ++i) {
    ++q.pairs;
    const UnnormalizedNormal to = widestNormal(q, a, f, n);
    const Crossing over = patches.crossing(patch, to.d, to.length);
    if (over.past > kOnBoundary * to.length) {
      ++q.steps;
      const bool fixed = f.kind == FeatureKind::face;
      const Packed last = n;
      n = to.unit();
      if (fixed && over.past > kWide)
        patch = q.body.tables().vertexNear[unpack(n)];
      else if (fixed || dot(n, last) > kFar || !crossUphill(q, a, f, last, patch, n))
        patch = over.neighbour;
      a = posedPatch(q.body, patch);
      again = false;
      continue;
    }
    n = to.unit();
    const CoreView view = viewCore(a, n);
    const Packed x = a.anchor + view.offset;
    const ShapeFeature next = features.near(x);
    const bool same = next.kind == f.kind && next.which == f.which;
    f = next;
    if (!same) continue;
    const Packed y = facing(q, f, n), difference = y - x, across = difference - dot(difference, n) * n;
    if (dot(across, across) > 4.0 * q.rounding.across * q.rounding.across) {
      if (again) return WalkEnd::unknown;
      again = true;
      continue;
    }
    found.n = unpack(n);
    found.patch = patch;
    found.y = unpack(y);
    found.gap = dot(n, y - a.anchor) - view.rise;
    found.apart = found.gap > 0.0;
    const Eigen::Vector3d furthest = q.facing(found.n);
    if (found.n.dot(found.y - furthest) <= q.rounding.gap)
      return found.apart ? WalkEnd::nearest : WalkEnd::unknown;
    if (!features.add(furthest)) return WalkEnd::unknown;
    f = features.near(x);
    again = false;
  }
  return f.kind == FeatureKind::inside ? WalkEnd::meeting : WalkEnd::unknown;
}

}  // namespace fcl_stpbv::detail
