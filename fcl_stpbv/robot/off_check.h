// Checks that an OFF file matches its header, and that assimp reads its lines correctly.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// @throws Error "name:line: ..." saying what is wrong.
void checkOff(std::string_view text, const std::string& name);

}  // namespace fcl_stpbv::detail
