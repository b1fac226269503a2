// Numbers from the command line: finite and in a range, and lists of them.
#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/number_check.h"

namespace fcl_stpbv::tools {

using fcl_stpbv::detail::kLargestR;
/// Longer than anything that a robot does (m, s).
constexpr double kLargest = 1e6;

/// What is wrong with `text` as a number from `least` to `most`, "" if nothing is; `least` itself is in the
/// range only where `orEqual`.
inline std::string wrongNumber(const std::string& text, double least, double most, bool orEqual = true) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const bool decimal = text.find_first_of("xX") == std::string::npos;  // strtod reads hexadecimals, too
  const bool isNumber = !text.empty() && decimal && end == text.c_str() + text.size() && std::isfinite(value);
  const bool lost = isNumber && value == 0 && text.find_first_of("123456789") < text.find_first_of("eE");
  if (isNumber && !lost && value <= most && (orEqual ? value >= least : value > least)) return "";
  return "got " + (text.empty() ? "nothing" : text) + (lost ? ", too small for a double" : "") +
         detail::formatted(", expected a number from %g to %g", least, most) +
         (orEqual ? "" : ", the first excluded");
}

/// The same for a whole number.
inline std::string wrongWholeNumber(const std::string& text, std::uint64_t least, std::uint64_t most) {
  std::uint64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec == std::errc() && result.ptr == text.data() + text.size() && value >= least && value <= most)
    return "";
  return "got " + text + ", expected a whole number, " +
         (most == std::numeric_limits<std::uint64_t>::max()
              ? std::to_string(least) + " or more"
              : "from " + std::to_string(least) + " to " + std::to_string(most));
}

/// At the commas: one word more than there are commas.
inline std::vector<std::string> splitAtCommas(const std::string& text) {
  std::vector<std::string> words{""};
  for (const char c : text) {
    if (c == ',')
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

}  // namespace fcl_stpbv::tools
