// Checks transforms of COLLADA's nodes that assimp applies wrongly.
#pragma once

#include <tinyxml2.h>

#include <string>

namespace fcl_stpbv::detail {

/// Bounds for the transforms within a node: how far they may move a point in between, and by how much they
/// stretch the content below.
struct ColladaReach {
  double far = 0, stretch = 1;
};

/// Checks an element of a node. If it is a transform, adds it to `reach`.
/// @throws Error "name:line: <rotate> ..."
void addColladaTransform(const tinyxml2::XMLElement& element, const std::string& name, ColladaReach& reach);

}  // namespace fcl_stpbv::detail
