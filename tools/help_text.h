// Lines of help that fit the terminal.
#pragma once

#include <cstddef>
#include <string>

namespace fcl_stpbv::tools {

/// Columns of the help: what the terminal behind standard output has, but no more than are easily read.
std::size_t helpColumns();

/// Breaks `text` where a word would go beyond `columns`; lines after the first begin with `indent` spaces.
/// The first one stands behind `before` columns. Words are never split.
std::string wrapped(const std::string& text, std::size_t columns, std::size_t indent, std::size_t before = 0);

/// A text in which a line that begins with a space stays one, and all others up to it or to an empty line are
/// one paragraph.
std::string reflowed(const std::string& text, std::size_t columns);

/// An option and what it does, the latter in a second column, or below where the terminal is narrow.
std::string entry(const std::string& option, const std::string& help, std::size_t columns);

}  // namespace fcl_stpbv::tools
