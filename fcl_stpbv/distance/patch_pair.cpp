// The widest normal of two edges' patches, two tori (docs/theory.md, 5).
//
// 1. If the axes cross: two equations for the normal's components along the two edges, solved by Newton's
//    method from the axes' common normal. Two iterations are usual.
// 2. If the axes are nearly parallel, or the regions are wide: Newton's method on the sphere of normals.
#include "fcl_stpbv/distance/patch_pair.h"

#include <Eigen/Geometry>
#include <cmath>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

/// `1 / sqrt(1 - x)`. For small `x` its series, exact to rounding and faster than a square root and a
/// division.
double inverseRoot(double x) {
  constexpr double kSmall = 1e-3;  // the next term is 2e-19
  if (x > kSmall) return 1.0 / std::sqrt(1.0 - x);
  const double x2 = x * x;
  return (1.0 + 1.0 / 2 * x) + x2 * ((3.0 / 8 + 5.0 / 16 * x) + x2 * (35.0 / 128 + 63.0 / 256 * x));
}

/// Two circles whose axes cross. The region of an edge is a narrow band around the plane perpendicular to the
/// edge. Two crossing bands meet at the common normal `m` of the axes, and the widest normal is near `m`.
///
/// The gap is `n.d - rise` with `rise = sag + kappa (1 - c)` for each circle, so at the widest normal
/// `d - t_A u_A - t_B u_B = core n` with `t = kappa v / c`. Multiplied by `u_A` and `u_B`
/// these are two equations for the leans `v`, solved by Newton's method from v = 0 (docs/theory.md, 5). False
/// if the leans are not small. Also false if `n` is this function's own answer already: axes that cross at a
/// small angle magnify its rounding error, and Newton's method on the sphere has a smaller one. `n` is then
/// an improved start.
bool leanFromCommonNormal(const PosedPatch& a, const PosedPatch& b, const Packed& d, Packed& n) {
  constexpr double kCrossing2 = 0.01;   // squared sine between the axes
  constexpr int kPasses = 5;            // two are usual
  constexpr double kConverged = 2e-16;  // predicted next change of a lean: the rounding of a unit vector
  // Rad. A smaller turn means that `n` is already this function's own answer, and not accurate enough.
  constexpr double kAgain = 1e-8;
  const Packed &p = a.axis, &q = b.axis;
  Packed m = cross(p, q);
  const double sine2 = dot(m, m), cosine = dot(m, n);
  if (!(sine2 > kCrossing2 && cosine * cosine > 0.25 * sine2)) return false;
  m *= (cosine > 0.0 ? 1.0 : -1.0) / std::sqrt(sine2);
  const double along = dot(p, q), dm = dot(d, m), dp = dot(d, p), dq = dot(d, q), across2 = 1.0 / sine2;

  double va = 0.0, vb = 0.0, secA = 1.0, secB = 1.0, core = dm, leftA = dp, leftB = dq;
  for (int i = 0; i < kPasses; ++i) {
    const double ka = a.kappa * secA, kb = b.kappa * secB, mixed = along - va * vb, aa = core + ka,
                 bb = core + kb, ab = kb * secB * secB * mixed, ba = ka * secA * secA * mixed,
                 det = aa * bb - ab * ba;
    if (!(det > 0.0)) return false;
    const double da = (bb * leftA - ab * leftB) / det, db = (aa * leftB - ba * leftA) / det;
    va += da, vb += db;
    const double fa = (va - along * vb) * across2, fb = (vb - along * va) * across2,
                 lean2 = va * fa + vb * fb, change2 = da * da + db * db;
    if (!(lean2 < 0.25)) return false;
    const double upright = (1.0 - lean2) * inverseRoot(lean2);
    if (4.0 * lean2 * change2 * change2 <= kConverged * kConverged) {
      const Packed widest = upright * m + fa * p + fb * q, turn = widest - n;
      n = widest;
      return dot(turn, turn) > kAgain * kAgain;
    }
    secA = inverseRoot(va * va), secB = inverseRoot(vb * vb);
    const double ta = a.kappa * va * secA, tb = b.kappa * vb * secB;
    core = upright * dm + fa * dp + fb * dq - ta * va - tb * vb;
    leftA = dp - ta - along * tb - core * va;
    leftB = dq - tb - along * ta - core * vb;
  }
  return false;
}

}  // namespace

/// Two circles (torus against torus): Newton on the sphere. In the tangent basis e1 = v_A, e2 = n x v_A the
/// matrix is W_A + W_B + core (docs/theory.md, 6), with every entry a sum without cancellation.
///
/// A Newton step that does not raise the gap is replaced by `n = g / |g|`, which cannot lower it: it is the
/// best normal for the two circle points at hand, and those are the best points for the old normal.
FCL_STPBV_VECTORIZED
void turnToWidestOfEdges(const PosedPatch& a, const PosedPatch& b, Packed& n) {
  constexpr int kIterations = 30;       // two or three are usual; far starts near parallel axes take ten
  constexpr double kConverged = 2e-16;  // predicted next step, in rad: the rounding of a unit vector
  constexpr double kSmall = 1e-15;      // square of a last step
  const double rhoA = a.radii->rho, rhoB = b.radii->rho;
  const Packed middles = b.anchor - a.anchor;

  if (leanFromCommonNormal(a, b, middles, n)) return;

  Packed best = n, bestPull = n;
  double bestGap = -kInfinity;
  constexpr double kUnknown = 1e-9;  // no step to predict from: a first step of 1e-8 rad ends the iteration
  double lastStep2 = kUnknown;
  for (int i = 0; i < kIterations; ++i) {
    const EdgeView va = viewEdge(a, n), vb = viewEdge(b, -n);
    const double core = dot(n, middles) - va.rise - vb.rise;
    if (core < bestGap && lastStep2 > 1e-14) {  // the gaps of shorter steps differ only by rounding
      n = unnormalizedOr(bestPull, best).unit();
      bestGap = -kInfinity;
      lastStep2 = kUnknown;
      continue;
    }
    const Packed y = middles + vb.offset - va.offset;
    bestPull = y + (rhoA + rhoB) * n;
    best = n;
    bestGap = core;

    const Packed e1 = cross(a.axis, n) / va.c;
    const Packed e2 = cross(n, e1);
    const Packed f1 = cross(b.axis, n) / vb.c;
    const double cos = dot(f1, e1), sin = dot(f1, e2);
    const double m11 = va.around + vb.around * cos * cos + rhoB * sin * sin + core;
    const double m22 = rhoA + vb.around * sin * sin + rhoB * cos * cos + core;
    const double m12 = (vb.around - rhoB) * cos * sin;
    const double g1 = dot(y, e1), g2 = dot(y, e2);
    const double det = m11 * m22 - m12 * m12;
    if (!(det > 0.0 && m22 > 0.0)) {
      const Packed next = unnormalizedOr(bestPull, n).unit(), step = next - n;
      const bool still = dot(step, step) < 1e-30;
      n = next;
      if (still) break;
      lastStep2 = kUnknown;
      continue;
    }
    const double x1 = (m22 * g1 - m12 * g2) / det, x2 = (m11 * g2 - m12 * g1) / det;
    n += x1 * e1 + x2 * e2;
    n /= std::sqrt(dot(n, n));
    // Quadratic convergence: after steps p and q the next one is about q^3 / p^2, or q^2 if p was short by
    // chance.
    const double step2 = x1 * x1 + x2 * x2;
    if (step2 < kSmall && step2 * step2 * step2 <= kConverged * kConverged * lastStep2 * lastStep2) return;
    lastStep2 = step2;
  }
}

Eigen::Matrix3d coreCurvature(const PosedPatch& p, const Vector3d& n) {
  if (p.kind == PatchKind::vertex) return Eigen::Matrix3d::Zero();
  const Eigen::Matrix3d tangent = Eigen::Matrix3d::Identity() - n * n.transpose();
  if (p.kind == PatchKind::face) return p.radii->rho * tangent;
  const EdgeView e = viewEdge(p, pack(n));
  const Vector3d v = unpack(p.axis).cross(n) / e.c, w = n.cross(v);
  return e.around * v * v.transpose() + p.radii->rho * w * w.transpose();
}

}  // namespace fcl_stpbv::detail
