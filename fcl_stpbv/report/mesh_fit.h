// Excess of a link's convex hull and of its volume over the mesh.
#pragma once

#include <functional>
#include <limits>
#include <string>

#include "fcl_stpbv/report/exact_body.h"
#include "fcl_stpbv/robot/volume_cache.h"

namespace fcl_stpbv::report {

struct MeshFit {
  /// Upper bound on the distance of any point of the hull's surface from the mesh's triangles (m). 0 for a
  /// primitive.
  double hullExcess = 0;
  /// The same for the volume's surface. It is larger by `Body::cover`, by which the volume exceeds the hull
  /// at most.
  double volumeExcess = 0;
  /// Volume enclosed by the smooth surface as a multiple of the volume of the mesh or the primitive. NaN if
  /// the mesh is open or the body is flat or a part.
  double volumeRatio = std::numeric_limits<double>::quiet_NaN();
  bool closed = true;  ///< ExactBody::closed(); true for a part
};

/// All data of a mesh's body, as bytes: its volume, the mesh file and, for a part, the hull.
std::string contentOf(const Body& body);

/// Uses the cache. `exact`, which returns the body's exact shape, is only called if the cache has no entry.
MeshFit meshFit(const Body& body, const std::function<const ExactBody&()>& exact, detail::VolumeCache& cache);

}  // namespace fcl_stpbv::report
