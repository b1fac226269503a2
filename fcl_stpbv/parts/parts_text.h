// Convex parts as text that reads back exactly, to be kept.
#pragma once

#include <string>

#include "fcl_stpbv/parts/convex_parts.h"

namespace fcl_stpbv::detail {

std::string toText(const ConvexParts& parts);

/// `name` stands for the text in messages. @throws Error for a text that is damaged.
ConvexParts partsFromText(const std::string& text, const std::string& name);

}  // namespace fcl_stpbv::detail
