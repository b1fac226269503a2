// The arrays of numbers and of indices in COLLADA's geometries, as assimp reads them.
#pragma once

#include <tinyxml2.h>

#include <string>

namespace fcl_stpbv::detail {

/// Checks the geometries of a document: arrays are large enough for all accesses, positions have x, y and z,
/// and no index is negative.
void checkColladaGeometries(const tinyxml2::XMLElement& root, const std::string& name);

}  // namespace fcl_stpbv::detail
