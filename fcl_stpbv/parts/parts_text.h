// Convex parts as text for the cache. Reading a text gives exactly the numbers that were written.
#pragma once

#include <string>

#include "fcl_stpbv/parts/convex_parts.h"

namespace fcl_stpbv::detail {

std::string toText(const ConvexParts& parts);

/// `name` stands for the text in messages. @throws Error for a text that is damaged.
ConvexParts partsFromText(const std::string& text, const std::string& name);

}  // namespace fcl_stpbv::detail
