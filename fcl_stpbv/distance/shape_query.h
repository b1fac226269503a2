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
#include "fcl_stpbv/numbers.h"

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
};

/// The nearest points of the cores, as a search found them.
struct Nearest {
  Eigen::Vector3d n{0, 0, 0};  ///< unit, from the body to the shape
  int patch = -1;
  Eigen::Vector3d y{0, 0, 0};  ///< the shape's core point
  double gap = 0;              ///< between the body's supporting plane and `y` (m)
  bool apart = false;          ///< the gap is positive and the widest for the points searched
  int corners = 0;  ///< number of the searched points whose hull contains `y`; `corner` has their indices
  std::array<int, 3> corner{0, 1, 2};
};

/// The start of a search: a cached or guessed normal.
struct StartNormal {
  Eigen::Vector3d n;
  int patch;
};

/// The start from the pair's last answer; else the direction from the volume's centre to the shape's.
StartNormal startOf(const ShapeQuery& q, const PairCache& last);

/// Whether `x` is nearer than `than`. Near a boundary, gaps differ only by the square of the difference of
/// their normals, which may be below rounding. Then each is judged by the largest length by which one of
/// the shape's points is nearer to the body than its point `y`, along its normal; the smaller one is better.
bool isNearer(const ShapeQuery& q, const Nearest& x, const Nearest& than, const Eigen::Vector3d* points,
              int count);

/// The widest gap that a search of the two whole cores found.
struct LeastOverlap {
  Nearest at;    ///< the best normal seen; `gap` is the true gap along it
  double bound;  ///< upper bound on the gap along every normal (m)
};

/// The unit vector perpendicular to the unit vector `t` and nearest to `n`. Any perpendicular one if `n` is
/// parallel to `t` up to rounding.
inline Eigen::Vector3d acrossLine(const Eigen::Vector3d& n, const Eigen::Vector3d& t) {
  const Eigen::Vector3d side = n - n.dot(t) * t;
  const double across = side.norm();
  const Eigen::Vector3d unit = across > 1e-6 ? Eigen::Vector3d(side / across) : t.unitOrthogonal();
  return (unit - unit.dot(t) * t).normalized();
}

/// The result of an ascent.
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
  nearest,  ///< the nearest points of the cores, tested against the whole shape
  meeting,  ///< a point of the volume's core that is in the shape's core, up to rounding
  unknown   ///< not found in a few steps, or a kind of shape that the walk does not support
};

/// The feature walk over the volume's patches and the shape's features to the nearest points of the cores.
/// `found` is valid only if the result is `nearest`.
WalkEnd walkShapeFeatures(ShapeQuery& q, const StartNormal& start, int tries, Nearest& found);

/// Lower and upper bound on a length (m).
struct Span {
  double least, most;
};

/// Lower and upper bounds on the signed distance of the volume's centre from the shape's core, up to
/// rounding. For a polytope all corners are visited, which improves the upper bound, if the distance may be
/// less than `enough` (m).
Span awayFromCentre(const ShapeQuery& q, double enough);

/// The nearest point on a feature of any kind, by an ascent from a start.
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
/// The distance of a point to the core is a convex function of the point, and C1 outside the core, with the
/// normal as its gradient. So if the minimum over the whole line is outside the segment, an end of the
/// segment is nearest. If the minimum over the plane is outside the triangle, the nearest point is on an
/// edge.
Nearest nearestOnSegment(ShapeQuery& q, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const StartNormal& start);
Nearest nearestOnTriangle(ShapeQuery& q, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& c, const StartNormal& start);

/// For a box, a triangle or a polytope: adds the corner that is furthest towards the body to a set of up to
/// three corners, until no corner is further than the set's nearest point (Wolfe 1976; GJK with a smooth
/// body).
Nearest nearestOnPolytope(ShapeQuery& q, const StartNormal& start);

/// Cylinder and cone: ends, rims, sides and apex in turn.
Nearest nearestOnCylinder(ShapeQuery& q, const StartNormal& start);
Nearest nearestOnCone(ShapeQuery& q, const StartNormal& start);

/// The generator of a cone whose own normal has the widest gap, even if no gap is positive.
Nearest nearestOnGenerator(ShapeQuery& q, const StartNormal& start);

/// An ellipsoid in the body's frame. If it has no thickness, up to rounding, it is a segment or a disc.
struct PosedEllipsoid {
  EllipsoidFeature whole;
  int shortest = 0, longest = 0;  ///< indices of its axes
  bool isSegment, isDisc;

  explicit PosedEllipsoid(const ShapeQuery& q);
};
Nearest nearestOnEllipsoid(ShapeQuery& q, const StartNormal& start);

/// Distance of `y`, a point of a supporting plane of the ellipsoid, from the ellipsoid, to first order (m).
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

  /// The corners of a triangle; corners are repeated if there are fewer than three.
  std::array<Eigen::Vector3d, 3> three() const {
    return {p[0], p[count > 1 ? 1 : 0], p[at(std::max(count, 1) - 1)]};
  }
};

/// A maximum of the gap on one feature of the shape.
struct DeepFeature {
  Nearest at;
  std::optional<LocalMaximum> around;  ///< no value if rounding puts the points beside each other
};

/// For overlapping cores and a start near the answer: normal and points up to rounding, from the shape's
/// feature there. For a polytope it is a feature of the corners `met`. No value if no feature has a gap of at
/// least `leastOverlap`. `ascend`: searches longer, where Newton's method does not converge.
std::optional<DeepFeature> deepestFeature(ShapeQuery& q, const StartNormal& start, double leastOverlap,
                                          const ShapeCorners& met, bool ascend = false);

/// For overlapping cores of the volume and a segment, a triangle or a box: the answer in closed form. No
/// value for other kinds, and if no point of the shape is deep enough (volume/point_depth.h).
std::optional<LeastOverlap> overlapOfCones(ShapeQuery& q);

/// The depth of overlapping cores; the search begins near `start`. `at.gap` is minus the depth along the best
/// normal seen, and `bound` holds for every normal.
LeastOverlap leastOverlap(ShapeQuery& q, const StartNormal& start);

/// For cores that touch or almost touch: starting near the answer, finds the answer on a feature of the
/// shape, with the same depth as `near` up to rounding. No value if no feature has one.
std::optional<DeepFeature> touchingFeature(ShapeQuery& q, const Nearest& near);

/// The point of a plane opposite the core's point along the plane's normal. `apart` if the core is above the
/// plane.
Nearest nearestOnPlane(ShapeQuery& q, const Eigen::Vector3d& onPlane, const Eigen::Vector3d& n, int hint);

/// Whether no point of the whole shape is nearer to the body along the normal than `found.y`, and the two
/// points are opposite each other. Then the gap is the distance of the cores, independent of how the search
/// found it (docs/theory.md, 5).
bool certified(ShapeQuery& q, const Nearest& found);

}  // namespace fcl_stpbv::detail
