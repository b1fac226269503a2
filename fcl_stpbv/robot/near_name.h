// Suggestions for misspelt names: the known name with the smallest edit distance.
#pragma once

#include <algorithm>
#include <cctype>
#include <numeric>
#include <string>
#include <vector>

namespace fcl_stpbv::detail {

/// Letters to add, leave out or replace until `a` is `b`; upper and lower case are the same.
inline std::size_t lettersApart(const std::string& a, const std::string& b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i]) != lower(b[j]));
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// "; did you mean 'ee_link'?" if a name in `known` differs from `name` by at most a third of its letters, or
/// contains it; else "". It compares all names, so it is slow; use it only for messages that end a program.
inline std::string didYouMean(const std::string& name, const std::vector<std::string>& known) {
  constexpr std::size_t kLongest = 100;  // longer names are no slips of the hand
  const std::string* best = nullptr;
  std::size_t least = 0;
  for (const std::string& other : known) {
    if (name.empty() || std::max(name.size(), other.size()) > kLongest) continue;
    const std::size_t apart = lettersApart(name, other);
    const bool near = apart <= std::max<std::size_t>(1, name.size() / 3) ||
                      (name.size() > 1 && other.find(name) != std::string::npos);
    if (!near || (best && apart >= least)) continue;
    best = &other;
    least = apart;
  }
  return best ? "; did you mean '" + *best + "'?" : "";
}

}  // namespace fcl_stpbv::detail
