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
/// Larger than any length or time of a robot (m, s).
constexpr double kLargest = 1e6;

/// The number in a text that wrongNumber() accepts.
inline double numberIn(const std::string& text) { return std::strtod(text.c_str(), nullptr); }

/// The reason why `text` is not a number from `least` to `most`, "" if it is one. `least` itself is allowed
/// only with `orEqual`.
inline std::string wrongNumber(const std::string& text, double least, double most, bool orEqual = true) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  // strtod() also reads hexadecimal numbers.
  const bool decimal = text.find_first_of("xX") == std::string::npos;
  const bool isNumber = !text.empty() && decimal && end == text.c_str() + text.size() && std::isfinite(value);
  // So near to zero a double has few digits or none.
  const bool lost = isNumber && std::abs(value) < std::numeric_limits<double>::min() &&
                    text.find_first_of("123456789") < text.find_first_of("eE");
  if (isNumber && !lost && value <= most && (orEqual ? value >= least : value > least)) return "";
  return "got " + (text.empty() ? "nothing" : text) + (lost ? ", too small for a double" : "") +
         detail::formatted(", expected a number from %g to %g", least, most) +
         (orEqual ? "" : ", the first excluded");
}

/// wrongNumber() for a whole number.
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

/// Splits a text at its commas.
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
