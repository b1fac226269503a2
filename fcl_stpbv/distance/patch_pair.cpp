#include "fcl_stpbv/distance/patch_pair.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// Radius of curvature of an edge's core around its axis where the normal leans by `v` along it, and the
/// pair's other ingredients there. `rho - kappa / |P n|` is a centimetre against tens of metres, hence the
/// form with the sag.
struct Lean {
  double v;       // n.u
  double c;       // |P n|
  double around;  // rho - kappa / c
};

Lean lean(const PosedPatch& edge, const Vector3d& n) {
  const double v = n.dot(edge.patch.axis);
  const double c = std::sqrt(std::max(1.0 - v * v, 1e-30));
  return {v, c, (edge.patch.sag - edge.radii.rho * v * v / (1.0 + c)) / c};
}

Vector3d normalizedOr(const Vector3d& d, const Vector3d& otherwise) {
  const double length2 = d.squaredNorm();
  return length2 > std::numeric_limits<double>::min() ? Vector3d(d / std::sqrt(length2)) : otherwise;
}

/// Two points (sphere against sphere): along the line of centres. The margin of a vertex and the bulge of a
/// face both sit in the centres, a face's being `rho` behind its anchor.
Vector3d pointPoint(const PosedPatch& a, const PosedPatch& b, const Vector3d& n) {
  return normalizedOr(centre(b.patch, b.kind, b.radii) - centre(a.patch, a.kind, a.radii), n);
}

/// A circle and a point (torus against sphere). `d` runs from the first centre to the second; which of the
/// two the circle belongs to does not matter, since it only enters through `kappa |P n|`.
Vector3d circlePoint(const Patch& circle, const Vector3d& d, const Vector3d& n) {
  const double along = d.dot(circle.axis);
  const Vector3d across = d - along * circle.axis;
  const Vector3d fallback = normalizedOr(n - n.dot(circle.axis) * circle.axis, n);
  Vector3d e = normalizedOr(across, fallback);
  // A point near the axis' line leaves rounding along it in `across`, which the large `kappa` would magnify.
  e = normalizedOr(e - e.dot(circle.axis) * circle.axis, fallback);
  return (along * circle.axis + (across.norm() + circle.kappa) * e).normalized();
}

/// Two circles (torus against torus): Newton on the sphere. In the tangent basis e1 = v_A, e2 = n x v_A the
/// matrix is W_A + W_B + core (docs/theory.md, 6), every entry a sum without cancellation.
///
/// A Newton step that does not raise the gap is replaced by `n = g / |g|`, which cannot lower it: it is the
/// best normal for the two circle points at hand, and those are the best points for the old normal.
Vector3d circleCircle(const PosedPatch& a, const PosedPatch& b, Vector3d n) {
  constexpr int kIterations = 30;       // three are usual; far starts near parallel axes take ten
  constexpr double kConverged = 1e-15;  // predicted next step, in rad: below the rounding of a unit vector
  const double rhoSum = a.radii.rho + b.radii.rho;

  Vector3d best = n, bestPull = n;
  double bestGap = -std::numeric_limits<double>::infinity();
  double lastStep2 = 1.0;
  for (int i = 0; i < kIterations; ++i) {
    const double core = coreGap(a, b, n);
    if (core < bestGap && lastStep2 > 1e-14) {  // shorter steps differ by rounding only
      n = normalizedOr(bestPull, best);
      bestGap = -std::numeric_limits<double>::infinity();
      lastStep2 = 1.0;
      continue;
    }
    const Vector3d y = coreDifference(a, b, n);
    bestPull = y + rhoSum * n;
    best = n;
    bestGap = core;

    const Lean la = lean(a, n), lb = lean(b, n);
    const Vector3d e1 = a.patch.axis.cross(n) / la.c;
    const Vector3d e2 = n.cross(e1);
    const Vector3d vb = b.patch.axis.cross(n) / lb.c;
    const double cos = vb.dot(e1), sin = vb.dot(e2);
    const double rhoA = a.radii.rho, rhoB = b.radii.rho;
    const double m11 = la.around + lb.around * cos * cos + rhoB * sin * sin + core;
    const double m22 = rhoA + lb.around * sin * sin + rhoB * cos * cos + core;
    const double m12 = (lb.around - rhoB) * cos * sin;
    const double g1 = y.dot(e1), g2 = y.dot(e2);
    const double det = m11 * m22 - m12 * m12;
    if (!(det > 0.0 && m22 > 0.0)) {
      const Vector3d next = normalizedOr(bestPull, n);
      lastStep2 = std::min(1.0, (next - n).squaredNorm());
      n = next;
      if (lastStep2 < 1e-30) break;
      continue;
    }
    const double x1 = (m22 * g1 - m12 * g2) / det, x2 = (m11 * g2 - m12 * g1) / det;
    n = (n + x1 * e1 + x2 * e2).normalized();
    // Quadratic convergence: after steps p, q the next is about q^3 / p^2.
    const double step2 = x1 * x1 + x2 * x2;
    if (step2 * step2 * step2 <= kConverged * kConverged * lastStep2 * lastStep2) return n;
    lastStep2 = std::min(1.0, step2);
  }
  return n;
}

}  // namespace

double coreGap(const PosedPatch& a, const PosedPatch& b, const Vector3d& n) {
  return n.dot(b.patch.anchor - a.patch.anchor) -
         (supportAboveAnchor(a.patch, a.kind, a.radii, n) - a.radii.r) -
         (supportAboveAnchor(b.patch, b.kind, b.radii, -n) - b.radii.r);
}

Vector3d coreDifference(const PosedPatch& a, const PosedPatch& b, const Vector3d& n) {
  return corePoint(b.patch, b.kind, b.radii, -n) - corePoint(a.patch, a.kind, a.radii, n);
}

Vector3d widestNormal(const PosedPatch& a, const PosedPatch& b, const Vector3d& n) {
  const bool circleA = a.kind == PatchKind::edge, circleB = b.kind == PatchKind::edge;
  if (circleA && circleB) return circleCircle(a, b, n);
  if (!circleA && !circleB) return pointPoint(a, b, n);
  const Vector3d d = centre(b.patch, b.kind, b.radii) - centre(a.patch, a.kind, a.radii);
  return circlePoint(circleA ? a.patch : b.patch, d, n);
}

}  // namespace fcl_stpbv
