// Finds the feature of a simple shape that determines its penetration depth into an STP-BV.
//
// 1. Start near the answer. Newton's method on one feature gives the normal and both points up to rounding;
//    for a flat face the normal is known. Flatter features are tried first.
// 2. The result is accepted if it is the answer for the whole shape: the point is on the shape, no other
//    point of the shape is nearer along the normal, and the depth is not larger than the known one.
// 3. The curvature of the feature and of the volume's patch gives a region of normals without a wider gap
//    (convex/local_maximum.h).
#include <algorithm>
#include <array>
#include <optional>

#include "fcl_stpbv/convex/local_maximum.h"
#include "fcl_stpbv/convex/onto_core.h"
#include "fcl_stpbv/convex/shape_curvature.h"
#include "fcl_stpbv/distance/patch_pair.h"
#include "fcl_stpbv/distance/shape_query.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/patch_view.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

/// Newton's method on one feature, from a start near the least overlap. No value if it does not converge.
/// `ascend`: then it ascends step by step, which takes longer.
template <typename Feature>
std::optional<Nearest> deepestOn(ShapeQuery& q, const Feature& feature, const StartNormal& start,
                                 bool ascend) {
  constexpr int kSteps = 20, kHalvings = 12;  // the start is good to some digits
  const Vector3d* t = feature.direction();
  const Vector3d n = t ? acrossLine(start.n, *t) : start.n;
  AscentPoint x = ascentPoint(q.body, feature, n, start.patch, q.steps);
  const auto rounded = [&] { return q.rounding.across + feature.wobble(x.view.n); };
  for (int i = 0; i < kSteps && x.across.norm() > 0.25 * rounded(); ++i) {
    Vector3d to = newtonTarget(q.body, x, feature.direction());
    bool flatter = false;  // a step across a region boundary may be too long
    for (int k = 0; k < kHalvings && !flatter; ++k, to = (to + x.view.n).normalized()) {
      ++q.pairs;
      const AscentPoint y = ascentPoint(q.body, feature, to, x.view.patch, q.steps);
      flatter = y.across.norm() < x.across.norm();
      if (flatter) x = y;
    }
    if (!flatter) break;
  }
  if (x.across.norm() <= rounded()) return nearestFrom(x, feature);
  if (!ascend) return {};
  // At a large R the region of a patch is narrower than the error of the start. Beyond its boundaries
  // Newton's step leads elsewhere.
  x = ascentPoint(q.body, feature, n, start.patch, q.steps);
  if (!ascendFrom(q.body, feature, x, q.rounding, q.pairs, q.steps)) return {};
  return nearestFrom(x, feature);
}

/// Whether `found` is the answer for the whole shape. Its point may lie between the shape's corners `met`.
bool isDeepest(const ShapeQuery& q, const Nearest& found, double leastOverlap, const ShapeCorners& met) {
  if (!(found.gap >= leastOverlap - q.rounding.gap)) return false;
  if (found.n.dot(found.y - q.facing(found.n)) > q.rounding.gap) return false;
  if (met.count > 0 && (ontoTriangle(met.three(), found.y) - found.y).norm() <= 2.0 * q.rounding.gap)
    return true;
  if (q.shape.kind == ShapeKind::ellipsoid) return besideEllipsoid(q, found.y) <= 2.0 * q.rounding.gap;
  const Vector3d own = q.pose.inSecond(found.y);
  return (ontoCore(q.shape, own) - own).norm() <= 2.0 * q.rounding.gap;
}

bool hasCorners(const Shape& shape) {
  return shape.kind == ShapeKind::box || shape.kind == ShapeKind::triangle ||
         shape.kind == ShapeKind::polytope;
}

/// The features that the least overlap may be on.
class DeepFeatures {
 public:
  /// `met`: the shape's corners that EPA's answer is a combination of. `ascend`: whether to ascend where
  /// Newton's method fails.
  DeepFeatures(ShapeQuery& q, const StartNormal& start, double leastOverlap, const ShapeCorners& met,
               bool ascend)
      : q_(q), start_(start), least_(leastOverlap), met_(met), ascend_(ascend) {}

  /// The first feature that has the answer.
  std::optional<DeepFeature> search() {
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
        generator();
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

  /// For a polytope: its face, edge or corner along the start's normal.
  std::optional<DeepFeature> searchAlongNormal() {
    for (const double angle : {1e-3, 1e-6, 1e-9}) {  // rad: rounding of the gap may turn the normal by this
      if (found_ || (angle > 1e-4 && !ascend_)) continue;
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
  /// Takes the result of `search` if it is the answer. For a shape whose features have no names, `around`
  /// adds the part of the face or edge between the met corners around the point.
  template <typename Search, typename Around>
  void take(const Search& search, const Around& around) {
    if (found_) return;
    const std::optional<Nearest> next = search();
    if (!next || !isDeepest(q_, *next, least_, met_)) return;
    found_.emplace(DeepFeature{*next, {}});
    const SupportPoint view = viewVolume(q_.body, next->n, next->patch, q_.steps);
    if (!((view.point + next->gap * next->n - next->y).norm() <= 4.0 * q_.rounding.across)) return;
    LocalMaximum& local = found_->around.emplace(next->n, -next->gap);
    const auto inside = [&] { return -q_.body.outside(view.patch, next->n); };
    addPatch(posedPatch(q_.body, view.patch), next->n, inside, local);
    if (hasAround(q_.shape))
      addShape(q_.shape, q_.pose.inSecond(next->y), q_.pose.opposite(next->n), q_.rotation, local);
    else
      around(*next, local);
  }
  template <typename Search>
  void take(const Search& search) {
    take(search, [](const Nearest&, LocalMaximum&) {});
  }
  void point(const Vector3d& p) {
    take([&] { return deepestOn(q_, PointFeature{p}, start_, ascend_); });
  }
  /// A line on the shape. `length` (m): of the edge between two met corners, 0 for a named feature.
  void line(const Vector3d& p, const Vector3d& t, double length = 0.0) {
    take(
        [&] {
          return deepestOn(q_, LineFeature{p, t}, start_, ascend_);
        },
        [&](const Nearest& at, LocalMaximum& local) {
          const double along = t.dot(at.y - p);
          local.addSegment(t, std::min(along, length - along));
        });
  }
  void rim(const Vector3d& middle, const Vector3d& axis) {
    RimFeature feature{middle, axis, q_.shape.radius};
    if (ascend_) feature.floor = 1e-12;  // at a large R the normal may be this near the axis
    take([&] { return deepestOn(q_, feature, start_, ascend_); });
  }
  /// A flat face with the normal `n` or `-n`. `inside` returns the distance of a point from the boundary of
  /// the known part of the face.
  template <typename Inside>
  void plane(const Vector3d& p, const Vector3d& n, const Inside& inside) {
    const Vector3d along = n.dot(start_.n) < 0.0 ? Vector3d(-n) : n;
    take([&] { return std::optional(nearestOnPlane(q_, p, along, start_.patch)); },
         [&](const Nearest& at, LocalMaximum& local) { local.addDisc(inside(at.y)); });
  }
  void plane(const Vector3d& p, const Vector3d& n) {
    plane(p, n, [](const Vector3d&) { return 0.0; });
  }
  /// A cylinder's side: its axis, with the radius around it.
  void side(const Vector3d& axis) {
    take([&] {
      std::optional<Nearest> found = deepestOn(q_, LineFeature{q_.translation, axis}, start_, ascend_);
      if (!found) return found;
      found->gap -= q_.shape.radius;
      found->y -= q_.shape.radius * found->n;
      return found;
    });
  }
  void generator() {
    take([&] { return std::optional(nearestOnGenerator(q_, start_)); });
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
      std::optional<Nearest> found = deepestOn(q_, e.whole, start_, ascend_);
      if (!found || !(e.whole.wobble(found->n) > q_.rounding.across)) return found;
      placeOppositeOnEllipsoid(q_, *found);
      const Vector3d opposite =
          viewVolume(q_.body, found->n, found->patch, q_.steps).point + found->gap * found->n;
      if ((found->y - opposite).norm() > 4.0 * q_.rounding.across) return {};
      return found;
    });
  }
  /// The face, the edges and the corners of up to three met corners.
  void corners() {
    const std::array<Vector3d, 3>& p = met_.p;
    if (met_.count == 3) {
      const Vector3d n = (p[1] - p[0]).cross(p[2] - p[0]);
      const auto inside = [&](const Vector3d& y) {
        double least = kInfinity;
        for (std::size_t i = 0; i < 3; ++i) {
          const Vector3d side = p[(i + 1) % 3] - p[i];
          least = std::min(least, n.dot(side.cross(y - p[i])) / (n.norm() * side.norm()));
        }
        return least;
      };
      if (n.norm() > 0.0) plane(p[0], n.normalized(), inside);
    }
    const auto count = static_cast<std::size_t>(met_.count);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < i; ++k) {
        const Vector3d side = p[k] - p[i];
        line(p[i], side.normalized(), side.norm());
      }
    for (std::size_t i = 0; i < count; ++i) point(p[i]);
  }

  ShapeQuery& q_;
  StartNormal start_;
  double least_;
  const ShapeCorners& met_;
  bool ascend_;
  std::optional<DeepFeature> found_;
};

}  // namespace

std::optional<DeepFeature> deepestFeature(ShapeQuery& q, const StartNormal& start, double leastOverlap,
                                          const ShapeCorners& met, bool ascend) {
  DeepFeatures features(q, start, leastOverlap, met, ascend);
  const std::optional<DeepFeature> found = features.search();
  // EPA may have met other corners than those of the feature.
  return found || !ascend || !hasCorners(q.shape) ? found : features.searchAlongNormal();
}

std::optional<DeepFeature> touchingFeature(ShapeQuery& q, const Nearest& near) {
  const ShapeCorners none;
  DeepFeatures features(q, {near.n, near.patch}, near.gap, none, false);
  return hasCorners(q.shape) ? features.searchAlongNormal() : features.search();
}

}  // namespace fcl_stpbv::detail
