// See help_text.h.
#include "tools/help_text.h"

#include <unistd.h>

#include <algorithm>
#include <sstream>

#include "tools/terminal.h"

namespace fcl_stpbv::tools {
namespace {

constexpr std::size_t kMostColumns = 100;
constexpr std::size_t kNarrow = 70;  // with fewer columns the second column has no room for words
constexpr std::size_t kSecond = 30, kBelow = 8;

}  // namespace

std::size_t helpColumns() { return std::min(kMostColumns, columnsOf(STDOUT_FILENO)); }

std::string wrapped(const std::string& text, std::size_t columns, std::size_t indent, std::size_t before) {
  std::string lines;
  std::size_t column = before, i = 0;
  while (text.find_first_not_of(' ', i) != std::string::npos) {
    const std::size_t word = text.find_first_not_of(' ', i);
    const std::size_t end = std::min(text.find(' ', word), text.size());
    if (column + (end - i) > columns && column > indent) {
      lines += "\n" + std::string(indent, ' ');
      column = indent;
      i = word;
    }
    lines += text.substr(i, end - i);
    column += end - i;
    i = end;
  }
  return lines;
}

std::string reflowed(const std::string& text, std::size_t columns) {
  std::istringstream in(text);
  std::string result, paragraph;
  const auto close = [&] {
    if (!paragraph.empty()) result += wrapped(paragraph, columns, 0) + "\n";
    paragraph.clear();
  };
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.front() != ' ') {
      paragraph += (paragraph.empty() ? "" : " ") + line;
      continue;
    }
    close();
    result += wrapped(line, columns, kBelow) + "\n";
  }
  close();
  return result;
}

std::string entry(const std::string& option, const std::string& help, std::size_t columns) {
  const std::size_t column = columns < kNarrow ? kBelow : kSecond;
  const std::string name = "  " + option;
  if (help.empty()) return name + "\n";
  const bool beside = name.size() + 2 <= column;  // two spaces separate the name from the help
  return name + (beside ? std::string(column - name.size(), ' ') : "\n" + std::string(column, ' ')) +
         wrapped(help, columns, column, column) + "\n";
}

}  // namespace fcl_stpbv::tools
