// The reasons in disable_collisions, as people write them.
#pragma once

#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// MoveIt's word for a reason that is written in any case and with blanks around it; "User" if there are only
/// blanks. Other reasons stay as they are.
std::string usualReason(std::string_view reason);

}  // namespace fcl_stpbv::detail
