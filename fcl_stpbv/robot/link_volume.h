// The STP-BV of a link's mesh: its radii, the budget for its over-cover, and the cache.
#pragma once

#include "fcl_stpbv/robot/fitted_radii.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/shape_source.h"
#include "fcl_stpbv/robot/volume_cache.h"

namespace fcl_stpbv::detail {

/// Whether r or R of a link's bodies follow the body's size.
bool areFitted(const GeometryOptions& options, const std::string& link);

/// r and R of a link's bodies: the link's own, those for all links, or what fits the body (GeometryOptions).
/// `size` is only asked where they are fitted.
StpBvOptions radiiFor(const GeometryOptions& options, const std::string& link,
                      const std::function<BodySize()>& size);

/// Makes `body` the volume of its mesh. @throws Error without the file's name.
void makeVolume(const GeometryOptions& options, const std::string& link, const ShapeSource& source,
                VolumeCache& cache, Body& body);

}  // namespace fcl_stpbv::detail
