// Improves an approximate distance of two shapes to full accuracy, by Newton's method. GJK approximates
// curved surfaces by chords. So when its bounds agree up to rounding, its normal is only accurate to the
// square root of that.
//
// 1. Try the features on which the search ended, if the caller knows them. Then those within the possible
//    error of the normal, the flattest ones first; then those at the normal itself. Features whose normal is
//    further away than that error are given up.
// 2. Flat faces and edges fix the normal, or let it turn one way. Two edges fix it between them. Else
//    Newton's step with both radii of curvature (turning.h).
// 3. The witness point is taken on the more strongly curved feature. The other point is opposite it.
// 4. Both points are projected onto their bodies. They are accepted if they are still opposite each other and
//    their distance equals that of the supporting planes.
// For a polytope only the few vertices that can be support points for normals near `n` are used, and all of
// them for the final test.
#include <algorithm>
#include <array>

#include "fcl_stpbv/convex/onto_core.h"
#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/convex/vertex_cap.h"
#include "fcl_stpbv/convex/vertex_set.h"
#include "fcl_stpbv/distance/shape_pair.h"
#include "fcl_stpbv/distance/turning.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

/// A copy of a shape for normals within `angle` (rad) of `n`. A polytope keeps only the vertices that can be
/// support points for such normals, within a tolerance of twice that angle and `rounding` (m). It keeps all
/// vertices if these are too many.
class ShapeNear {
 public:
  ShapeNear(const Shape& shape, const Vector3d& n, double angle, double rounding) : whole_(shape) {
    if (shape.kind != ShapeKind::polytope || shape.vertexCount <= kFew) return;
    const double below = 2.0 * rounding + 8.0 * shape.reach * angle;
    std::array<int, kFew> which;
    const double top = n.dot(shape.support(n));
    const VertexList all = shape.cap
                               ? shape.cap->candidates(n, 4.0 * angle, shape.vertices, shape.vertexCount)
                               : VertexList{shape.vertices, shape.vertexCount};
    const int count = fromHeight(top - below, n, all.first, all.count, which.data(), kFew);
    if (count > kFew) return;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) vertex_[i] = all.first[which[i]];
    few_ = shape;
    few_->vertices = vertex_.data();
    few_->vertexCount = count;
    few_->cap = nullptr;
  }
  ShapeNear(const ShapeNear&) = delete;

  const Shape& shape() const { return few_ ? *few_ : whole_; }
  bool isWhole() const { return !few_; }

 private:
  static constexpr int kFew = 32;
  const Shape& whole_;
  std::optional<Shape> few_;
  std::array<Vector3d, kFew> vertex_;
};

/// The two shapes along one normal.
struct Facing {
  const Shape &a, &b;
  const RelativePose& pose;
  double levelA, levelB;  ///< heights on either shape that differ by less count as equal (m)
  Vector3d n;
  NormalCone coneA, coneB;  // both in the first frame; B's normal runs from A to B
  Vector3d pointA, pointB;  // support points
  double gap = 0;

  bool look(const Vector3d& onA, const Vector3d& onB) {
    const Vector3d m = pose.opposite(n);
    if (!normalCone(a, n, onA, levelA, coneA) || !normalCone(b, m, pose.inSecond(onB), levelB, coneB))
      return false;
    coneB.normal = pose.rotation * Vector3d(-coneB.normal);
    for (int i = 0; i < coneB.count; ++i) {
      Vector3d& way = coneB.way[at(i)];
      way = pose.rotation * way;
    }
    return true;
  }
  void support() {
    pointA = a.support(n);
    pointB = pose.placed(b.support(pose.opposite(n)));
    gap = n.dot(pointB - pointA);
  }
  /// Whether the point may be on a cone's generator, as of the last look().
  bool isOnGenerator() const {
    return (a.kind == ShapeKind::cone || b.kind == ShapeKind::cone) && coneA.count < 2 && coneB.count < 2;
  }
  bool aIsFlatter() const { return coneA.count < coneB.count; }
  static Vector3d line(const NormalCone& cone) { return cone.normal.cross(cone.way[0]); }
  bool cross() const {
    constexpr double kParallel = 1e-9;
    return coneA.count == 1 && coneB.count == 1 && line(coneA).cross(line(coneB)).norm() > kParallel;
  }

  /// For two parallel lines: turns the normal around them, to the direction between the centres of their
  /// circles of curvature. If neither is curved, the normal stays.
  void turnAroundLines() {
    const double bentA = coneA.along[0] - a.margin, bentB = coneB.along[0] - b.margin;
    if (!(bentA + bentB > 0.0)) return;
    const Vector3d t = line(coneB), middles = pointB - pointA + (bentA + bentB) * n,
                   across = middles - middles.dot(t) * t;
    constexpr double kKnown = 0.1;  // of the radii: nearer centres do not determine the normal well
    if (!(across.dot(n) > kKnown * (bentA + bentB))) return;
    n = across.normalized();
    n = (n - n.dot(t) * t).normalized();  // again, as rounding of a long `middles` leans along the lines
  }

  /// One step of the normal.
  void turn() {
    const NormalCone &flat = aIsFlatter() ? coneA : coneB, &curved = aIsFlatter() ? coneB : coneA;
    n = flat.normal;
    support();
    if (flat.count == 0) return;
    if (curved.count == 1) {
      if (!cross()) {
        turnAroundLines();
        return;
      }
      const Vector3d across = line(curved);
      n = (n + across.dot(curved.normal - n) / across.dot(flat.way[0]) * flat.way[0]).normalized();
      return;
    }
    Turning meeting;  // the radii of curvature are those of the surfaces, around the margins
    if (!meeting.set(coneA, coneB, gap - a.margin - b.margin, 0.0))
      return;  // for example on a common axis: all normals are equally good, and the points decide
    n = (n + meeting.frame * (meeting.turning * (meeting.frame.transpose() * (pointB - pointA))))
            .normalized();
  }

  /// The witness point on the first core.
  Vector3d point(const Vector3d& onA) const {
    const auto sumOfRadii = [](const NormalCone& cone) {
      return cone.count == 2 ? cone.along[0] + cone.along[1] : 1e300;
    };
    if (coneA.count == 2 && !(sumOfRadii(coneB) < sumOfRadii(coneA))) return pointA;
    if (coneB.count == 2) return pointB - gap * n;
    const Vector3d u = line(coneA), v = line(coneB), normal = u.cross(v);
    if (!cross()) {  // `onA` may be off the line through the support point; only that is opposite
      if (coneA.count == 1) return pointA + (onA - pointA).dot(u) * u;
      if (coneB.count == 1) return pointB + (onA - pointB).dot(v) * v - gap * n;
      return onA + (pointA - onA).dot(n) * n;
    }
    return pointA + (pointB - pointA).cross(v).dot(normal) / normal.squaredNorm() * u;
  }
};

/// Newton's method from `facing` and its normal. No value if the normal turns by more than `widest` (rad).
std::optional<OppositePoints> onFeaturesOf(Facing facing, Vector3d onA, double widest, double rounding) {
  constexpr int kSteps = 8;
  // After a step of this size (rad) the next one is rounding. On a generator the point is off by the last
  // step.
  constexpr double kLast = 1e-9, kLastOnGenerator = 1e-14, kAtRest = 1e-7;
  const Vector3d start = facing.n;
  double step = 0.0;
  facing.support();
  for (int i = 0; i < kSteps; ++i) {
    const Vector3d before = facing.n;
    if (!facing.look(onA, onA + facing.gap * before)) return {};
    facing.turn();
    if (!((facing.n - start).norm() <= widest)) return {};
    facing.support();
    onA = facing.point(onA);
    step = (facing.n - before).norm();
    if (step <= (facing.isOnGenerator() ? kLastOnGenerator : kLast)) break;
  }
  if (!(step <= kAtRest)) return {};  // alternates between features
  const RelativePose& pose = facing.pose;
  const Vector3d across = facing.gap * facing.n;
  OppositePoints found{facing.n, facing.gap, {}, {}};
  found.onA = ontoCore(facing.a, onA);
  found.toB = pose.placed(ontoCore(facing.b, pose.inSecond(found.onA + across))) - found.onA;
  if (!((found.toB - across).norm() <= 2.0 * rounding)) return {};
  return found;
}

}  // namespace

std::optional<OppositePoints> nearestOnFeatures(const Shape& a, const Shape& b, const RelativePose& pose,
                                                const NearNormal& known, double rounding) {
  constexpr double kFiner = 1e-3;
  constexpr double kOvershoot = 2.0;  // of a step of Newton's method, in errors of the known normal
  const Vector3d& n = known.n;
  const ShapeNear nearA(a, n, known.angle, rounding), nearB(b, pose.opposite(n), known.angle, rounding);
  const bool isWhole = nearA.isWhole() && nearB.isWhole();
  // The answer on the features between the support points along `n` and these heights (m).
  const auto onFeatures = [&](double levelA, double levelB) {
    std::optional<OppositePoints> found =
        onFeaturesOf({nearA.shape(), nearB.shape(), pose, levelA, levelB, n, {}, {}, {}, {}, 0.0}, known.onA,
                     kOvershoot * known.angle, rounding);
    if (found && !isWhole) {
      const double gapOfAll = ConvexDifference(a, b, pose).support(found->n).gap;
      if (gapOfAll >= found->gap - rounding)
        found->gap = std::min(found->gap, gapOfAll);
      else
        found.reset();
    }
    if (found && !(found->gap >= known.gap - rounding)) found.reset();
    return found;
  };
  if (known.featureA >= 0.0)
    if (auto found = onFeatures(known.featureA + rounding, known.featureB + rounding)) return found;
  const double most = 2.0 * std::max(a.reach, b.reach);
  for (double within = known.angle;; within *= kFiner) {
    if (!(most * within > rounding)) within = 0.0;
    // These heights include all features that can face each other after a turn by `within`.
    auto found = onFeatures(2.0 * a.reach * within + rounding, 2.0 * b.reach * within + rounding);
    if (found || !(within > 0.0)) return found;
  }
}

}  // namespace fcl_stpbv::detail
