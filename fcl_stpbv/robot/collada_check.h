// Damage in COLLADA that assimp reads over: references that lead nowhere, arrays shorter than their readers
// take them to be, numbers that are none.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// @throws Error "name:line: ..." saying what is wrong.
void checkCollada(std::string_view text, const std::string& name);

}  // namespace fcl_stpbv::detail
