// The fuzz targets. Each makes random texts, and states a property that must hold for every text.
#pragma once

#include <string>
#include <vector>

#include "test/reference/shapes.h"

namespace fcl_stpbv::fuzz {

struct Target {
  const char* name;
  std::string (*generate)(test::Random& random);
  /// @throws std::logic_error if a property does not hold. Exceptions of the library other than `Error` pass
  /// on.
  void (*check)(const std::string& text, const std::string& folder);
};

const std::vector<Target>& targets();

/// Damages a text as files get damaged: cut off, with bits flipped, lines lost, duplicated or swapped, or
/// numbers replaced by huge, negative, tiny or invalid ones.
std::string damaged(std::string text, test::Random& random);

/// A smaller text for which `fails` still holds. First whole chunks are removed, then lines, then bytes.
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
