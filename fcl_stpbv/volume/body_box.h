// A box around a body's vertices. For many bodies the vertices are just the corners of this box.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fcl_stpbv/packed.h"

namespace fcl_stpbv::detail {

/// A box around the vertices, in the body's frame. Its first axis is along the longest edge. Its second axis
/// is along the edge that is longest perpendicular to the first.
struct BodyBox {
  Packed axis[3]{};  ///< unit, at right angles to each other
  Packed centre{};   ///< m
  Packed half{};     ///< half lengths along the axes (m)
  /// Whether the vertices are the box's corners, to rounding: the box is then the vertices' hull.
  bool isHull = false;
  /// Whether the body is so long or flat that the box bounds it more closely than a ball.
  bool isTelling = false;
};

/// `edges`: indices of the two ends of each edge.
BodyBox boxAround(const std::vector<Eigen::Vector3d>& vertices, const std::vector<std::array<int, 2>>& edges);

}  // namespace fcl_stpbv::detail
