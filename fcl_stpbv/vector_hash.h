// A hash of points, for hash tables that find points with equal coordinates.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace fcl_stpbv::detail {

/// Combines the hashes of the three coordinates. 0 and -0 are equal and have the same hash.
struct VectorHash {
  std::size_t operator()(const Eigen::Vector3d& v) const {
    std::size_t seed = 0;
    for (double x : v) seed = seed * 1000003u ^ std::hash<double>()(x);
    return seed;
  }
};

}  // namespace fcl_stpbv::detail
