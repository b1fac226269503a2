// The transforms of COLLADA's nodes that assimp applies otherwise than they are meant.
#pragma once

#include <tinyxml2.h>

#include <string>

namespace fcl_stpbv::detail {

/// What the transforms within a node make of lengths: how far they may have moved a point on the way, and by
/// how much they stretch what comes behind them.
struct ColladaReach {
  double far = 0, stretch = 1;
};

/// Checks an element of a node if it is a transform, and adds it to those before it. @throws Error
/// "name:line: <rotate> ..."
void addColladaTransform(const tinyxml2::XMLElement& element, const std::string& name, ColladaReach& reach);

}  // namespace fcl_stpbv::detail
