// A box around a body's vertices, which for many bodies is all there is to them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fcl_stpbv/packed.h"

namespace fcl_stpbv::detail {

/// A box around the vertices, along the longest edge and the one that is longest across it. Own frame.
struct BodyBox {
  Packed axis[3]{};  ///< unit, at right angles to each other
  Packed centre{};   ///< m
  Packed half{};     ///< half lengths along the axes (m)
  /// Whether the vertices are the box's corners, to rounding: the box is then the vertices' hull.
  bool isHull = false;
  /// Whether the body is long or flat enough for the box to tell more about it than a ball does.
  bool isTelling = false;
};

/// `edges` name the two ends of each.
BodyBox boxAround(const std::vector<Eigen::Vector3d>& vertices, const std::vector<std::array<int, 2>>& edges);

}  // namespace fcl_stpbv::detail
