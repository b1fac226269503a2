// A pair of an STP-BV and a simple shape, and the searches between them.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "fcl_stpbv/convex/local_maximum.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/convex/shape.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/shape_ascent.h"

namespace fcl_stpbv::detail {

/// The pair in the frame of the STP-BV. So rounding errors depend only on the bodies' own coordinates and
/// their mutual distance.
struct ShapeQuery {
  const StpBv& body;
  const Shape& shape;
  const RelativePose& pose;     ///< of the shape in the body's frame
  Eigen::Matrix3d rotation;     ///< the same
  Eigen::Vector3d translation;  ///< m
  Rounding rounding;
  int pairs = 0;  ///< Newton steps and closed forms, the work done
  int steps = 0;  ///< patches changed

  ShapeQuery(const StpBv& body, const Shape& shape, const RelativePose& pose);

  /// The shape's core point furthest against `n`, the one that faces a body in that direction.
  Eigen::Vector3d facing(const Eigen::Vector3d& n) const {
    return pose.placed(shape.support(pose.opposite(n)));
  }
  Eigen::Vector3d posed(const Eigen::Vector3d& p) const { return pose.placed(p); }
};

/// The nearest points of the cores, as a search found them.
struct Nearest {
  Eigen::Vector3d n{0, 0, 0};  ///< unit, from the body to the shape
  int patch = -1;
  Eigen::Vector3d y{0, 0, 0};  ///< the shape's core point
  double gap = 0;              ///< between the body's supporting plane and `y` (m)
  bool apart = false;          ///< the gap is positive and the widest for the points searched
  int corners = 0;             ///< how many of the searched points hold `y`, and which
  std::array<int, 3> corner{0, 1, 2};
};

/// The start of a search: a cached or guessed normal.
struct StartNormal {
  Eigen::Vector3d n;
  int patch;
};

/// From the pair's last answer, else from the volume's centre to the shape's.
StartNormal startOf(const ShapeQuery& q, const PairCache& last);

/// Whether `x` is nearer than `than`. Near a boundary, gaps differ only by the square of the difference of
/// their normals, which may be below rounding. Then the better one is that whose point `y` the shape's other
/// points exceed by less: the largest length by which one of them is nearer to the body, along the normal.
bool isNearer(const ShapeQuery& q, const Nearest& x, const Nearest& than, const Eigen::Vector3d* points,
              int count);

/// The widest gap that a search of the two whole cores found.
struct LeastOverlap {
  Nearest at;    ///< the best normal seen; `gap` is the true gap along it
  double bound;  ///< no normal has a wider one (m)
  bool overlap;  ///< the cores have a common point, beyond rounding
  bool solved;   ///< the remaining normals are one to rounding
};

/// The unit vector across the unit vector `t` on the side that `n` is on; any where `n` runs along it, where
/// rounding would lean along `t`.
inline Eigen::Vector3d acrossLine(const Eigen::Vector3d& n, const Eigen::Vector3d& t) {
  const Eigen::Vector3d side = n - n.dot(t) * t;
  const double across = side.norm();
  const Eigen::Vector3d unit = across > 1e-6 ? Eigen::Vector3d(side / across) : t.unitOrthogonal();
  return (unit - unit.dot(t) * t).normalized();
}

/// What a climb ended on.
template <typename Feature>
Nearest nearestFrom(const AscentPoint& x, const Feature& feature) {
  Nearest found;
  found.n = x.view.n;
  found.patch = x.view.patch;
  found.y = x.feature.point;
  found.gap = x.gap;
  found.corners = 1;
  if (const Eigen::Vector3d* t = feature.direction())
    found.y += (x.view.point - x.feature.point).dot(*t) * *t;  // straight above the body's point
  return found;
}

/// Where a walk over features ended.
enum class WalkEnd {
  nearest,  ///< where the cores are nearest, tested against the whole shape
  meeting,  ///< at a point of the volume's core that is in the shape's, to rounding
  unknown   ///< not in a few steps, or of a kind of shape that it does not know
};

/// Walks the volume's patches and the shape's features to where the cores are nearest. `found` says nothing
/// unless it got there.
WalkEnd walkShapeFeatures(ShapeQuery& q, const StartNormal& start, int tries, Nearest& found);

/// Between which lengths something is (m).
struct Span {
  double least, most;
};

/// Lower and upper bounds on the signed distance of the volume's centre from the shape's core, up to
/// rounding. For a polytope all corners are visited, which improves the upper bound, if the distance may be
/// less than `enough` (m).
Span awayFromCentre(const ShapeQuery& q, double enough);

/// Any feature that has a gradient, from a start.
template <typename Feature>
Nearest nearestOn(ShapeQuery& q, const Feature& feature, const StartNormal& start) {
  AscentPoint x = ascentPoint(q.body, feature, start.n, start.patch, q.steps);
  const bool apart = ascendFeature(q.body, feature, x, q.rounding, q.pairs, q.steps);
  Nearest found = nearestFrom(x, feature);
  found.apart = apart;
  return found;
}

/// The nearest point of a segment, of a triangle and of a vertex set's hull to the body's core.
///
/// Over the points of a convex set the distance to the core is a convex function, C1 outside the core, with
/// the normal as its gradient: so a minimum over the whole line that falls outside the segment makes an end
/// the nearest point, and one over the plane outside the triangle makes it an edge.
Nearest nearestOnSegment(ShapeQuery& q, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const StartNormal& start);
Nearest nearestOnTriangle(ShapeQuery& q, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c, const StartNormal& start);

/// Box, triangle, polytope: grows a set of up to three corners by the one that faces the body most, until
/// none faces it more than the nearest point of the set does (Wolfe 1976; GJK with a smooth body).
Nearest nearestOnPolytope(ShapeQuery& q, const StartNormal& start);

/// Cylinder and cone: ends, rims, sides and apex in turn.
Nearest nearestOnCylinder(ShapeQuery& q, const StartNormal& start);
Nearest nearestOnCone(ShapeQuery& q, const StartNormal& start);

/// A cone's generator whose own normal has the widest gap, whether one is there or not.
Nearest nearestOnGenerator(ShapeQuery& q, const StartNormal& start);

/// An ellipsoid in the body's frame; one without thickness to rounding is a segment, or a disc that has a
/// face.
struct PosedEllipsoid {
  EllipsoidFeature whole;
  int shortest = 0, longest = 0;  ///< of its axes
  bool isSegment, isDisc;

  explicit PosedEllipsoid(const ShapeQuery& q);
};
Nearest nearestOnEllipsoid(ShapeQuery& q, const StartNormal& start);

/// How far `y`, on a supporting plane of the ellipsoid, is from it to first order (m).
double besideEllipsoid(const ShapeQuery& q, const Eigen::Vector3d& y);

/// On the flat side of a thin ellipsoid, a change of the normal by one ulp moves its point a long way. So
/// this uses the point opposite the body's point instead, if it is on the ellipsoid.
void placeOppositeOnEllipsoid(ShapeQuery& q, Nearest& found);

/// The depth of overlapping cores, if a single point of the shape proves it. That is a point whose own
/// shortest way out leads through some face of the volume, while no other point of the shape needs a longer
/// way along that direction. No value if the shape has no such point.
std::optional<LeastOverlap> overlapOfPoint(ShapeQuery& q, const StartNormal& start);

/// Up to three corners of a polytope: of a face, of an edge, or one alone.
struct ShapeCorners {
  std::array<Eigen::Vector3d, 3> p;
  int count = 0;

  /// All of them as a triangle's, some twice.
  std::array<Eigen::Vector3d, 3> three() const {
    return {p[0], p[count > 1 ? 1 : 0], p[static_cast<std::size_t>(std::max(count, 1) - 1)]};
  }
};

/// A maximum of the gap that one feature of the shape holds.
struct DeepFeature {
  Nearest at;
  std::optional<LocalMaximum> around;  ///< nothing where rounding has the points beside each other
};

/// Next to the answer of overlapping cores: its normal and points to rounding, from the shape's feature
/// there, which for a polytope is one of `met`. Nothing where none holds a gap of `leastOverlap` or wider.
std::optional<DeepFeature> deepestFeature(ShapeQuery& q, const StartNormal& start, double leastOverlap,
                                          const ShapeCorners& met);

/// The answer of overlapping cores of the volume and a segment, a triangle or a box, in closed form. Nothing
/// for other kinds, and where no point of the shape is deep enough (volume/point_depth.h).
std::optional<LeastOverlap> overlapOfCones(ShapeQuery& q);

/// How deep overlapping cores are in each other, next to `start` first. `at.gap` is minus the depth along the
/// best normal seen, `bound` holds for every normal.
LeastOverlap leastOverlap(ShapeQuery& q, const StartNormal& start);

/// For cores that touch or almost touch: starting near the answer, finds the answer on a feature of the
/// shape, with the same depth as `near` up to rounding. No value if no feature has one.
std::optional<DeepFeature> touchingFeature(ShapeQuery& q, const Nearest& near);

/// The plane of a flat end: its normal is fixed, only the position is to be
/// checked. `apart` where the core is above.
Nearest nearestOnPlane(ShapeQuery& q, const Eigen::Vector3d& onPlane, const Eigen::Vector3d& n, int hint);

/// Whether no point of the whole shape is nearer to the body along the normal than `found.y`, and the two
/// points are opposite each other. Then the gap is the distance of the cores, independent of how the search
/// found it (docs/theory.md, 5).
bool certified(ShapeQuery& q, const Nearest& found);

}  // namespace fcl_stpbv::detail
