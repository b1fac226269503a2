// Checks a finished volume.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// Result of verify(). Lengths in m.
struct Verification {
  bool ok = false;  ///< whether all errors are at the level of rounding
  /// Largest distance by which a point is less than `margin` below the surface; at most rounding error in a
  /// correct volume. Infinite, and `ok` false, if a point or the margin is not finite.
  double containment = 0;
  double solidAngleError = 0;  ///< sum of the regions' solid angles minus 4 pi (sr)
  /// Largest distance between the core points of two neighbouring patches at a normal on their common
  /// boundary.
  double boundaryGap = 0;
  std::string message;  ///< "ok", or what is wrong
};

/// Checks three things. All vertices lie inside all big balls, and `points`, if given, lie at least the
/// volume's r below the surface. The regions of normals tile the unit sphere. Neighbouring patches meet
/// (paper III.C: the surface is C1).
Verification verify(const StpBv& volume, const std::vector<Eigen::Vector3d>& points = {});
/// The same checks, but `points` must lie at least `margin` (m) below the surface, instead of r.
Verification verify(const StpBv& volume, const std::vector<Eigen::Vector3d>& points, double margin);

/// Solid angle of each patch's region of normals (sr), by spherical excess. The further parts of a split edge
/// are added to the edge's first patch.
std::vector<double> solidAngles(const StpBv& volume);

}  // namespace fcl_stpbv
