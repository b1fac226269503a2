// A plain-text table whose columns are as wide as their contents.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace fcl_stpbv::report {

class TextTable {
 public:
  /// A letter a column: 'l' for one whose text begins, 'r' for one whose text ends at its edge.
  explicit TextTable(std::string sides) : sides_(std::move(sides)) {}

  /// A line; it may have fewer texts than there are columns. What of them cannot be shown becomes '?'.
  void add(std::vector<std::string> line);

  /// The lines, each after `indent` spaces, without spaces at their ends. The width of a text is what a
  /// terminal takes for it, in whatever script.
  std::string text(std::size_t indent = 0) const;

 private:
  std::string sides_;
  std::vector<std::vector<std::string>> lines_;
};

}  // namespace fcl_stpbv::report
