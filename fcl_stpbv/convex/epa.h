// EPA: how deep the origin is inside a convex set (van den Bergen 2001, "expanding polytope").
//
// The set is the Minkowski difference B - A of two overlapping cores. Only its support points are used:
// 1. Begin with four points of the difference that span a volume. The origin need not be inside yet.
// 2. Take the polytope's face nearest to the origin. The polytope lies inside the difference. So once the
//    origin is inside the polytope, the distance of that face is a lower bound on the depth. If A's core is
//    round, the curvature gives a better bound, because the surface lies beyond the face.
// 3. The support point along the face's normal gives an upper bound: a translation along that normal
//    separates the bodies.
// 4. When the bounds are close, the caller may compute the local maximum of the gap exactly, and a region
//    around it without a wider gap (local_maximum.h). Faces within that region are removed from the search.
// 5. Stop if both bounds agree. Otherwise add the support point to the polytope and go to 2.
// Rounding may spoil a polytope, because of slivers along edges and generators. Then the search starts again
// from another tetrahedron.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <type_traits>

#include "fcl_stpbv/convex/local_maximum.h"
#include "fcl_stpbv/convex/polytope.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

/// Calls `visit` with the polytope's nearest face, until `visit` returns false or rounding stops it. `visit`
/// must either expand the polytope or put the face aside.
template <typename AnyPolytope, typename Visit>
void expandAtNearest(AnyPolytope& polytope, Visit&& visit) {
  while (polytope.sound() && visit(polytope.nearest())) {
  }
}

/// Normals to begin a polytope with, of any length: three tilted from the unit vector `n`, a third of a turn
/// apart, and the opposite one.
inline std::array<Eigen::Vector3d, 4> normalsAround(const Eigen::Vector3d& n) {
  constexpr double kRing = 0.8;  // the tilt's tangent
  const Eigen::Vector3d e = n.unitOrthogonal(), f = std::sqrt(0.75) * n.cross(e);
  return {n - kRing * e, n - kRing * (f - 0.5 * e), n + kRing * (f + 0.5 * e), -n};
}

/// Four points of a convex set that span a volume. `furthest(m)` is the set's furthest along the unit vector
/// `m`, and `place(point)` where that is (m). The directions are those of a frame rotated by `turn`. False if
/// the set is flat up to `rounding` (m); its support points along both normals of the flat set have then been
/// evaluated.
template <typename Point, typename Furthest, typename Place>
bool spanVolume(const Eigen::Matrix3d& turn, double rounding, const Furthest& furthest, const Place& place,
                Point* c) {
  using Eigen::Vector3d;
  const auto along = [&](const Vector3d& m) { return furthest((turn * m).normalized()); };
  const auto widen = [&](const Vector3d& m, const auto& measure, Point& best) {
    for (const Vector3d& d : {m, Vector3d(-m)}) {
      const Point p = along(d);
      if (measure(place(p)) > measure(place(best))) best = p;
    }
  };
  // Directions in the turned frame; lengths are the same in both.
  const auto turned = [&](const Vector3d& v) { return Vector3d(turn.transpose() * v); };
  c[0] = along(Vector3d::UnitX());
  const Vector3d first = place(c[0]);
  c[1] = c[0];
  const auto fromPoint = [&](const Vector3d& w) { return (w - first).norm(); };
  for (int i = 0; i < 3; ++i) widen(Vector3d::Unit(i), fromPoint, c[1]);
  if (!(fromPoint(place(c[1])) > rounding)) return false;
  const Vector3d u = turned(place(c[1]) - first).normalized(), e = u.unitOrthogonal();
  c[2] = c[0];
  const auto fromLine = [&](const Vector3d& w) { return u.cross(turned(w - first)).norm(); };
  widen(e, fromLine, c[2]);
  widen(u.cross(e), fromLine, c[2]);
  if (!(fromLine(place(c[2])) > rounding)) return false;
  const Vector3d m = u.cross(turned(place(c[2]) - first)).normalized();
  c[3] = c[0];
  const auto fromPlane = [&](const Vector3d& w) { return std::abs(m.dot(turned(w - first))); };
  widen(m, fromPlane, c[3]);
  return fromPlane(place(c[3])) > rounding;
}

/// Finds the penetration depth of two cores. `Difference` is a ConvexDifference, or a type with the same
/// `Corner` and `support`.
template <typename Difference>
class Epa {
 public:
  using Corner = typename Difference::Corner;

  /// `rounding`: of a gap (m). `rho`: A's core is an intersection of balls of this radius (m).
  Epa(Difference& difference, double rounding, double rho = std::numeric_limits<double>::infinity())
      : difference_(difference), rounding_(rounding), rho_(rho) {}

  double gap = -std::numeric_limits<double>::infinity();  ///< widest gap found so far: minus the depth (m)
  Eigen::Vector3d n{0, 0, 1};                             ///< its normal, unit, from A to B
  Eigen::Vector3d onA{0, 0, 0};                           ///< A's point there; B's is `gap` along `n` from it
  /// Upper bound on the gap along every normal (m). It starts with 0, since cores that overlap have no gap.
  double bound = 0;
  std::array<Corner, 3> met;  ///< corners of the difference that `onA` is of
  int metCount = 0;

  /// The difference's corner furthest against the unit vector `m`; remembers the least overlap.
  Corner look(const Eigen::Vector3d& m) {
    const Corner c = difference_.support(m);
    if (c.gap > gap) {
      gap = c.gap;
      n = m;
    }
    if (offer(c.onA, c.w)) met[0] = c, metCount = 1;
    return c;
  }

  /// Offers a point of A and the vector from it to a point of B. Keeps them, and returns true, if they are
  /// closer to the answer's points than the known ones.
  bool offer(const Eigen::Vector3d& pointOfA, const Eigen::Vector3d& toB) {
    if (!(off(toB) < off())) return false;
    onA = pointOfA;
    toB_ = toB;
    metCount = 0;
    return true;
  }

  /// B's point of the answer, as accurately as it is known.
  Eigen::Vector3d onB() const { return onA + toB_; }
  /// Error of onB(): its distance from the point opposite `onA` at the known depth (m).
  double off() const { return off(toB_); }

  /// Whether both bounds agree, to 1e-6 of the depth or to rounding.
  bool solved() const { return bound - gap <= kRelative * std::max(-bound, 0.0) + rounding_; }

  /// Searches until the bounds agree. False where rounding or the polytope's
  /// size stopped it; both bounds hold.
  bool run() {
    return run([](Epa&) { return std::optional<LocalMaximum>(); });
  }
  /// Calls `maximum(epa)` once the bounds are close. It moves the search to the maximum next to `n`, and
  /// returns the LocalMaximum there, or nothing.
  template <typename FindMaximum>
  bool run(const FindMaximum& maximum) {
    constexpr int kAttempts = 4;
    for (int attempt = 0; attempt < kAttempts && !solved(); ++attempt) {
      const Eigen::Matrix3d turn =
          Eigen::AngleAxisd(attempt, Eigen::Vector3d(0.48, 0.6, 0.64)).toRotationMatrix();
      Tetrahedron first;
      const bool around = attempt == 0 && spanAround(first);
      if (!around && !spanVolume(
                         turn, rounding_, [&](const Eigen::Vector3d& m) { return look(-m); },
                         [](const Corner& c) -> const Eigen::Vector3d& { return c.w; }, first.data()))
        break;
      expand(first, maximum);
    }
    return solved();
  }

 private:
  static constexpr double kRelative = 1e-6;  // of the depth, for round bodies
  static constexpr int kMore = 16;         // steps from there for a normal to rounding, which flat faces give
  static constexpr double kNear = 0.03;    // of the depth: from here a maximum is likely to be found
  static constexpr double kNearer = 0.03;  // of that, from where it is tried again
  using Tetrahedron = std::array<Corner, 4>;

  /// Storage for the corners of all points of a polytope. It is not initialised, because that would take as
  /// long as several steps of the search.
  class Corners {
   public:
    explicit Corners(const Tetrahedron& first) {
      for (const Corner& c : first) add(c);
    }
    void add(const Corner& c) { new (&room_[count_++].corner) Corner(c); }
    bool full() const { return count_ == room_.size(); }
    const Corner& operator[](std::size_t i) const { return room_[i].corner; }

   private:
    union Room {
      Room() {}
      Corner corner;
    };
    static_assert(std::is_trivially_destructible_v<Corner>);
    std::size_t count_ = 0;
    std::array<Room, Polytope::kMaxPoints> room_;
  };

  /// Three points around the best normal so far and one behind. False where they are almost in one plane.
  bool spanAround(Tetrahedron& point) {
    constexpr double kFlat = 0.01;  // of the volume of a box with sides as long
    const std::array<Eigen::Vector3d, 4> normal = normalsAround(n);
    for (std::size_t i = 0; i < 4; ++i) point[i] = look(normal[i].normalized());
    const Eigen::Vector3d a = point[0].w - point[3].w, b = point[1].w - point[3].w,
                          c = point[2].w - point[3].w;
    return std::abs(a.dot(b.cross(c))) > kFlat * a.norm() * b.norm() * c.norm();
  }

  template <typename FindMaximum>
  void expand(const Tetrahedron& first, const FindMaximum& maximum) {
    Corners point(first);
    int more = 0;
    double near = kNear;
    std::optional<LocalMaximum> top;
    const std::array<Eigen::Vector3d, 4> part{point[0].onA, point[1].onA, point[2].onA, point[3].onA};
    WidePolytope polytope({point[0].w, point[1].w, point[2].w, point[3].w}, Polytope::Origin::anywhere, rho_,
                          &part);
    expandAtNearest(polytope, [&](const Polytope::Face& face) {
      if (face.depth > 0.0) bound = std::min(bound, -face.depth);
      if (top) {
        if (-gap - face.depth <= rounding_) return false;
        if (top->holdsBeyond(face.normal, polytope.leastAlong(face))) {
          polytope.putAside();
          return true;
        }
      }
      const Corner next = look(-face.normal);
      const double open = -gap - face.depth;
      if (open <= kNear * std::max(face.depth, 0.0) + rounding_)
        offerFace(point[face.corner[0]], point[face.corner[1]], point[face.corner[2]],
                  face.distance * face.normal);
      if (open <= near * face.depth && (!top || gap > rounding_ - top->depth())) {
        near *= kNearer;
        top = maximum(*this);
      }
      if (face.depth > 0.0 && open <= kRelative * face.depth + rounding_ &&
          (open <= rounding_ || ++more > kMore))
        return false;
      if (!(face.normal.dot(next.w) - face.distance > rounding_) || point.full()) return false;
      point.add(next);
      return polytope.expand(next.w, next.onA);
    });
    // Faces in one plane are equally near: the origin is above one of them.
    while (polytope.sound() && off() > rounding_) {
      const Polytope::Face face = polytope.nearest();
      if (!(face.depth <= -gap + rounding_)) break;
      offerFace(point[face.corner[0]], point[face.corner[1]], point[face.corner[2]],
                face.distance * face.normal);
      polytope.putAside();
    }
  }

  /// How far a way from A to B is from the answer's (m).
  double off(const Eigen::Vector3d& toB) const { return (toB - gap * n).norm(); }

  /// The face's point nearest to the origin.
  void offerFace(const Corner& a, const Corner& b, const Corner& c, const Eigen::Vector3d& nearest) {
    const Eigen::Vector3d e = b.w - a.w, f = c.w - a.w, m = e.cross(f), p = nearest - a.w;
    const double area = m.squaredNorm();
    Eigen::Vector3d weight(0.0, p.cross(f).dot(m) / area, e.cross(p).dot(m) / area);
    weight[0] = 1.0 - weight[1] - weight[2];
    weight = weight.cwiseMax(0.0);
    if (!(weight.sum() > 0.0) || !weight.allFinite()) return;
    weight /= weight.sum();
    if (!offer(weight[0] * a.onA + weight[1] * b.onA + weight[2] * c.onA,
               weight[0] * a.w + weight[1] * b.w + weight[2] * c.w))
      return;
    for (const int i : {0, 1, 2})
      if (weight[i] > 0.0) met[at(metCount++)] = i == 0 ? a : i == 1 ? b : c;
  }

  Difference& difference_;
  double rounding_, rho_;
  Eigen::Vector3d toB_ =
      Eigen::Vector3d::Constant(1e150);  // from `onA` to the point of B that it was found with
};

}  // namespace fcl_stpbv::detail
