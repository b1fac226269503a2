#include "fcl_stpbv/distance/patch_pair.h"
#include "fcl_stpbv/vectorized.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// An edge's core seen along a normal that leans by `v` along the edge.
struct EdgeView {
  double v;         // n.u
  double c;         // sqrt(1 - v^2)
  Vector3d side;    // n - v u, of length c
  double around;    // radius of curvature around the edge, rho - kappa / c
  double rise;      // height of the supporting plane above the edge's middle
  Vector3d offset;  // core point, from the edge's middle
};

/// The lengths of docs/theory.md, 2 without their cancellation: `rho c - kappa` is a centimetre against tens
/// of metres, so it is written with the half length h, h^2 = rho^2 - kappa^2 = sag (rho + kappa). Near the
/// smallest R kappa is small, and that form would divide by little.
EdgeView viewEdge(const PosedPatch& edge, const Vector3d& n) {
  const double rho = edge.radii->rho, kappa = edge.patch.kappa, sag = edge.patch.sag;
  EdgeView e;
  e.v = n.dot(edge.patch.axis);
  e.c = std::sqrt(std::max(1.0 - e.v * e.v, 1e-30));
  e.side = n - e.v * edge.patch.axis;
  const double along = rho * e.v;
  const double across =
      kappa > 0.5 * rho ? (sag * (rho + kappa) - along * along) / (rho * e.c + kappa) : rho * e.c - kappa;
  e.around = across / e.c;
  e.rise = sag + kappa * e.v * e.v / (1.0 + e.c);
  e.offset = along * edge.patch.axis + e.around * e.side;
  return e;
}

/// Height of the core's supporting plane above the patch's anchor, and its point from there.
struct CoreView {
  double rise = 0.0;
  Vector3d offset{0, 0, 0};
};

CoreView viewCore(const PosedPatch& p, const Vector3d& n) {
  if (p.kind == PatchKind::edge) {
    const EdgeView e = viewEdge(p, n);
    return {e.rise, e.offset};
  }
  if (p.kind == PatchKind::face) {
    const Vector3d d = n - p.patch.axis;
    return {0.5 * p.radii->rho * d.squaredNorm(), p.radii->rho * d};
  }
  return {};
}

/// A circle and a point (torus against sphere). `d` runs from the first centre to the second; which of the
/// two the circle belongs to does not matter, since it only enters through `kappa |P n|`.
Vector3d circlePoint(const Patch& circle, const Vector3d& d, const Vector3d& n) {
  const double along = d.dot(circle.axis);
  // A point near the axis' line leaves rounding along it in `across`, which the large `kappa` would magnify:
  // hence the second projection.
  Vector3d across = d - along * circle.axis;
  across -= across.dot(circle.axis) * circle.axis;
  const double distance2 = across.squaredNorm();
  if (!(distance2 >
        1e-30 * d.squaredNorm())) {  // on the axis: any direction across is as good, so the last one
    const Vector3d e = normalizedOr(n - n.dot(circle.axis) * circle.axis, n);
    return normalizedOr(along * circle.axis + circle.kappa * e, n);
  }
  const double stretch = 1.0 + circle.kappa / std::sqrt(distance2);
  return (along * circle.axis + stretch * across).normalized();
}

/// Whether `n` lies between the two cones that end an edge's region (docs/theory.md, 3).
bool withinBand(const PosedPatch& edge, const Vector3d& n) {
  const double rho = edge.radii->rho, v = n.dot(edge.patch.axis);
  return rho * rho * v * v <= edge.patch.sag * (rho + edge.patch.kappa);
}

/// Two circles (torus against torus): Newton on the sphere. In the tangent basis e1 = v_A, e2 = n x v_A the
/// matrix is W_A + W_B + core (docs/theory.md, 6), every entry a sum without cancellation.
///
/// A Newton step that does not raise the gap is replaced by `n = g / |g|`, which cannot lower it: it is the
/// best normal for the two circle points at hand, and those are the best points for the old normal.
Vector3d circleCircle(const PosedPatch& a, const PosedPatch& b, Vector3d n) {
  constexpr int kIterations = 30;       // two or three are usual; far starts near parallel axes take ten
  constexpr double kConverged = 2e-16;  // predicted next step, in rad: the rounding of a unit vector
  constexpr double kSmall = 1e-15;      // square of a last step
  constexpr double kCrossing = 0.1;  // sine between the axes from which their common normal is a good start
  const double rhoA = a.radii->rho, rhoB = b.radii->rho;
  const Vector3d middles = b.patch.anchor - a.patch.anchor;

  // Regions of edges are narrow bands around the planes across them; crossing bands meet at the axes' common
  // normal, a better start than one from outside either band.
  if (!withinBand(a, n) || !withinBand(b, n)) {
    const Vector3d common = a.patch.axis.cross(b.patch.axis);
    const double sine2 = common.squaredNorm(), cosine = common.dot(n);
    if (sine2 > kCrossing * kCrossing && cosine * cosine > 0.25 * sine2)
      n = common / (cosine > 0.0 ? std::sqrt(sine2) : -std::sqrt(sine2));
  }

  Vector3d best = n, bestPull = n;
  double bestGap = -std::numeric_limits<double>::infinity();
  constexpr double kUnknown = 1e-9;  // nothing to predict from: a first step of 1e-8 rad would do
  double lastStep2 = kUnknown;
  for (int i = 0; i < kIterations; ++i) {
    const EdgeView va = viewEdge(a, n), vb = viewEdge(b, -n);
    const double core = n.dot(middles) - va.rise - vb.rise;
    if (core < bestGap && lastStep2 > 1e-14) {  // shorter steps differ by rounding only
      n = normalizedOr(bestPull, best);
      bestGap = -std::numeric_limits<double>::infinity();
      lastStep2 = kUnknown;
      continue;
    }
    const Vector3d y = middles + vb.offset - va.offset;
    bestPull = y + (rhoA + rhoB) * n;
    best = n;
    bestGap = core;

    const Vector3d e1 = a.patch.axis.cross(n) / va.c;
    const Vector3d e2 = n.cross(e1);
    const Vector3d f1 = b.patch.axis.cross(n) / vb.c;
    const double cos = f1.dot(e1), sin = f1.dot(e2);
    const double m11 = va.around + vb.around * cos * cos + rhoB * sin * sin + core;
    const double m22 = rhoA + vb.around * sin * sin + rhoB * cos * cos + core;
    const double m12 = (vb.around - rhoB) * cos * sin;
    const double g1 = y.dot(e1), g2 = y.dot(e2);
    const double det = m11 * m22 - m12 * m12;
    if (!(det > 0.0 && m22 > 0.0)) {
      const Vector3d next = normalizedOr(bestPull, n);
      const bool still = (next - n).squaredNorm() < 1e-30;
      n = next;
      if (still) break;
      lastStep2 = kUnknown;
      continue;
    }
    const double x1 = (m22 * g1 - m12 * g2) / det, x2 = (m11 * g2 - m12 * g1) / det;
    n = (n + x1 * e1 + x2 * e2).normalized();
    // Quadratic convergence: after steps p, q the next is about q^3 / p^2, or q^2 should p have been a lucky
    // one.
    const double step2 = x1 * x1 + x2 * x2;
    if (step2 < kSmall && step2 * step2 * step2 <= kConverged * kConverged * lastStep2 * lastStep2) return n;
    lastStep2 = step2;
  }
  return n;
}

}  // namespace

FCL_STPBV_VECTORIZED
CoreGap coreGap(const PosedPatch& a, const PosedPatch& b, const Vector3d& n) {
  const CoreView viewA = viewCore(a, n), viewB = viewCore(b, -n);
  const Vector3d anchors = b.patch.anchor - a.patch.anchor;
  return {n.dot(anchors) - viewA.rise - viewB.rise, a.patch.anchor + viewA.offset,
          anchors + viewB.offset - viewA.offset};
}

FCL_STPBV_VECTORIZED
Vector3d widestNormalOfEdge(const PosedPatch& a, const PosedPatch& b, const Vector3d& n) {
  const bool circleA = a.kind == PatchKind::edge, circleB = b.kind == PatchKind::edge;
  if (circleA && circleB) return circleCircle(a, b, n);
  const Vector3d d = centre(b.patch, b.kind, *b.radii) - centre(a.patch, a.kind, *a.radii);
  return circlePoint(circleA ? a.patch : b.patch, d, n);
}

Eigen::Matrix3d coreCurvature(const PosedPatch& p, const Vector3d& n) {
  if (p.kind == PatchKind::vertex) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d tangent = Eigen::Matrix3d::Identity() - n * n.transpose();
  if (p.kind == PatchKind::face) return p.radii->rho * tangent;
  const EdgeView e = viewEdge(p, n);
  const Vector3d v = p.patch.axis.cross(n) / e.c, w = n.cross(v);
  return e.around * v * v.transpose() + p.radii->rho * w * w.transpose();
}

}  // namespace fcl_stpbv
