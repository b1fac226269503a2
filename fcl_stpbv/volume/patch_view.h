// A patch in the form that its formula needs, and its support point and height for a normal. All support
// points of an STP-BV are computed here.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/packed.h"
#include "fcl_stpbv/volume/query_tables.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// A patch with all data that its formula needs, in the frame of its anchor and axis.
struct PosedPatch {
  Packed anchor, axis;
  double kappa, sine;
  PatchKind kind;
  const Radii* radii;  ///< of the body

  /// Centre of the patch's point or circle (m). A vertex has no axis.
  Packed centre() const { return kind == PatchKind::face ? Packed(anchor - radii->rho * axis) : anchor; }
};

/// A patch in its body's own frame.
inline PosedPatch posedPatch(const StpBv& body, int patch) {
  const PatchTable& patches = body.tables().patches;
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

/// Half the length of an edge (m).
inline double halfLength(const Patch& edge, const Radii& radii) { return radii.rho * edge.sine; }

/// Height of the core's arc over an edge's middle, rho - kappa without its cancellation (m).
inline double sag(const Patch& edge, const Radii& radii) {
  const double half = halfLength(edge, radii);
  return half * half / (radii.rho + edge.kappa);
}

/// The core at an edge, for a normal `n` with the component `v = n.u` along the edge.
struct EdgeView {
  double c;       // sqrt(1 - v^2)
  double around;  // radius of curvature around the edge, rho - kappa / c
  double rise;    // height of the supporting plane above the edge's middle
  Packed offset;  // the core's point, relative to the edge's middle
};

/// The lengths of docs/theory.md, 2, without cancellation. `rho c - kappa` is a difference of tens of metres
/// that is about a centimetre, so it is rewritten with the edge's sine s: rho^2 - kappa^2 = rho^2 s^2. Near
/// the smallest R kappa is small, and the rewritten form would divide by a small number.
inline EdgeView viewEdge(const PosedPatch& edge, const Packed& n) {
  const double rho = edge.radii->rho, kappa = edge.kappa, s = edge.sine;
  const double v = dot(n, edge.axis), rho2 = rho * rho;
  const Packed side = n - v * edge.axis;
  double c2 = 1.0 - v * v;
  // Where n is nearly along the edge, the difference cancels.
  if (c2 < 0.25) c2 = std::max(dot(side, side), 1e-30);
  EdgeView e;
  e.c = std::sqrt(c2);
  e.around = kappa > 0.5 * rho ? rho2 * ((s - v) * (s + v)) / (rho * c2 + kappa * e.c) : rho - kappa / e.c;
  e.rise = rho2 * s * s / (rho + kappa) + kappa * v * v / (1.0 + e.c);
  e.offset = rho * v * edge.axis + e.around * side;
  return e;
}

/// Height of the core's supporting plane above the patch's anchor, and the support point relative to the
/// anchor.
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

/// Height of the supporting plane with unit normal `n` above the patch's anchor, including the margin r (m).
/// The patch's formula is used even if `n` is not in its region. Body frame, also below.
inline double supportAboveAnchor(const StpBv& body, int patch, const Eigen::Vector3d& n) {
  return body.radii().r + viewCore(posedPatch(body, patch), pack(n)).rise;
}

/// The patch's point with outward unit normal `n` on the core, the body without its margin `r` (m).
inline Eigen::Vector3d corePoint(const StpBv& body, int patch, const Eigen::Vector3d& n) {
  const PosedPatch posed = posedPatch(body, patch);
  return unpack(posed.anchor + viewCore(posed, pack(n)).offset);
}

}  // namespace fcl_stpbv::detail
