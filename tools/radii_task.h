// What --advise says: a RadiiTask in words.
#pragma once

#include <string>

#include "fcl_stpbv/volume/radii_advice.h"

namespace fcl_stpbv::tools {

/// "KEY=NUMBER,..." with the names of RadiiTask's numbers, and "others=round" or "others=flat"; what is not
/// said keeps its default. @throws UsageError that names the word and what would work.
RadiiTask radiiTask(const std::string& text);

}  // namespace fcl_stpbv::tools
