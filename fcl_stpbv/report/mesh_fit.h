// Excess of a link's convex hull and of its volume over the mesh.
#pragma once

#include <functional>
#include <limits>
#include <string>

#include "fcl_stpbv/report/exact_body.h"
#include "fcl_stpbv/robot/volume_cache.h"

namespace fcl_stpbv::report {

struct MeshFit {
  /// Largest distance of a point of the hull's surface from the mesh's
  /// triangles (m), at most. 0 for a primitive.
  double hullExcess = 0;
  /// The same of the volume's surface, at most: the volume exceeds the hull by `Body::cover` at most.
  double volumeExcess = 0;
  /// Volume enclosed by the smooth surface as a multiple of the mesh's or the primitive's; NaN where the mesh
  /// is open, the body flat or a part.
  double volumeRatio = std::numeric_limits<double>::quiet_NaN();
  bool closed = true;  ///< ExactBody::closed(); true for a part
};

/// All that a mesh's body is made of: its volume, the mesh file and, of a part, the hull.
std::string contentOf(const Body& body);

/// Uses the cache. `exact`, which returns the body's exact shape, is only called if the cache has no entry.
MeshFit meshFit(const Body& body, const std::function<const ExactBody&()>& exact, detail::VolumeCache& cache);

}  // namespace fcl_stpbv::report
