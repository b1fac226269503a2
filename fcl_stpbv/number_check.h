// Range checks of numbers that callers pass as options. A number out of its range gives an Error with its
// name; so does NaN.
#pragma once

#include <string>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"

namespace fcl_stpbv::detail {

/// Largest R that is useful (m): beyond it the surface of a big sphere is flat up to the rounding of a body's
/// coordinates.
constexpr double kLargestR = 1e8;

/// @throws Error naming the number and the range that would work unless `least <= value <= most`.
inline void requireNumber(const std::string& name, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw Error(name + formatted(": got %.9g, expected a number from %.9g to %.9g", value, least, most));
}

/// @throws Error naming `owner`, the argument `what` and both sizes unless they are the same.
inline void requireSize(const char* owner, const char* what, long size, long expected) {
  if (size != expected)
    throw Error(std::string(owner) + ": " + what + " has the size " + std::to_string(size) + ", expected " +
                std::to_string(expected));
}

/// @throws Error naming `owner` and both numbers unless 0 <= row < rows.
inline void requireRow(const char* owner, int row, int rows) {
  if (row < 0 || row >= rows)
    throw Error(std::string(owner) + ": there is no row " + std::to_string(row) + " of " +
                std::to_string(rows));
}

}  // namespace fcl_stpbv::detail
