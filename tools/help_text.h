// Lines of help that fit the terminal.
#pragma once

#include <cstddef>
#include <string>

namespace fcl_stpbv::tools {

/// Columns of the help: those of the terminal behind standard output, but not more than can be read easily.
std::size_t helpColumns();

/// Breaks `text` where a word would go beyond `columns`. Lines after the first begin with `indent` spaces.
/// The first line starts after `before` columns. Words are never split.
std::string wrapped(const std::string& text, std::size_t columns, std::size_t indent, std::size_t before = 0);

/// Reflows a text. A line that begins with a space stays a line of its own. Other lines are joined to one
/// paragraph, up to such a line or an empty line.
std::string reflowed(const std::string& text, std::size_t columns);

/// An option and its help. The help is in a second column, or below the option if the terminal is narrow.
std::string entry(const std::string& option, const std::string& help, std::size_t columns);

}  // namespace fcl_stpbv::tools
