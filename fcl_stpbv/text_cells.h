// The width of a text in terminal cells, for names in any script.
#pragma once

#include <locale.h>

#include <algorithm>
#include <clocale>
#include <cstddef>
#include <cwchar>
#include <string>

namespace fcl_stpbv::detail {

/// One character of a text. `bytes` is its length, or 1 if it is not valid UTF-8. `cells` is its width on a
/// terminal: 2 for a wide character such as a Chinese one, 0 for a mark on the character before, below 0 if
/// it cannot be shown.
struct Glyph {
  std::size_t bytes;
  int cells;

  bool shown() const { return cells >= 0; }
  /// A character that cannot be shown counts as one cell.
  std::size_t width() const { return shown() ? static_cast<std::size_t>(cells) : 1; }
};

/// Sets a UTF-8 locale for this thread during its lifetime, so that UTF-8 is decoded independently of the
/// program's locale.
class Utf8Reader {
 public:
  Utf8Reader() : old_(::uselocale(utf8())) {}
  ~Utf8Reader() { ::uselocale(old_); }
  Utf8Reader(const Utf8Reader&) = delete;
  Utf8Reader& operator=(const Utf8Reader&) = delete;

  /// The character that begins at `i`, which is before the text's end.
  Glyph glyph(const std::string& text, std::size_t i) const {
    wchar_t character = 0;
    std::mbstate_t state{};
    const std::size_t bytes = std::mbrtowc(&character, text.data() + i, text.size() - i, &state);
    if (bytes == 0 || bytes > text.size() - i) return {1, -1};
    return {bytes, ::wcwidth(character)};
  }

 private:
  // If there is no UTF-8 locale, the program's own stays. Characters beyond ASCII then count as not
  // printable.
  static locale_t utf8() {
    static const locale_t locale = ::newlocale(LC_CTYPE_MASK, "C.UTF-8", nullptr);
    return locale;
  }

  locale_t old_;
};

/// Number of cells that the text takes.
inline std::size_t cellsOf(const std::string& text) {
  const Utf8Reader reader;
  std::size_t cells = 0;
  for (std::size_t i = 0; i < text.size();) {
    const Glyph glyph = reader.glyph(text, i);
    cells += glyph.width();
    i += glyph.bytes;
  }
  return cells;
}

/// As much of the text as fits into `most` cells. Each character that cannot be shown becomes '?'.
inline std::string fittedInto(std::size_t most, const std::string& text) {
  const Utf8Reader reader;
  std::string fitted;
  std::size_t cells = 0;
  for (std::size_t i = 0; i < text.size();) {
    const Glyph glyph = reader.glyph(text, i);
    cells += glyph.width();
    if (cells > most) break;
    fitted += glyph.shown() ? text.substr(i, glyph.bytes) : "?";
    i += glyph.bytes;
  }
  return fitted;
}

/// A name on one line. Each character that cannot be shown becomes '?', so the name can neither move the
/// cursor nor start a line.
inline std::string printable(const std::string& name) { return fittedInto(std::string::npos, name); }

/// A message of several lines. All lines but the first are indented, so none of them looks like a message of
/// its own.
inline std::string printableLines(const std::string& message) {
  std::string text;
  for (std::size_t begin = 0, end; begin <= message.size(); begin = end + 1) {
    end = std::min(message.find('\n', begin), message.size());
    const std::size_t first = begin == 0 ? 0 : std::min(message.find_first_not_of(' ', begin), end);
    text += (begin == 0 ? "" : "\n  ") + printable(message.substr(first, end - first));
  }
  return text;
}

}  // namespace fcl_stpbv::detail
