// Suggestions for misspelt names: the known name with the smallest edit distance.
#pragma once

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "fcl_stpbv/mesh/mesh_lines.h"

namespace fcl_stpbv::detail {

/// Edit distance: number of letters to add, leave out or replace to turn `a` into `b`.
inline std::size_t lettersApart(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// The name in `known` that differs from `name` by the fewest letters (at most a third of them), or that
/// contains it or is contained in it; "" if there is none. Upper and lower case are the same. Looks at all
/// names, which takes about a microsecond each.
inline std::string nearName(const std::string& name, const std::vector<std::string>& known) {
  constexpr std::size_t kLongest = 100;  // longer names are no typing errors
  constexpr std::size_t kLeast = 3;      // a longer name contains so many letters not by chance
  const std::string wanted = inSmallLetters(name);
  const std::size_t most = wanted.size() < 2 ? 0 : std::max<std::size_t>(1, wanted.size() / 3);
  std::string best;
  std::size_t least = 0;
  for (const std::string& each : known) {
    if (name.empty() || each.empty() || std::max(name.size(), each.size()) > kLongest) continue;
    const std::string other = inSmallLetters(each);
    const std::size_t apart = lettersApart(wanted, other);
    const bool near = apart <= most || (wanted.size() > 1 && other.find(wanted) != std::string::npos) ||
                      (other.size() >= kLeast && wanted.find(other) != std::string::npos);
    if (!near || (!best.empty() && apart >= least)) continue;
    best = each;
    least = apart;
  }
  return best;
}

/// "; did you mean 'ee_link'?" for a name, "" for "".
inline std::string proposed(const std::string& near) {
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

/// proposed() of the nearest name. For messages.
inline std::string didYouMean(const std::string& name, const std::vector<std::string>& known) {
  return proposed(nearName(name, known));
}

/// Proposals for only the first few of many misspelt names, because each proposal looks at all known names.
class FirstProposals {
 public:
  /// nearName() among the names that `known()` returns, or "".
  template <class Known>
  std::string near(const std::string& name, const Known& known) {
    constexpr int kMost = 5;
    return asked_++ < kMost ? nearName(name, known()) : "";
  }
  /// near() in the words of didYouMean().
  template <class Known>
  std::string of(const std::string& name, const Known& known) {
    return proposed(near(name, known));
  }

 private:
  int asked_ = 0;
};

/// The names of all links, joints or states.
template <class Named>
std::vector<std::string> namesOf(const std::vector<Named>& all) {
  std::vector<std::string> names;
  for (const Named& each : all) names.push_back(each.name);
  return names;
}

}  // namespace fcl_stpbv::detail
