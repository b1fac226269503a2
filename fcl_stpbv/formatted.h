// Numbers and names as text, by printf's patterns.
#pragma once

#include <cstdio>
#include <string>

namespace fcl_stpbv::detail {

/// As long as it comes out: names from a user's file have no greatest length.
template <class... Values>
std::string formatted(const char* pattern, Values... values) {
  const int size = std::snprintf(nullptr, 0, pattern, values...);
  std::string text(static_cast<std::size_t>(size) + 1, '\0');
  std::snprintf(text.data(), text.size(), pattern, values...);
  text.pop_back();
  return text;
}

}  // namespace fcl_stpbv::detail
