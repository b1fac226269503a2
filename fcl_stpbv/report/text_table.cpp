// See text_table.h.
#include "fcl_stpbv/report/text_table.h"

#include <algorithm>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/text_cells.h"

namespace fcl_stpbv::report {

constexpr std::size_t kBetween = 2;  // spaces between columns

void TextTable::add(std::vector<std::string> line) {
  for (std::string& text : line) text = detail::printable(text);
  lines_.push_back(std::move(line));
}

std::string TextTable::text(std::size_t indent) const {
  std::vector<std::size_t> width(sides_.size(), 0);
  for (const auto& line : lines_)
    for (std::size_t k = 0; k < line.size(); ++k) width[k] = std::max(width[k], detail::cellsOf(line[k]));
  std::string text;
  for (const auto& line : lines_) {
    std::size_t due = indent;  // spaces before the next text, written only if there is one
    for (std::size_t k = 0; k < line.size(); ++k) {
      const std::size_t room = width[k] - detail::cellsOf(line[k]);
      const bool right = sides_[k] == 'r';
      if (!line[k].empty()) text += std::string(due + (right ? room : 0), ' ') + line[k];
      due = line[k].empty() ? due + width[k] : (right ? 0 : room);
      due += kBetween;
    }
    text += "\n";
  }
  return text;
}

std::string millimetres(double metres) { return detail::formatted("%.3f", 1e3 * metres); }

std::string unshown(std::size_t all, std::size_t top) {
  return all > top ? "... and " + std::to_string(all - top) + " more (--top)\n" : "";
}

}  // namespace fcl_stpbv::report
