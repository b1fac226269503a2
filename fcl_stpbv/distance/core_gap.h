// Two patches in one frame, and the gap between their cores along a normal.
#pragma once

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/packed.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// A patch with all that its formula needs, in the frame of its anchor and axis.
struct PosedPatch {
  Packed anchor, axis;
  double kappa, sine;
  PatchKind kind;
  const Radii* radii;  ///< the body's

  /// Centre of the patch's point or circle (m); a vertex has no axis.
  Packed centre() const { return kind == PatchKind::face ? Packed(anchor - radii->rho * axis) : anchor; }
};

/// A patch in its body's own frame.
inline PosedPatch posedPatch(const StpBv& body, int patch) {
  const PatchTable& patches = body.patches();
  const PatchKind kind = patches.kind(patch);
  if (kind == PatchKind::vertex)
    return {pack(patches.vertex(patch).point), Packed{}, 0, 0, kind, &body.radii()};
  if (kind == PatchKind::edge) {
    const EdgeRecord& e = patches.edge(patch);
    return {e.middle, e.axis, e.middle[3], e.axis[3], kind, &body.radii()};
  }
  const FaceRecord& f = patches.face(patch);
  return {pack(f.anchor), pack(f.normal), 0, 0, kind, &body.radii()};
}

/// An edge's core seen along a normal that leans by `v = n.u` along the edge.
struct EdgeView {
  double c;       // sqrt(1 - v^2)
  double around;  // radius of curvature around the edge, rho - kappa / c
  double rise;    // height of the supporting plane above the edge's middle
  Packed offset;  // core point, from the edge's middle
};

/// The lengths of docs/theory.md, 2 without their cancellation: `rho c - kappa` is a centimetre against tens
/// of metres, so it is written with the edge's sine s, rho^2 - kappa^2 = rho^2 s^2. Near the smallest R
/// kappa is small, and that form would divide by little.
inline EdgeView viewEdge(const PosedPatch& edge, const Packed& n) {
  const double rho = edge.radii->rho, kappa = edge.kappa, s = edge.sine;
  const double v = dot(n, edge.axis), c2 = std::max(1.0 - v * v, 1e-30), rho2 = rho * rho;
  EdgeView e;
  e.c = std::sqrt(c2);
  e.around = kappa > 0.5 * rho ? rho2 * ((s - v) * (s + v)) / (rho * c2 + kappa * e.c) : rho - kappa / e.c;
  e.rise = rho2 * s * s / (rho + kappa) + kappa * v * v / (1.0 + e.c);
  e.offset = rho * v * edge.axis + e.around * (n - v * edge.axis);
  return e;
}

/// Height of the core's supporting plane above the patch's anchor, and its point from there.
struct CoreView {
  double rise = 0.0;
  Packed offset{};
};

inline CoreView viewCore(const PosedPatch& p, const Packed& n) {
  if (p.kind == PatchKind::edge) {
    const EdgeView e = viewEdge(p, n);
    return {e.rise, e.offset};
  }
  if (p.kind == PatchKind::face) {
    const Packed d = n - p.axis;
    return {0.5 * p.radii->rho * dot(d, d), p.radii->rho * d};
  }
  return {};
}

/// The gap between two patches along one normal, without their margins.
struct CoreGap {
  double value;   ///< between the supporting planes, `s(n) + r_A + r_B` (m)
  Packed point;   ///< the first patch's, in the patches' frame (m)
  Packed across;  ///< gradient over the sphere of normals: the points' difference across the normal (m)
};

/// The gap along the unit normal `n` from `a` to `b`, the patches continued over the whole sphere of normals
/// (docs/theory.md, 5).
inline CoreGap coreGap(const PosedPatch& a, const PosedPatch& b, const Packed& n) {
  const CoreView viewA = viewCore(a, n), viewB = viewCore(b, -n);
  const Packed anchors = b.anchor - a.anchor, difference = anchors + viewB.offset - viewA.offset;
  return {dot(n, anchors) - viewA.rise - viewB.rise, a.anchor + viewA.offset,
          difference - dot(difference, n) * n};
}

}  // namespace fcl_stpbv::detail
