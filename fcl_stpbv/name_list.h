// A list of names for messages, shortened if it is long.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace fcl_stpbv::detail {

/// "a, b, c and 3 more": the first `most` of `count` names. `first` must contain at least these names.
inline std::string listed(const std::vector<std::string>& first, std::size_t count, std::size_t most = 3) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most, first.size()); ++i) text += (i > 0 ? ", " : "") + first[i];
  return text + (count > most ? " and " + std::to_string(count - most) + " more" : "");
}

}  // namespace fcl_stpbv::detail
