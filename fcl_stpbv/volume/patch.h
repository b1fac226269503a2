// One formula for the three patches of an STP-BV's surface: small sphere, torus part, big sphere.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace fcl_stpbv {

enum class PatchKind { vertex, edge, face };

/// A piece of the surface, written as the offset of a point or of a circle (paper III; docs/theory.md, 2).
///
/// Every patch is the set `I - kappa w + c n` over its unit normals `n`, `w` the unit part of `n` across `u`.
/// `R` is 10 m and more while answers are micrometres, so only the lengths near the body are stored: an
/// anchor point among the vertices and, for a face, the unit normal there. Lengths in m, body frame.
struct Patch {
  Eigen::Vector3d anchor;  ///< vertex: p; edge: its middle I; face: one of its vertices
  Eigen::Vector3d
      axis;      ///< vertex: 0; edge: unit u from its first to its second vertex; face: (anchor - C)/rho
  double kappa;  ///< radius of the circle of centres, sqrt(rho^2 - l^2/4) for an edge, else 0
  double sine;   ///< edge: l/2 over rho, how far normals lean along it at most, else 0
};

/// The radii all patches of one body share.
struct Radii {
  double r;    ///< small radius, the margin (m)
  double R;    ///< big radius (m)
  double rho;  ///< R - r, radius of the balls whose intersection is the core (m)
};

/// Half the length of an edge (m).
inline double halfLength(const Patch& edge, const Radii& radii) { return radii.rho * edge.sine; }

/// Height of the core's arc over an edge's middle, rho - kappa without its cancellation (m).
inline double sag(const Patch& edge, const Radii& radii) {
  const double half = halfLength(edge, radii);
  return half * half / (radii.rho + edge.kappa);
}

/// Height of the patch's supporting plane with unit normal `n` above its anchor, margin included (m).
/// Free of cancellation for any R (docs/theory.md, 2).
inline double supportAboveAnchor(const Patch& patch, PatchKind kind, const Radii& radii,
                                 const Eigen::Vector3d& n) {
  switch (kind) {
    case PatchKind::edge: {
      const double v = n.dot(patch.axis);
      const double v2 = std::min(v * v, 1.0);
      return radii.r + sag(patch, radii) + patch.kappa * v2 / (1.0 + std::sqrt(1.0 - v2));
    }
    case PatchKind::face:
      return radii.r + 0.5 * radii.rho * (n - patch.axis).squaredNorm();
    case PatchKind::vertex:
      break;
  }
  return radii.r;
}

/// Support value h(n) of the patch continued over the whole sphere, relative to the body's origin (m).
inline double support(const Patch& patch, PatchKind kind, const Radii& radii, const Eigen::Vector3d& n) {
  return n.dot(patch.anchor) + supportAboveAnchor(patch, kind, radii, n);
}

/// The patch's point with outward unit normal `n` on the core, the body without its margin `r` (m).
inline Eigen::Vector3d corePoint(const Patch& patch, PatchKind kind, const Radii& radii,
                                 const Eigen::Vector3d& n) {
  switch (kind) {
    case PatchKind::edge: {
      // rho n - kappa w = rho v u + (rho c - kappa) w with c = |n - v u| = sqrt(1 - v^2). For large rho the
      // bracket is the small difference of large numbers and is written with the sine s instead,
      // rho^2 - kappa^2 = rho^2 s^2; near the smallest R kappa is small and that form would divide by little.
      const double v = n.dot(patch.axis);
      const Eigen::Vector3d side = n - v * patch.axis;
      const double c = side.norm();
      if (!(c > 0.0)) return patch.anchor + radii.rho * v * patch.axis;
      double across = radii.rho * c - patch.kappa;
      if (patch.kappa > 0.5 * radii.rho) {
        const double s = patch.sine, stretch = radii.rho * radii.rho / (radii.rho * c + patch.kappa);
        across = (s - v) * (s + v) * stretch;
      }
      return patch.anchor + radii.rho * v * patch.axis + (across / c) * side;
    }
    case PatchKind::face:
      return patch.anchor + radii.rho * (n - patch.axis);
    case PatchKind::vertex:
      break;
  }
  return patch.anchor;
}

/// Centre of the patch's point or circle, `I` of docs/theory.md, 2 (m).
inline Eigen::Vector3d centre(const Patch& patch, PatchKind kind, const Radii& radii) {
  if (kind == PatchKind::face) return patch.anchor - radii.rho * patch.axis;
  return patch.anchor;
}

/// Offset `c` of the patch: r for a vertex, R for an edge or a face (m).
inline double offset(PatchKind kind, const Radii& radii) {
  return kind == PatchKind::vertex ? radii.r : radii.R;
}

}  // namespace fcl_stpbv
