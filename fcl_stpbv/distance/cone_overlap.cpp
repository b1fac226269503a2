// Depth of an STP-BV and a segment, a triangle or a box whose cores overlap, in closed form. The normal cones
// of the shape's features are searched one after the other. The proof is in docs/theory.md, 5.
//
// 1. A flat face has one normal: evaluate the depth along it.
// 2. A corner has a cone of normals. If the corner is deep enough, its shortest way out leads through a face
//    of the volume, and the ways out of the faces' balls are in closed form (volume/point_depth.h).
// 3. An edge has an arc of normals: EPA in the plane perpendicular to the edge. Between two normals, the
//    volume's outline is outside the chord between their support points.
// 4. If a piece of an arc is within one patch, the curvature may prove that it has at most one minimum.
//    Newton's method finds it.
#include <algorithm>
#include <array>
#include <cmath>

#include "fcl_stpbv/convex/onto_core.h"
#include "fcl_stpbv/distance/shape_query.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/patch_view.h"
#include "fcl_stpbv/volume/point_depth.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

/// The volume's support point along a normal, and the depth of one point or edge of the shape along it (m).
/// Left uninitialised, because each arc stores many.
struct WayOut {
  Vector3d n;
  int patch;
  Vector3d point;  ///< the core's
  double depth;
};

/// An edge of the shape and a quarter of its arc of normals, from `from.n` to `to.n`, about `t`.
struct Arc {
  Vector3d a, b;  ///< the edge's ends
  Vector3d t;     ///< unit, along it: from.n x to.n
  WayOut from, to;
};

/// Searches the ways out of the volume's core, one normal cone after the other.
class WaysOut {
 public:
  explicit WaysOut(ShapeQuery& q) : q_(q) {}

  WayOut along(const Vector3d& n, const Vector3d& y, int hint) {
    const SupportPoint view = viewVolume(q_.body, n, hint, q_.steps);
    ++q_.pairs;
    return {n, view.patch, view.point, -view.gap(y)};
  }

  /// Tells the depth along any normal: the shortest way out is not longer, up to rounding.
  void noLonger(double depth) { worth_ = std::min(worth_, depth + 4.0 * q_.rounding.gap); }

  /// Along the normal of a face through three points.
  WayOut face(const Vector3d& n, const Vector3d& p0, const Vector3d& p1, const Vector3d& p2) {
    const WayOut way = along(n, p0, -1);
    bound(way.depth);
    take(way, {{p0, p1, p2}, 3});
    return way;
  }

  /// The ways out in the normal cone of a corner. `side`: unit vectors along its edges.
  void corner(const Vector3d& p, const Vector3d* side, int count) {
    const auto found = pointDepthBetween(q_.body, p, side, count, worth_);
    ++q_.pairs;
    if (!found) return;
    bound(found->depth);
    take(along(found->normal, p, found->patch), {{p, p, p}, 1});
  }

  /// Whether no way out of the corner `p` is shorter than the best known one, for normals on the arcs from
  /// the face's normal, `near.n`, to all vectors between `u` and `v`. Near the face's normal, the support
  /// point `near.point` proves it; farther away, the volume's inner ball does.
  bool isDeep(const Vector3d& p, const WayOut& near, const Vector3d& u, const Vector3d& v) const {
    const Vector3d centre = q_.body.centre() - p, from = near.point - p;
    const double ball = q_.body.innerRadius();
    // Along cos(a) n + sin(a) w, with w between u and v, the component of a vector is at least cos(a) times
    // that along n plus sin(a) times the smaller one of those along u and v, if that is positive.
    const double across = std::min(from.dot(u), from.dot(v)), aside = std::min(centre.dot(u), centre.dot(v)),
                 t = across / worth_;
    if (!(across > 0.0 && near.depth >= worth_)) return false;
    if (t >= 1.0) return true;
    const double scale = 1.0 / (1.0 + t * t),
                 there = scale * ((1.0 - t * t) * centre.dot(near.n) + 2.0 * t * aside);
    return aside >= 0.0 && std::min(there, aside) + ball >= worth_;
  }

  /// The ways out along an edge's arc of normals. False if too many pieces are left.
  bool arc(const Arc& whole) {
    constexpr int kPieces = 24, kMost = 1000;
    std::array<std::array<WayOut, 2>, kPieces> left;
    int count = 0;
    left[count++] = {whole.from, whole.to};
    for (int i = 0; count > 0; ++i) {
      const auto [from, to] = left[at(--count)];
      const Vector3d n = acrossChord(whole, from, to);
      const double chord = n.dot(from.point - whole.a);
      if (isSettled(whole, from, to, chord)) continue;
      if (i >= kMost || count + 2 > kPieces) return false;
      const WayOut middle = along(n, whole.a, -1);
      take(middle, {{whole.a, whole.b, whole.b}, 2});
      if (middle.depth - chord <= q_.rounding.gap) {
        bound(chord);
        continue;
      }
      left[at(count++)] = {from, middle};
      left[at(count++)] = {middle, to};
    }
    return true;
  }

  /// The answer, if the normals searched so far prove it. Corners and pieces that were left out have no way
  /// out shorter than `worth_`.
  std::optional<LeastOverlap> answer() {
    if (!(best_.depth - std::min(bound_, worth_) <= 2.0 * q_.rounding.gap)) return {};
    LeastOverlap found{{}, -std::min(bound_, best_.depth) + q_.rounding.across};
    found.at.n = best_.n;
    found.at.patch = best_.patch;
    found.at.gap = -best_.depth;
    found.at.y = ontoTriangle(met_.three(), best_.point + found.at.gap * best_.n);
    std::optional<DeepFeature> exact;
    for (const bool ascend : {false, true})
      if (!exact) exact = deepestFeature(q_, {found.at.n, found.at.patch}, found.at.gap, met_, ascend);
    if (exact) found.at = exact->at;
    return found;
  }

 private:
  void bound(double depth) { bound_ = std::min(bound_, depth); }
  void take(const WayOut& way, const ShapeCorners& met) {
    worth_ = std::min(worth_, way.depth - q_.rounding.gap);
    if (way.depth < best_.depth) best_ = way, met_ = met;
  }
  /// The derivative of the depth by the angle.
  static double slope(const Arc& arc, const WayOut& way) { return arc.t.cross(way.n).dot(way.point - arc.a); }

  /// The unit normal of the chord between the support points of two normals, made perpendicular to the edge:
  /// a sliver's face normal is not, up to rounding.
  static Vector3d acrossChord(const Arc& arc, const WayOut& from, const WayOut& to) {
    const Vector3d &e = arc.from.n, &f = arc.to.n, chord = to.point - from.point;
    const double x = std::max(0.0, chord.dot(f)), y = std::max(0.0, -chord.dot(e));
    const Vector3d n = x + y > 0.0 ? Vector3d(x * e + y * f) : Vector3d(from.n + to.n);
    return acrossLine(n.normalized(), arc.t);
  }

  /// Whether the piece between two normals needs no more search, because no way out there is shorter than the
  /// best one, or because its minimum was found. `chord`: the depth of the chord of their support points.
  bool isSettled(const Arc& arc, const WayOut& from, const WayOut& to, double chord) {
    const double ends = std::min(from.depth, to.depth);
    // The depth of one support point, where positive, is least at an end of the piece. This bounds the depth
    // by that of both ends for either point, and by that of the ends and the chord.
    const double one = std::max(std::min(from.depth, to.n.dot(from.point - arc.a)),
                                std::min(to.depth, from.n.dot(to.point - arc.a))),
                 least = std::max(one, std::min(ends, chord));
    if (least >= worth_) return bound(least), true;
    if (from.patch != to.patch) return false;
    const PosedPatch patch = posedPatch(q_.body, from.patch);
    if (patch.kind == PatchKind::vertex) return bound(ends), true;
    if (!(leastCurvature(arc, patch, from.n, to.n) > worth_)) return false;
    if (slope(arc, from) >= 0.0 || slope(arc, to) <= 0.0) return bound(ends), true;
    const WayOut bottom = minimum(arc, patch, from, to);
    bound(bottom.depth);
    take(bottom, {{arc.a, arc.b, arc.b}, 2});
    return true;
  }

  /// The least radius of curvature of the volume's outline between two normals of one patch (m); 0 if the arc
  /// may leave the patch between them.
  double leastCurvature(const Arc& arc, const PosedPatch& patch, const Vector3d& from,
                        const Vector3d& to) const {
    if (patch.kind == PatchKind::face) return patch.radii->rho;
    const Vector3d u = unpack(patch.axis);
    const double low = u.dot(from), high = u.dot(to), lean = std::max(low * low, high * high);
    if (u.dot(arc.t.cross(from)) * u.dot(arc.t.cross(to)) <= 0.0 || lean > 0.5) return 0.0;
    const double c2 = 1.0 - lean, across = u.dot(arc.t);
    return patch.radii->rho * (1.0 - 1e-12) - patch.kappa * across * across / (c2 * std::sqrt(c2));
  }

  /// The one minimum between two normals of a patch, by Newton's method within a bracket.
  WayOut minimum(const Arc& arc, const PosedPatch& patch, WayOut low, WayOut high) {
    constexpr int kSteps = 40;
    WayOut at = low;
    for (int i = 0; i < kSteps; ++i) {
      const double g = slope(arc, at);
      if (std::abs(g) <= 0.25 * q_.rounding.across) break;
      (g < 0.0 ? low : high) = at;
      const Vector3d along = arc.t.cross(at.n);
      const double curvature = along.dot(coreCurvature(patch, at.n) * along) - at.depth;
      Vector3d next = acrossLine((at.n - (g / curvature) * along).normalized(), arc.t);
      if (!(low.n.cross(next).dot(arc.t) > 0.0 && next.cross(high.n).dot(arc.t) > 0.0)) {
        next = (low.n + high.n).normalized();
        if (next == low.n || next == high.n) break;
      }
      at = this->along(next, arc.a, at.patch);
    }
    return at;
  }

  ShapeQuery& q_;
  double worth_ = kInfinity;  // least known depth, adjusted for rounding; only shorter ways out matter
  double bound_ = kInfinity;  // lower bound on the depth in the cones searched so far
  WayOut best_{{0, 0, 0}, -1, {0, 0, 0}, kInfinity};
  ShapeCorners met_;  // the shape's corners that leave last along it
};

bool leaveSegment(const ShapeQuery& q, WaysOut& ways) {
  const Vector3d t = q.rotation.col(2), back = -t, e = t.unitOrthogonal(), f = t.cross(e),
                 bottom = q.translation - q.shape.half * t, top = q.translation + q.shape.half * t;
  ways.corner(bottom, &t, 1);
  ways.corner(top, &back, 1);
  const std::array<Vector3d, 4> normal{e, f, -e, -f};
  std::array<WayOut, 4> way;
  for (std::size_t i = 0; i < 4; ++i) way[i] = ways.along(normal[i], q.translation, -1);
  for (std::size_t i = 0; i < 4; ++i)
    if (!ways.arc({bottom, top, t, way[i], way[(i + 1) % 4]})) return false;
  return true;
}

bool leaveTriangle(const ShapeQuery& q, WaysOut& ways) {
  constexpr double kSliver = 1e-3;  // of a height to a side: if it is less, the normal is too inaccurate
  std::array<Vector3d, 3> p, t;
  for (std::size_t i = 0; i < 3; ++i) p[i] = q.pose.placed(q.shape.corner[i]);
  double longest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d side = p[(i + 1) % 3] - p[i];
    longest = std::max(longest, side.norm());
    t[i] = side.normalized();
  }
  const Vector3d up = (p[1] - p[0]).cross(p[2] - p[0]);
  if (!(up.norm() > kSliver * longest * longest)) return false;
  const Vector3d m = up.normalized();
  const WayOut front = ways.face(m, p[0], p[1], p[2]), behind = ways.face(-m, p[0], p[1], p[2]);
  std::array<Vector3d, 3> inwards;
  for (std::size_t i = 0; i < 3; ++i) inwards[i] = m.cross(t[i]).normalized();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t last = (i + 2) % 3;
    const Vector3d &u = inwards[i], &v = inwards[last];
    const std::array<Vector3d, 2> side{t[i], -t[last]};
    if (!(ways.isDeep(p[i], front, u, v) && ways.isDeep(p[i], behind, u, v)))
      ways.corner(p[i], side.data(), 2);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& next = p[(i + 1) % 3];
    const WayOut across = ways.along(inwards[i], p[i], -1);
    if (!ways.arc({p[i], next, -t[i], front, across}) || !ways.arc({p[i], next, t[i], behind, across}))
      return false;
  }
  return true;
}

bool leaveBox(const ShapeQuery& q, WaysOut& ways) {
  // Per axis the side below, whose normal points up, and the one above.
  std::array<std::array<Vector3d, 2>, 3> normal, end;
  for (int i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 2; ++k) {
      const auto axis = static_cast<std::size_t>(i);
      normal[axis][k] = k == 0 ? Vector3d(q.rotation.col(i)) : Vector3d(-q.rotation.col(i));
      end[axis][k] = -q.shape.size[i] * normal[axis][k];
    }
  const auto corner = [&](std::size_t axis, std::size_t i, std::size_t j, std::size_t k) {
    return Vector3d(q.translation + end[axis][i] + end[(axis + 1) % 3][j] + end[(axis + 2) % 3][k]);
  };
  std::array<std::array<WayOut, 2>, 3> face;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 2; ++k)
      face[i][k] = ways.face(normal[i][k], corner(i, k, 0, 0), corner(i, k, 1, 0), corner(i, k, 0, 1));
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t k = 0; k < 2; ++k) {
        const Vector3d p = corner(0, i, j, k);
        const std::array<Vector3d, 3> n{normal[0][i], normal[1][j], normal[2][k]};
        if (!ways.isDeep(p, face[0][i], n[1], n[2]) && !ways.isDeep(p, face[1][j], n[2], n[0]) &&
            !ways.isDeep(p, face[2][k], n[0], n[1]))
          ways.corner(p, n.data(), 3);
      }
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t k = 0; k < 2; ++k) {
        const WayOut &from = face[(axis + 1) % 3][j], &to = face[(axis + 2) % 3][k];
        if (!ways.arc({corner(axis, 0, j, k), corner(axis, 1, j, k), from.n.cross(to.n), from, to}))
          return false;
      }
  return true;
}

}  // namespace

std::optional<LeastOverlap> overlapOfCones(ShapeQuery& q) {
  const ShapeKind kind = q.shape.kind;
  if (kind != ShapeKind::segment && kind != ShapeKind::triangle && kind != ShapeKind::box) return {};
  // This point must be deep enough that no corner leaves through an edge or a vertex of the volume.
  const Vector3d y = q.pose.placed(ontoCore(q.shape, q.pose.inSecond(q.body.centre())));
  const std::optional<PointDepth> inside = pointDepth(q.body, y);
  if (!inside) return {};
  WaysOut ways(q);
  ways.noLonger(ways.along(inside->normal, q.facing(inside->normal), inside->patch).depth);
  const bool done = kind == ShapeKind::segment    ? leaveSegment(q, ways)
                    : kind == ShapeKind::triangle ? leaveTriangle(q, ways)
                                                  : leaveBox(q, ways);
  return done ? ways.answer() : std::nullopt;
}

}  // namespace fcl_stpbv::detail
