// An STP-BV and a simple shape whose cores overlap: how deep they are in each other, where neither a point of
// the shape alone (point_overlap.cpp) nor the cones of its normals (cone_overlap.cpp) tell it.
//
// 1. EPA (convex/epa.h) on the difference of the two cores bounds the depth, and finds its normal to some
//    digits.
// 2. The features that met there are tried, the flatter ones first: Newton's method on one of them gives
//    the normal and both witness points to rounding.
// 3. What it gives is taken if it is the whole shape's answer: on the shape, with nothing of the shape
//    nearer, and no deeper than what EPA found.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "fcl_stpbv/convex/epa.h"
#include "fcl_stpbv/convex/onto_core.h"
#include "fcl_stpbv/convex/shape_curvature.h"
#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/distance/shape_distance.h"
#include "fcl_stpbv/distance/shape_query.h"

namespace fcl_stpbv::detail {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// The difference of the volume's core and the shape's; its corners remember the shape's own.
class ShapeDifference {
 public:
  struct Corner {
    Vector3d w{0, 0, 0};      ///< the point of the difference (m)
    Vector3d onA{0, 0, 0};    ///< the volume's part of it
    double gap = 0;           ///< between the supporting planes that it was found with (m)
    Vector3d shape{0, 0, 0};  ///< the shape's part, in the volume's frame
  };

  explicit ShapeDifference(ShapeQuery& q) : q_(q) {}

  /// EPA's normals go to and fro: the patch is sought from a table, not from the last one.
  Corner support(const Vector3d& n) {
    const SupportPoint p = viewVolume(q_.body, n, -1, q_.steps);
    const Vector3d y = q_.facing(n);
    ++q_.pairs;
    return {y - p.point, p.point, p.gap(y), y};
  }

 private:
  ShapeQuery& q_;
};

/// To the top of the hill that the search ended on, where rounding or the size of the polytope stopped it:
/// tries normals around the best one, nearer and nearer.
template <typename Search>
void climbToLeastOverlap(Search& epa) {
  constexpr int kTrials = 4000;
  double step = 0.02;  // rad
  for (int trials = 0; step > 1e-9 && trials < kTrials;) {
    const Vector3d n = epa.n, e = n.unitOrthogonal(), f = n.cross(e);
    const double gap = epa.gap;
    for (int k = 0; k < 8 && epa.gap <= gap; ++k, ++trials) {
      const double angle = 0.785398163397448 * k + 40.0 * step;  // turned a little each round
      epa.look((n + step * (std::cos(angle) * e + std::sin(angle) * f)).normalized());
    }
    if (epa.gap <= gap) step *= 0.5;
  }
}

/// Newton's method along one feature, from next to the least overlap. Nothing if it does not converge.
template <typename Feature>
std::optional<Nearest> deepestOn(ShapeQuery& q, const Feature& feature, const StartNormal& start) {
  constexpr int kSteps = 20, kHalvings = 12;  // the start is good to some digits
  const Vector3d* t = feature.direction();
  const Vector3d n = t ? acrossLine(start.n, *t) : start.n;
  AscentPoint x = ascentPoint(q.body, feature, n, start.patch, q.steps);
  const auto rounded = [&] { return q.rounding.across + feature.wobble(x.view.n); };
  for (int i = 0; i < kSteps && x.across.norm() > 0.25 * rounded(); ++i) {
    Vector3d to = newtonTarget(q.body, x, feature.direction());
    bool flatter = false;  // a step over a region boundary may be too long
    for (int k = 0; k < kHalvings && !flatter; ++k, to = (to + x.view.n).normalized()) {
      ++q.pairs;
      const AscentPoint y = ascentPoint(q.body, feature, to, x.view.patch, q.steps);
      flatter = y.across.norm() < x.across.norm();
      if (flatter) x = y;
    }
    if (!flatter) break;
  }
  if (!(x.across.norm() <= rounded())) return {};
  return nearestFrom(x, feature);
}

/// Whether `found` is the whole shape's answer. `met` are corners of the shape that it may be between.
bool isDeepest(const ShapeQuery& q, const Nearest& found, double leastOverlap, const ShapeCorners& met) {
  if (!(found.gap >= leastOverlap - q.rounding.gap)) return false;
  if (found.n.dot(found.y - q.facing(found.n)) > q.rounding.gap) return false;
  if (met.count > 0 && (ontoTriangle(met.three(), found.y) - found.y).norm() <= 2.0 * q.rounding.gap)
    return true;
  if (q.shape.kind == ShapeKind::ellipsoid) return besideEllipsoid(q, found.y) <= 2.0 * q.rounding.gap;
  Shape core = q.shape;
  core.margin = 0.0;
  Isometry3d at = Isometry3d::Identity();
  at.translation() = q.rotation.transpose() * (found.y - q.translation);
  return distance(Shape::sphere(0.0), at, core, Isometry3d::Identity()).distance <= 2.0 * q.rounding.gap;
}

/// The features that the least overlap may be on.
class DeepFeatures {
 public:
  /// `met` are corners of the shape that EPA's answer is of.
  DeepFeatures(ShapeQuery& q, const StartNormal& start, double leastOverlap, const ShapeCorners& met)
      : q_(q), start_(start), least_(leastOverlap), met_(met) {}

  /// The first that holds the answer.
  std::optional<Nearest> search() {
    const Vector3d axis = q_.rotation.col(2), top = q_.translation + q_.shape.half * axis,
                   bottom = q_.translation - q_.shape.half * axis;
    const bool up = start_.n.dot(axis) < 0.0;  // the end that faces the volume
    switch (q_.shape.kind) {
      case ShapeKind::point:
        point(q_.translation);
        break;
      case ShapeKind::segment:
        line(q_.translation, axis);
        point(up ? top : bottom);
        break;
      case ShapeKind::box:
      case ShapeKind::triangle:
      case ShapeKind::polytope:
        corners();
        break;
      case ShapeKind::cylinder:
        plane(up ? top : bottom, axis);
        side(axis);
        rim(up ? top : bottom, axis);
        break;
      case ShapeKind::cone:
        plane(bottom, axis);
        take([&] { return std::optional(nearestOnGenerator(q_, start_)); });
        point(top);
        rim(bottom, axis);
        break;
      case ShapeKind::ellipsoid:
        ellipsoid();
        break;
      case ShapeKind::halfspace:
      case ShapeKind::plane:
        break;
    }
    return found_;
  }

  /// The same of a polytope whose cores only touch: its face, edge or corner along the start's normal.
  std::optional<Nearest> searchAlongNormal() {
    for (const double angle : {1e-6, 1e-9}) {  // rad, by which the gap's rounding may turn the normal
      NormalCone cone;
      const Vector3d p = q_.facing(start_.n);
      if (!normalCone(q_.shape, q_.pose.opposite(start_.n), p, 2.0 * angle * q_.shape.reach, cone)) continue;
      const auto turned = [&](const Vector3d& v) { return Vector3d(q_.rotation * v); };
      if (cone.count == 0) plane(p, turned(cone.normal));
      if (cone.count == 1) line(p, turned(cone.normal.cross(cone.way[0])));
      if (cone.count == 2) point(p);
    }
    return found_;
  }

 private:
  template <typename Search>
  void take(const Search& search) {
    if (found_) return;
    const std::optional<Nearest> next = search();
    if (next && isDeepest(q_, *next, least_, met_)) found_ = next;
  }
  void point(const Vector3d& p) {
    take([&] { return deepestOn(q_, PointFeature{p}, start_); });
  }
  void line(const Vector3d& p, const Vector3d& t) {
    take([&] { return deepestOn(q_, LineFeature{p, t}, start_); });
  }
  void rim(const Vector3d& middle, const Vector3d& axis) {
    take([&] { return deepestOn(q_, RimFeature{middle, axis, q_.shape.radius}, start_); });
  }
  /// A flat face: its normal is given, either way.
  void plane(const Vector3d& p, const Vector3d& n) {
    const Vector3d along = n.dot(start_.n) < 0.0 ? Vector3d(-n) : n;
    take([&] { return std::optional(nearestOnPlane(q_, p, along, start_.patch)); });
  }
  /// A cylinder's: its axis with the radius around it.
  void side(const Vector3d& axis) {
    take([&] {
      std::optional<Nearest> found = deepestOn(q_, LineFeature{q_.translation, axis}, start_);
      if (!found) return found;
      found->gap -= q_.shape.radius;
      found->y -= q_.shape.radius * found->n;
      return found;
    });
  }
  void ellipsoid() {
    const PosedEllipsoid e(q_);
    if (e.isSegment) {
      const Vector3d axis = e.whole.axes.col(e.longest);
      line(q_.translation, q_.rotation.col(e.longest));
      point(q_.translation + (start_.n.dot(axis) < 0.0 ? axis : Vector3d(-axis)));
      return;
    }
    if (e.isDisc) plane(q_.translation, q_.rotation.col(e.shortest));
    take([&]() -> std::optional<Nearest> {
      std::optional<Nearest> found = deepestOn(q_, e.whole, start_);
      if (!found || !(e.whole.wobble(found->n) > q_.rounding.across)) return found;
      placeOppositeOnEllipsoid(q_, *found);
      const Vector3d opposite =
          viewVolume(q_.body, found->n, found->patch, q_.steps).point + found->gap * found->n;
      if ((found->y - opposite).norm() > 4.0 * q_.rounding.across) return {};
      return found;
    });
  }
  /// Of up to three corners: the face, the edges, the corners alone.
  void corners() {
    const std::array<Vector3d, 3>& p = met_.p;
    if (met_.count == 3) {
      const Vector3d n = (p[1] - p[0]).cross(p[2] - p[0]);
      if (n.norm() > 0.0) plane(p[0], n.normalized());
    }
    const auto count = static_cast<std::size_t>(met_.count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < i; ++k) line(p[i], (p[k] - p[i]).normalized());
    for (std::size_t i = 0; i < count; ++i) point(p[i]);
  }

  ShapeQuery& q_;
  StartNormal start_;
  double least_;
  const ShapeCorners& met_;
  std::optional<Nearest> found_;
};

}  // namespace

std::optional<Nearest> touchingFeature(ShapeQuery& q, const Nearest& near) {
  const ShapeCorners none;
  DeepFeatures features(q, {near.n, near.patch}, near.gap, none);
  const ShapeKind kind = q.shape.kind;
  if (kind == ShapeKind::box || kind == ShapeKind::triangle || kind == ShapeKind::polytope)
    return features.searchAlongNormal();
  return features.search();
}

void polishOverlap(ShapeQuery& q, const ShapeCorners& met, LeastOverlap& found) {
  if (const auto exact = DeepFeatures(q, {found.at.n, found.at.patch}, found.at.gap, met).search())
    found.at = *exact;
}

LeastOverlap leastOverlap(ShapeQuery& q, const StartNormal& start) {
  ShapeDifference difference(q);
  Epa<ShapeDifference> epa(difference, q.rounding.gap, q.body.radii().rho);
  epa.look(start.n);
  if (!epa.run()) climbToLeastOverlap(epa);
  ShapeCorners met;
  for (int i = 0; i < epa.metCount; ++i) {
    const Vector3d& p = epa.met[static_cast<std::size_t>(i)].shape;
    if (std::find(met.p.begin(), met.p.begin() + met.count, p) == met.p.begin() + met.count)
      met.p[static_cast<std::size_t>(met.count++)] = p;
  }
  // The polytope's points are the volume's to the rounding of its own.
  LeastOverlap best{{}, std::max(epa.bound, epa.gap) + q.rounding.across, true, epa.solved()};
  best.at.n = epa.n;
  best.at.gap = epa.gap;
  best.at.y = epa.onB();
  best.at.corners = 1;
  polishOverlap(q, met, best);
  return best;
}

}  // namespace fcl_stpbv::detail
