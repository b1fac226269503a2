// Formats numbers and names as text, with printf's format strings; lists of names.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

namespace fcl_stpbv::detail {

/// The length of the result is not limited, because names from a user's file may be long.
template <class... Values>
std::string formatted(const char* pattern, Values... values) {
  const int size = std::snprintf(nullptr, 0, pattern, values...);
  std::string text(static_cast<std::size_t>(size) + 1, '\0');
  std::snprintf(text.data(), text.size(), pattern, values...);
  text.pop_back();
  return text;
}

/// The number with `decimals` decimals. A negative number that rounds to zero has no minus sign.
inline std::string fixed(double value, int decimals) {
  const std::string text = formatted("%.*f", decimals, value);
  return text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos ? text.substr(1) : text;
}

/// The number as in fixed(), with a '+' before it unless it is negative.
inline std::string signedFixed(double value, int decimals) {
  const std::string text = fixed(value, decimals);
  return text.front() == '-' ? text : "+" + text;
}

/// "1 pair", "2 pairs".
inline std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

/// "a, b, c and 3 more": the first `most` of `count` names. `first` must contain at least these names.
inline std::string listed(const std::vector<std::string>& first, std::size_t count, std::size_t most = 3) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most, first.size()); ++i) text += (i > 0 ? ", " : "") + first[i];
  return text + (count > most ? " and " + std::to_string(count - most) + " more" : "");
}

}  // namespace fcl_stpbv::detail
