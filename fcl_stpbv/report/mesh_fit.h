// How far a link's convex hull and its volume exceed its mesh.
#pragma once

#include <limits>

#include "fcl_stpbv/report/exact_body.h"

namespace fcl_stpbv::report {

struct MeshFit {
  /// Largest distance of a point of the hull's surface from the mesh's triangles (m), at most. 0 for a
  /// primitive.
  double hullExcess = 0;
  /// The same of the volume's surface, at most: the volume exceeds the hull by `Body::cover` at most.
  double volumeExcess = 0;
  /// Volume enclosed by the smooth surface as a multiple of the mesh's or the primitive's; NaN where the mesh
  /// is open, the body flat or a part.
  double volumeRatio = std::numeric_limits<double>::quiet_NaN();
};

MeshFit meshFit(const Body& body, const ExactBody& exact);

}  // namespace fcl_stpbv::report
