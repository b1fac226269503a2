// Where a ray from inside leaves a volume.
#pragma once

#include <Eigen/Core>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// Where a ray leaves the surface.
struct SurfaceHeight {
  double height;  ///< along the ray (m)
  int patch;      ///< the patch through which it leaves
  int planes;     ///< number of exits and supporting planes that were tried, a measure of the work
};

/// Height of the surface over `y`, any point of the vertices' hull, along the unit direction `d`. `hint` is a
/// patch to begin at, negative for none. Exact to rounding, which grows where the ray grazes the surface.
SurfaceHeight surfaceHeight(const StpBv& volume, const Eigen::Vector3d& y, const Eigen::Vector3d& d,
                            int hint = -1);

}  // namespace fcl_stpbv::detail
