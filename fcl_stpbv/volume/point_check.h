// Checks the points that callers pass to functions that build or measure volumes.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::detail {

/// @throws Error naming the point by its number unless all its coordinates are finite.
inline void requireFinite(std::size_t number, const Eigen::Vector3d& point) {
  if (!point.allFinite())
    throw Error("point " + std::to_string(number) + " is not finite: every coordinate must be a number");
}

/// Checks all points; the number of a point is its index.
inline void requireFinite(const std::vector<Eigen::Vector3d>& points) {
  for (std::size_t i = 0; i < points.size(); ++i) requireFinite(i, points[i]);
}

}  // namespace fcl_stpbv::detail
