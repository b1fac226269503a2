// Checks OBJ, STL, OFF and COLLADA text line by line for damage that assimp reads over.
#include "fcl_stpbv/robot/text_mesh_check.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::detail {
namespace {

using Words = std::vector<std::string_view>;

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

Words wordsOf(std::string_view line) {
  Words words;
  for (std::size_t at = 0; at < line.size();) {
    if (isBlank(line[at])) {
      ++at;
      continue;
    }
    const std::size_t start = at;
    while (at < line.size() && !isBlank(line[at])) ++at;
    words.push_back(line.substr(start, at - start));
  }
  return words;
}

bool isNumber(std::string_view word, double& value) {
  if (word.size() > 1 && word[0] == '+') word.remove_prefix(1);
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  return result.ec == std::errc() && result.ptr == word.data() + word.size() && std::isfinite(value);
}

class Lines {
 public:
  Lines(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  /// The words of the next line that has any, a line ended by a backslash
  /// going on in the next; none at the end.
  Words next() {
    Words words;
    for (bool goesOn = true; (goesOn || words.empty()) && !text_.empty();) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      std::string_view line = text_.substr(0, end);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      ++line_;
      while (!line.empty() && isBlank(line.back())) line.remove_suffix(1);
      goesOn = !line.empty() && line.back() == '\\';
      if (goesOn) line.remove_suffix(1);
      for (const std::string_view word : wordsOf(line)) words.push_back(word);
    }
    return words;
  }
  [[noreturn]] void fail(const std::string& message) const { refuse(line_, message); }
  [[noreturn]] void refuse(int line, const std::string& message) const {
    throw Error(name_ + ":" + std::to_string(line) + ": " + message +
                "; the file is damaged, export it again");
  }
  int line() const { return line_; }

  /// At least three finite numbers after the first word, and nothing but numbers.
  void checkPoint(const Words& words) const {
    double value = 0;
    const bool good =
        words.size() >= 4 && std::all_of(words.begin() + 1, words.end(),
                                         [&](std::string_view word) { return isNumber(word, value); });
    if (!good) fail("a vertex must be three finite numbers, with a point for decimals");
  }

 private:
  std::string_view text_;
  const std::string& name_;
  int line_ = 0;
};

// The part of "7/1/3" that names a vertex.
long vertexOf(std::string_view word, const Lines& lines) {
  const std::string_view first = word.substr(0, word.find('/'));
  long index = 0;
  const auto result = std::from_chars(first.data(), first.data() + first.size(), index);
  if (result.ec != std::errc() || result.ptr != first.data() + first.size() || index == 0)
    lines.fail("a face names its vertices by whole numbers other than 0");
  return index;
}

void checkObj(std::string_view text, const std::string& name) {
  Lines lines(text, name);
  long vertices = 0, furthest = 0;
  int where = 0;
  for (Words words = lines.next(); !words.empty(); words = lines.next()) {
    if (words[0] == "v") {
      lines.checkPoint(words);
      ++vertices;
    } else if (words[0] == "f") {
      if (words.size() < 2) lines.fail("a face without vertices");
      for (std::size_t i = 1; i < words.size(); ++i) {
        const long index = vertexOf(words[i], lines);
        if (index < -vertices) lines.fail("a face names a vertex that does not exist");
        if (index <= furthest) continue;
        furthest = index;
        where = lines.line();
      }
    }
  }
  if (furthest > vertices) lines.refuse(where, "a face names a vertex that does not exist");
}

// A binary STL is as long as its count of triangles says, and may begin with "solid" all the same.
bool isBinaryStl(std::string_view text) {
  constexpr std::size_t kHead = 84, kTriangle = 50;
  if (text.size() < kHead) return false;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 4; ++i)
    count |= static_cast<std::size_t>(static_cast<unsigned char>(text[80 + i])) << 8 * i;
  return text.size() == kHead + kTriangle * count || text.substr(0, 5) != "solid";
}

void checkStl(std::string_view text, const std::string& name) {
  if (isBinaryStl(text)) return;
  Lines lines(text, name);
  int corners = 0;
  bool inFacet = false;
  for (Words words = lines.next(); !words.empty(); words = lines.next()) {
    if (words[0] == "vertex") {
      lines.checkPoint(words);
      ++corners;
    } else if (words[0] == "facet") {
      if (inFacet) lines.fail("a facet begins within another one");
      inFacet = true;
      corners = 0;
    } else if (words[0] == "endfacet") {
      if (corners != 3) lines.fail("a facet has " + std::to_string(corners) + " vertices, expected 3");
      inFacet = false;
    }
  }
  if (inFacet) lines.fail("ends within a facet");
}

void checkOff(std::string_view text, const std::string& name) {
  Lines lines(text, name);
  for (Words words = lines.next(); !words.empty(); words = lines.next()) {
    for (const std::string_view word : words) {
      if (word[0] == '#') break;
      if (word.find(',') != std::string_view::npos)
        lines.fail("a number with a comma, expected a decimal point");
    }
  }
}

int lineOf(std::string_view text, std::size_t at) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

// The value of the attribute `meter` in a tag, or 1, as COLLADA has it; "centimeter" as a name is none.
double unitIn(std::string_view tag) {
  const auto blank = [](char c) { return isBlank(c) || c == '\n'; };
  std::size_t at = tag.find("meter");
  while (at != std::string_view::npos &&
         (!blank(tag[at - 1]) || tag.find_first_not_of(" \t\r\n", at + 5) != tag.find('=', at)))
    at = tag.find("meter", at + 1);
  if (at == std::string_view::npos) return 1;
  const std::size_t open = tag.find_first_of("\"'", at);
  const std::size_t close = open == std::string_view::npos ? open : tag.find(tag[open], open + 1);
  double value = 0;
  if (close == std::string_view::npos || !isNumber(tag.substr(open + 1, close - open - 1), value)) return 0;
  return value;
}

void checkCollada(std::string_view text, const std::string& name) {
  const Lines lines(text, name);
  for (std::size_t at = text.find("<unit"); at != std::string_view::npos; at = text.find("<unit", at + 1)) {
    const std::string_view tag = text.substr(at, std::min(text.find('>', at), text.size()) - at);
    if (!(unitIn(tag) > 0)) lines.refuse(lineOf(text, at), "<unit> must have a length in metres above 0");
  }
  for (std::size_t at = text.find("<p>"); at != std::string_view::npos; at = text.find("<p>", at + 1)) {
    const std::size_t minus = text.substr(0, std::min(text.find('<', at + 1), text.size())).find('-', at);
    if (minus != std::string_view::npos) lines.refuse(lineOf(text, minus), "an index below 0");
  }
  for (std::size_t at = text.find("<float_array"); at != std::string_view::npos;
       at = text.find("<float_array", at + 1)) {
    const std::size_t start = std::min(text.find('>', at), text.size());
    const std::string_view content = text.substr(start, std::min(text.find('<', start), text.size()) - start);
    const std::size_t comma = content.find(',');
    if (comma != std::string_view::npos)
      lines.refuse(lineOf(text, start + comma), "a number with a comma, expected a decimal point");
  }
}

}  // namespace

void checkTextMesh(std::string_view text, const std::string& extension, const std::string& name) {
  if (extension == ".obj") checkObj(text, name);
  if (extension == ".stl") checkStl(text, name);
  if (extension == ".off") checkOff(text, name);
  if (extension == ".dae") checkCollada(text, name);
}

}  // namespace fcl_stpbv::detail
