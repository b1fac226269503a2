// A built volume checks itself.
#pragma once

#include <string>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// What verify() found. Lengths in m.
struct Verification {
  bool ok = false;  ///< whether nothing is off by more than rounding
  double containment =
      0;  ///< largest height of a point over the surface pulled in by the margin; at most
          ///< rounding. Infinite where a point or the margin is not finite: `ok` is false then
  double solidAngleError = 0;  ///< sum of the regions' solid angles minus 4 pi (sr)
  double boundaryGap = 0;      ///< largest distance between two patches' core points at a common normal
  std::string message;         ///< "ok", or what is wrong
};

/// Checks that all vertices lie inside all big balls and `points`, if given, under the surface by at least
/// `margin` (m, the volume's r where it is left out); that the regions of normals tile the sphere; and that
/// neighbouring patches meet (paper III.C: the surface is C1).
Verification verify(const StpBv& volume, const std::vector<Eigen::Vector3d>& points = {});
/// The same with another margin than the volume's r.
Verification verify(const StpBv& volume, const std::vector<Eigen::Vector3d>& points, double margin);

/// Solid angle of each patch's region of normals (sr), by spherical excess; an
/// edge's further parts count with their edge.
std::vector<double> solidAngles(const StpBv& volume);

}  // namespace fcl_stpbv
