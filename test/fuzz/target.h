// What is fuzzed: each target makes texts at random and says what must hold for any text at all.
#pragma once

#include <string>
#include <vector>

#include "test/reference/shapes.h"

namespace fcl_stpbv::fuzz {

struct Target {
  const char* name;
  std::string (*generate)(test::Random& random);
  /// @throws std::logic_error where a property does not hold. Anything but
  /// `Error` that the library throws passes on.
  void (*check)(const std::string& text, const std::string& folder);
};

const std::vector<Target>& targets();

/// Damages a text the way files get damaged: cut off, bits flipped, lines lost, doubled or swapped, numbers
/// replaced by huge, negative, tiny or no numbers.
std::string damaged(std::string text, test::Random& random);

/// A smaller text on which `fails` still holds: whole chunks go first, then lines, then bytes.
template <class Fails>
std::string shrunk(std::string text, Fails fails) {
  for (std::size_t chunk = text.size() / 2; chunk > 0; chunk /= 2)
    for (std::size_t at = 0; at + chunk <= text.size();) {
      std::string shorter = text;
      shorter.erase(at, chunk);
      if (fails(shorter))
        text = std::move(shorter);
      else
        at += chunk;
    }
  return text;
}

}  // namespace fcl_stpbv::fuzz
