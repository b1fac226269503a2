// Whether a PLY file holds what its header promises. assimp's reader trusts the header and reads past the end
// of a damaged file, which ends the process.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// @throws Error naming the file and what is wrong with it.
void checkPly(std::string_view text, const std::string& name);

}  // namespace fcl_stpbv::detail
