// The three patches of an STP-BV's surface, small sphere, torus part and big sphere, in one form.
#pragma once

#include <Eigen/Core>

namespace fcl_stpbv {

/// What a patch belongs to.
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

}  // namespace fcl_stpbv
