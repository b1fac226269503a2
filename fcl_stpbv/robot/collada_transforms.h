// The transforms of COLLADA's nodes that assimp applies otherwise than they are meant.
#pragma once

#include <tinyxml2.h>

#include <string>

namespace fcl_stpbv::detail {

/// Checks an element of a node if it is a transform. @throws Error "name:line: <rotate> ..."
void checkColladaTransform(const tinyxml2::XMLElement& element, const std::string& name);

}  // namespace fcl_stpbv::detail
