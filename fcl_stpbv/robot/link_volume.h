// Makes the STP-BV of a link's mesh, with its radii, its limit on the over-cover, and the cache; or its flat
// convex hull.
#pragma once

#include "fcl_stpbv/robot/fitted_radii.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/shape_source.h"
#include "fcl_stpbv/robot/volume_cache.h"

namespace fcl_stpbv::detail {

/// The key of a link's volume in the cache. If r or R depend on the body's size, the entry contains them, so
/// that the mesh need not be read again.
struct VolumeKey {
  std::string content;
  StpBvOptions radii;  ///< the radii in the options, even if fitted ones are used instead
};
VolumeKey volumeKey(const GeometryOptions& options, const std::string& link, const std::string& meshKey);

/// r and R of a link's bodies: the link's own radii, those for all links, or fitted ones (GeometryOptions).
/// `size` is only called if they are fitted. Ignores GeometryOptions::advice, which is for meshes.
StpBvOptions radiiFor(const GeometryOptions& options, const std::string& link,
                      const std::function<BodySize()>& size);

/// Makes `body` the volume of its mesh. @throws Error without the file's name.
void makeVolume(const GeometryOptions& options, const std::string& link, const ShapeSource& source,
                VolumeCache& cache, Body& body);

/// Makes `body` the convex hull of a cloud (m, the shape's own frame), flat, with its centre in that frame.
void makeHull(const std::vector<Eigen::Vector3d>& points, Body& body);

}  // namespace fcl_stpbv::detail
