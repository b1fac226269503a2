// Damage in COLLADA that assimp reads over: references that lead nowhere, arrays shorter than their readers
// take them to be, numbers that are none.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// @returns the largest number that the transforms within a node above a shape add up from (m): they may
/// bring it back to where it was.
/// @throws Error "name:line: ..." saying what is wrong.
double checkCollada(std::string_view text, const std::string& name);

}  // namespace fcl_stpbv::detail
