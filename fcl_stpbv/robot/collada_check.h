// Finds errors in COLLADA files that assimp silently ignores: invalid references, arrays that are too short,
// and invalid numbers.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// @returns the largest intermediate coordinate in the transforms within a node above a shape (m). It may be
/// much larger than the result, because transforms may cancel.
/// @throws Error "name:line: ..." saying what is wrong.
double checkCollada(std::string_view text, const std::string& name);

}  // namespace fcl_stpbv::detail
