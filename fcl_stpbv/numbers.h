// Constants, and the conversion of int to an index, that many files need.
#pragma once

#include <cstddef>
#include <limits>

namespace fcl_stpbv::detail {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846, kTwoPi = 2 * kPi;

/// Converts an index to the type of the standard containers. The library counts with int.
inline std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace fcl_stpbv::detail
