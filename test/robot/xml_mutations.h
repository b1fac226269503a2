// Damage to the elements and attributes of an XML text, one at a time: misspelt, duplicated, emptied,
// deleted, or with values that are not numbers.
#pragma once

#include <functional>
#include <string>

namespace fcl_stpbv::test {

/// The damage to a text.
struct Mutation {
  std::string what;
  bool misspelt;  ///< whether only the name of an element or attribute has changed
};

/// Calls `judge` with a damaged copy of `text` for each `step`-th element and for each of its attributes. The
/// kinds of damage take turns, starting with `shift`. The root element itself is not changed.
void forEachMutation(const std::string& text, int shift, std::size_t step,
                     const std::function<void(const std::string& mutated, const Mutation&)>& judge);

}  // namespace fcl_stpbv::test
