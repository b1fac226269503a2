// The point of a plane, a segment, a triangle or a polytope nearest to an STP-BV's core, and a test that
// proves it.
//
// For a polytope this is GJK against a smooth body (Gilbert, Johnson, Keerthi 1988; Wolfe 1976). It keeps up
// to four corners and the nearest point of their hull, and adds the polytope's support corner towards the
// body, until no corner is nearer along the normal than that point.
#include "fcl_stpbv/distance/shape_query.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

ShapeQuery::ShapeQuery(const StpBv& a, const Shape& s, const RelativePose& p)
    : body(a), shape(s), pose(p), rotation(p.rotation.matrix()), translation(unpack(p.translation)) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  // A dozen operations on coordinates up to the bodies' extents and mutual distance.
  const double size =
      a.centre().lpNorm<1>() + a.enclosingRadius() + translation.lpNorm<1>() + s.centre.lpNorm<1>() + s.reach;
  rounding.gap = 8.0 * kEpsilon * size;
  rounding.across = rounding.gap + 8.0 * kEpsilon * a.radii().rho;
  rounding.certificate = kGapRounding * (size + s.margin) + 1e-6 * rounding.across + a.tables().supportError;
}

StartNormal startOf(const ShapeQuery& q, const PairCache& last) {
  const Vector3d n = q.pose.toWorld.inverse(last.normal);
  const double length2 = n.squaredNorm();
  if (PairCache::isDirection(length2) && last.patch[0] < q.body.patchCount())
    return {n / std::sqrt(length2), last.patch[0]};
  const Vector3d d = q.pose.placed(q.shape.centre) - q.body.centre();
  const double away = d.norm();
  return {away > 0.0 ? Vector3d(d / away) : Vector3d::UnitX(), -1};
}

bool isNearer(const ShapeQuery& q, const Nearest& x, const Nearest& than, const Vector3d* points, int count) {
  if (std::abs(x.gap - than.gap) > q.rounding.gap) return x.gap < than.gap;
  const auto beyond = [&](const Nearest& found) {
    double most = 0.0;
    for (int i = 0; i < count; ++i) most = std::max(most, found.n.dot(found.y - points[i]));
    return most;
  };
  return beyond(x) < beyond(than);
}

Nearest nearestOnPlane(ShapeQuery& q, const Vector3d& onPlane, const Vector3d& n, int hint) {
  const SupportPoint view = viewVolume(q.body, n, hint, q.steps);
  Nearest found;
  found.n = n;
  found.patch = view.patch;
  found.gap = view.gap(onPlane);
  found.apart = found.gap > 0.0;
  found.y = view.point + n.dot(onPlane - view.point) * n;
  found.corners = 3;
  ++q.pairs;
  return found;
}

Nearest nearestOnSegment(ShapeQuery& q, const Vector3d& a, const Vector3d& b, const StartNormal& start) {
  const Vector3d e = b - a;
  const double length = e.norm();
  const auto end = [&](int which) {
    Nearest found = nearestOn(q, PointFeature{which == 0 ? a : b}, start);
    found.corner[0] = which;
    return found;
  };
  if (!(length > 0.0)) return end(0);
  const Vector3d t = e / length;
  Nearest found = nearestOn(q, LineFeature{a, t}, {acrossLine(start.n, t), start.patch});
  if (found.apart) {
    const double at = (found.y - a).dot(t);
    if (at < 0.0) return end(0);
    if (at > length) return end(1);
    found.corners = 2;
    found.corner = {0, 1, 0};
    return found;
  }
  // The line intersects the core, but the segment may end before the core.
  const Nearest first = end(0), second = end(1);
  if (!first.apart || !second.apart) return first.apart ? second : first;  // an end inside: overlap
  return first.gap < second.gap ? first : second;
}

Nearest nearestOnTriangle(ShapeQuery& q, const Vector3d& a, const Vector3d& b, const Vector3d& c,
                          const StartNormal& start) {
  const std::array<Vector3d, 3> p{a, b, c};
  // The normal from the two shorter sides is accurate even for slivers.
  const double ab = (b - a).squaredNorm(), bc = (c - b).squaredNorm(), ca = (a - c).squaredNorm();
  const std::size_t o = bc >= ab && bc >= ca ? 0 : ca >= ab ? 1 : 2;
  const Vector3d u = p[(o + 1) % 3] - p[o], v = p[(o + 2) % 3] - p[o];
  Vector3d normal = u.cross(v);
  const double area = normal.norm();
  bool side[3] = {true, true, true};  // edges that the nearest point may be on: i from corner i to i + 1
  if (area > 1e-14 * (u.squaredNorm() + v.squaredNorm())) {
    normal /= area;
    if (normal.dot(start.n) < 0.0) normal = -normal;
    for (int turn = 0; turn < 2; ++turn) {
      const Vector3d n = turn == 0 ? normal : Vector3d(-normal);
      const Nearest found = nearestOnPlane(q, p[o], n, turn == 0 ? start.patch : -1);
      if (!found.apart) continue;
      const Vector3d up = u.cross(v);
      bool inside = true;
      for (std::size_t i = 0; i < 3; ++i) {
        side[i] = up.cross(p[(i + 1) % 3] - p[i]).dot(found.y - p[i]) < 0.0;
        inside = inside && !side[i];
      }
      if (inside) return found;
      break;
    }
  }
  Nearest best;
  for (int i = 0; i < 3; ++i) {
    if (!side[i]) continue;
    const int j = (i + 1) % 3;
    Nearest found = nearestOnSegment(q, p[static_cast<std::size_t>(i)], p[static_cast<std::size_t>(j)],
                                     best.apart ? StartNormal{best.n, best.patch} : start);
    for (int k = 0; k < found.corners; ++k) {
      int& corner = found.corner[static_cast<std::size_t>(k)];
      corner = corner == 0 ? i : j;
    }
    if (!found.apart) return found;  // the core reaches this edge
    if (!best.apart || isNearer(q, found, best, p.data(), 3)) best = found;
  }
  return best;
}

bool certified(ShapeQuery& q, const Nearest& found) {
  if (!found.apart) return false;
  const SupportPoint view = viewVolume(q.body, found.n, found.patch, q.steps);
  if (found.n.dot(found.y - q.facing(found.n)) > q.rounding.gap) return false;
  const Vector3d difference = found.y - view.point;
  const double across = (difference - difference.dot(found.n) * found.n).norm();
  // Rounding may move a point along a rim or a generator. Then the distance of the points must be the gap.
  return across <= 2.0 * q.rounding.across || std::hypot(found.gap, across) - found.gap <= q.rounding.gap;
}

namespace {

/// Up to four corners of the polytope, and the nearest point of their hull.
class CornerSet {
 public:
  bool holds(const Vector3d& p) const {
    return std::find(corner_.begin(), corner_.begin() + count_, p) != corner_.begin() + count_;
  }
  void add(const Vector3d& p) { corner_[static_cast<std::size_t>(count_++)] = p; }

  Nearest nearest(ShapeQuery& q, const StartNormal& start) {
    const Nearest found = search(q, start);
    if (found.apart) reduce(found);
    return found;
  }

 private:
  const Vector3d& at(int i) const { return corner_[static_cast<std::size_t>(i)]; }

  Nearest search(ShapeQuery& q, const StartNormal& start) const {
    if (count_ == 1) {
      Nearest found = nearestOn(q, PointFeature{corner_[0]}, start);
      found.corner[0] = 0;
      return found;
    }
    if (count_ == 2) return nearestOnSegment(q, corner_[0], corner_[1], start);
    if (count_ == 3) return nearestOnTriangle(q, corner_[0], corner_[1], corner_[2], start);
    // The fourth corner is the new one, and the nearest point lies on a face that contains it.
    constexpr std::array<std::array<int, 3>, 3> kWithNew{{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    Nearest best;
    for (const auto& face : kWithNew) {
      Nearest next = nearestOnTriangle(q, at(face[0]), at(face[1]), at(face[2]), start);
      for (int& corner : next.corner) corner = face[static_cast<std::size_t>(corner)];
      if (!next.apart) return next;
      if (!best.apart || isNearer(q, next, best, corner_.data(), 4)) best = next;
    }
    return best;
  }

  void reduce(const Nearest& found) {
    const auto old = corner_;
    count_ = found.corners;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i)
      corner_[i] = old[static_cast<std::size_t>(found.corner[i])];
  }

  std::array<Vector3d, 4> corner_{Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(0, 0, 0)};
  int count_ = 0;
};

}  // namespace

Nearest nearestOnPolytope(ShapeQuery& q, const StartNormal& start) {
  if (q.shape.kind == ShapeKind::triangle)
    return nearestOnTriangle(q, q.pose.placed(q.shape.corner[0]), q.pose.placed(q.shape.corner[1]),
                             q.pose.placed(q.shape.corner[2]), start);
  constexpr int kRounds = 60;  // a handful is usual; each lowers the distance, so the search cannot cycle
  CornerSet set;
  set.add(q.facing(start.n));
  Nearest found = set.nearest(q, start);
  Vector3d w = q.facing(found.n);
  for (int i = 0; i < kRounds && found.apart; ++i) {
    if (found.n.dot(found.y - w) <= 0.5 * q.rounding.gap || set.holds(w)) break;
    set.add(w);
    const Nearest next = set.nearest(q, {found.n, found.patch});
    const Vector3d facing = q.facing(next.n);
    const std::array<Vector3d, 2> both{w, facing};
    if (next.apart && !isNearer(q, next, found, both.data(), 2)) break;  // rounding
    found = next;
    w = facing;
  }
  return found;
}

}  // namespace fcl_stpbv::detail
