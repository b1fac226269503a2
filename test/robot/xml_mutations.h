// Damage to the elements and attributes of an XML text, one at a time: misspelt, doubled, emptied, deleted,
// with values that are no numbers.
#pragma once

#include <functional>
#include <string>

namespace fcl_stpbv::test {

/// What was done to a text.
struct Mutation {
  std::string what;
  bool misspelt;  ///< nothing but the name of an element or attribute has changed
};

/// Calls `judge` with a damaged copy of `text` for each `step`-th element and for each of its attributes. The
/// kind of damage goes round, from `shift` on; the root element itself stays.
void forEachMutation(const std::string& text, int shift, std::size_t step,
                     const std::function<void(const std::string& mutated, const Mutation&)>& judge);

}  // namespace fcl_stpbv::test
