// A plain-text table whose columns are as wide as their contents.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace fcl_stpbv::report {

class TextTable {
 public:
  /// One letter for each column: 'l' aligns its texts at the left edge, 'r' at the right edge.
  explicit TextTable(std::string sides) : sides_(std::move(sides)) {}

  /// Adds a line. It may have fewer texts than there are columns. Characters that cannot be shown become '?'.
  void add(std::vector<std::string> line);

  /// The lines, each after `indent` spaces, without spaces at their ends. The width of a text is counted in
  /// terminal cells, for any script.
  std::string text(std::size_t indent = 0) const;

 private:
  std::string sides_;
  std::vector<std::vector<std::string>> lines_;
};

/// A length (m) in millimetres with three decimals, as the tables show lengths.
std::string millimetres(double metres);

/// The end of a list of `all` lines that is cut after `top` of them; empty if it is not cut.
std::string unshown(std::size_t all, std::size_t top);

}  // namespace fcl_stpbv::report
