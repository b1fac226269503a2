// Reads the argument of --advise as a RadiiTask.
#pragma once

#include <string>

#include "fcl_stpbv/volume/radii_advice.h"

namespace fcl_stpbv::tools {

/// "KEY=NUMBER,..." with the names of RadiiTask's numbers, and "others=round" or "others=flat". Values that
/// are not given keep their defaults. @throws UsageError that names the word and what would work.
RadiiTask radiiTask(const std::string& text);

}  // namespace fcl_stpbv::tools
