// Checks that a PLY file matches its header. assimp's reader trusts the header and reads beyond the end of a
// damaged file, which crashes the process.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// @throws Error naming the file and what is wrong with it.
void checkPly(std::string_view text, const std::string& name);

}  // namespace fcl_stpbv::detail
