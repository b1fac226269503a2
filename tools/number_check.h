// Numbers from the command line: finite and in a range. CLI11's own checks let NaN through.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "fcl_stpbv/number_check.h"

namespace fcl_stpbv::tools {

using fcl_stpbv::detail::kLargestR;
/// Longer than anything that a robot does (m, s).
constexpr double kLargest = 1e6;

/// A number from `least` to `most`; `least` itself only where `orEqual`.
inline CLI::Validator numberIn(double least, double most, bool orEqual = true) {
  const std::string range = CLI::detail::to_string(least) + " to " + CLI::detail::to_string(most);
  return CLI::Validator(
      [=](std::string& text) {
        double value = std::nan("");
        const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value <= most &&
                          (orEqual ? value >= least : value > least);
        return good ? std::string()
                    : "got " + text + ", expected a number from " + range +
                          (orEqual ? "" : ", the first excluded");
      },
      "NUMBER");
}

/// A number that counts, from `least` to `most`; CLI11 itself takes -1 for the largest of all.
inline CLI::Validator wholeNumber(std::uint64_t least = 0,
                                  std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) {
  const std::string range = most == std::numeric_limits<std::uint64_t>::max()
                                ? std::to_string(least) + " or more"
                                : "from " + std::to_string(least) + " to " + std::to_string(most);
  return CLI::Validator(
      [=](std::string& text) {
        std::uint64_t value = 0;
        const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool good = result.ec == std::errc() && result.ptr == text.data() + text.size() &&
                          value >= least && value <= most;
        return good ? std::string() : "got " + text + ", expected a whole number, " + range;
      },
      "NUMBER");
}

}  // namespace fcl_stpbv::tools
