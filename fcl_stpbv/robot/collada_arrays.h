// The arrays of numbers and of indices in COLLADA's geometries, as assimp reads them.
#pragma once

#include <tinyxml2.h>

#include <string>

namespace fcl_stpbv::detail {

/// Checks the geometries of a document: each array holds what its readers take from it, positions have x, y
/// and z, no index is below 0.
void checkColladaGeometries(const tinyxml2::XMLElement& root, const std::string& name);

}  // namespace fcl_stpbv::detail
