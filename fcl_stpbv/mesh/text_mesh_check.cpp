// Checks OBJ and STL text line by line for errors that assimp ignores.
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <set>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_checks.h"
#include "fcl_stpbv/mesh/mesh_lines.h"

namespace fcl_stpbv::detail {
namespace {

bool beginsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

void checkCoordinates(const MeshWords& words, const MeshLines& lines) {
  if (words.size() < 4 || !std::all_of(words.begin() + 1, words.end(), isMeshNumber))
    lines.damaged("a vertex must be three finite numbers, " + std::string(kNumberForm));
}

/// The next line of an OBJ, together with the lines that a backslash joins to it; `joined` holds their text.
bool nextObjLine(MeshLines& lines, std::string& joined, std::string_view& line) {
  if (!lines.next()) return false;
  line = lines.text();
  if (line.empty() || line.back() != '\\') return true;
  joined = line;
  while (!joined.empty() && joined.back() == '\\') {
    joined.pop_back();
    const int start = lines.line();
    const bool byReturn = lines.end() == "\r";
    if (!lines.next()) {
      if (!beginsWith(joined, "#")) lines.damaged("ends within a line that a backslash continues");
      break;
    }
    // assimp continues past an empty line, and past all lines that end with a single carriage return.
    std::string_view rest = lines.text();
    const std::string keyword = inSmallLetters(takeWord(rest));
    if (byReturn || lines.text().empty() || keyword == "v" || keyword == "f")
      lines.refuse(start, "a line that ends in a backslash takes the next one with it; remove the backslash");
    joined += lines.text();
  }
  line = joined;
  return true;
}

bool looksLikeNumber(std::string_view word) {
  const std::string start = inSmallLetters(word.substr(0, 3));
  return std::string_view("0123456789+-").find(word[0]) != std::string_view::npos || start == "nan" ||
         start == "inf";
}

// assimp's buffer for a number holds this many characters, and the rest becomes the next number.
constexpr std::size_t kLongestNumber = 4095;
constexpr std::size_t kLongestQuoted = 40;

// assimp counts the numbers of a vertex up to the line's end, and ignores a vertex with another count.
void checkObjVertex(std::string_view line, const MeshLines& lines) {
  const std::size_t end = std::min(line.find('#'), line.size());
  const MeshWords words = wordsOf(line.substr(0, end));
  if (std::any_of(words.begin(), words.end(), [](std::string_view w) { return w.size() >= kLongestNumber; }))
    lines.refuse("a number of " + std::to_string(kLongestNumber) +
                 " characters or more is not read; write it with fewer digits");
  checkCoordinates(words, lines);
  const std::size_t numbers = words.size() - 1;
  if (numbers == 5 || numbers > 6)
    lines.refuse("a vertex of " + std::to_string(numbers) +
                 " numbers is not read, only one of 3, of 4 with a weight and of 6 with a colour");
  double weight = 1;  // weight of a rational curve's point; assimp divides by it, other readers do not
  if (numbers == 4 && !(readMeshNumber(words[4], weight) && weight == 1))
    lines.refuse("a vertex has the weight " + std::string(words[4].substr(0, kLongestQuoted)) +
                 ", which programs read in different ways; write its three coordinates alone");
  if (std::any_of(words.begin() + 1, words.end(), [](std::string_view w) { return !looksLikeNumber(w); }))
    lines.refuse("a number that begins with its point is not read; write a 0 before that");
  const std::string_view comment = line.substr(end);
  const MeshWords remark = wordsOf(comment.substr(std::min(comment.find_first_of(" \t"), comment.size())));
  if (std::any_of(remark.begin(), remark.end(), looksLikeNumber))
    lines.refuse(
        "a number in the comment is taken for one of the vertex; give the comment a line of its own");
}

// The index of the vertex in a word such as "7/1/3".
long vertexOf(std::string_view word, const MeshLines& lines) {
  const std::string_view first = word.substr(0, word.find('/'));
  long index = 0;
  const auto result = std::from_chars(first.data(), first.data() + first.size(), index);
  if (result.ec != std::errc() || result.ptr != first.data() + first.size() || index == 0)
    lines.damaged("a face names its vertices by whole numbers other than 0");
  return index;
}

/// Which lines for textures and normals assimp has read so far. While it has only normals, it reads the
/// second number of "7/1/3" as a normal, and at the third it drops the rest of the face.
class ObjReferences {
 public:
  void note(std::string_view line) {
    textures_ = textures_ || beginsWith(line, "vt");
    normals_ = normals_ || beginsWith(line, "vn");
  }

  void check(std::string_view word, const MeshLines& lines) const {
    const std::size_t first = word.find('/');
    if (first == std::string_view::npos) return;
    const std::size_t second = word.find('/', first + 1);
    if (second == std::string_view::npos) return;
    if (word.find('/', second + 1) != std::string_view::npos)
      lines.damaged("a vertex of a face has more than two slashes, expected such as 7/1/3");
    if (second > first + 1 && second + 1 < word.size() && normals_ && !textures_)
      lines.refuse("'" + std::string(word.substr(0, kLongestQuoted)) +
                   "' names a texture coordinate, but no line before it begins with 'vt'; write it with two "
                   "slashes in a row, or move the lines 'vt' to the file's start");
  }

 private:
  bool textures_ = false, normals_ = false;
};

// assimp ignores unknown statements. A misspelt vertex would be lost and shift all later indices.
void checkObjStatement(std::string_view keyword, const MeshLines& lines) {
  static const std::set<std::string_view> kKnown{
      "v",      "vt",    "vn",       "vp",       "f",   "fo",         "l",         "p",      "o",
      "g",      "s",     "mg",       "cstype",   "deg", "bmat",       "step",      "parm",   "trim",
      "hole",   "scrv",  "sp",       "end",      "con", "curv2",      "usemtl",    "mtllib", "usemap",
      "maplib", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "ctech",  "stech"};
  static const std::set<std::string_view> kUnread{"bsp", "bzp", "cdc", "cdp", "curv", "surf", "call", "csh"};
  if (kUnread.count(keyword) != 0)
    lines.refuse("'" + std::string(keyword) +
                 "' is not read: export free-form shapes, and those of other files, "
                 "as triangles of this one");
  if (keyword[0] != '#' && kKnown.count(keyword) == 0)
    lines.damaged("a line begins with '" + std::string(keyword.substr(0, kLongestQuoted)) +
                  "', which is no statement of OBJ");
}

void checkObj(std::string_view text, const std::string& name) {
  MeshLines lines(text, name);
  std::string joined;
  std::string_view line;
  ObjReferences references;
  long vertices = 0, furthest = 0;
  int where = 0;
  while (nextObjLine(lines, joined, line)) {
    const MeshWords words = wordsOf(line);
    const std::string_view keyword = words.empty() ? std::string_view() : words[0];
    const bool vertex = keyword == "v", face = keyword == "f";
    if (keyword == "V" || keyword == "F")
      lines.refuse("a line that begins with '" + std::string(keyword) + "' is not read; write it small");
    if ((vertex || face) && line[0] != keyword[0])
      lines.refuse("a line with blanks before '" + std::string(keyword) + "' is not read; remove them");
    if ((face || keyword == "l" || keyword == "p") && line.find('#') != std::string_view::npos)
      lines.refuse("a comment after vertices is taken for one of them; give it a line of its own");
    if (!keyword.empty()) checkObjStatement(keyword, lines);
    references.note(line);
    if (face || keyword == "l" || keyword == "p")
      for (std::size_t i = 1; i < words.size(); ++i) references.check(words[i], lines);
    if (vertex) {
      checkObjVertex(line, lines);
      ++vertices;
    } else if (face) {
      if (words.size() < 2) lines.damaged("a face without vertices");
      for (std::size_t i = 1; i < words.size(); ++i) {
        const long index = vertexOf(words[i], lines);
        if (index < -vertices) lines.damaged("a face names a vertex that does not exist");
        if (index <= furthest) continue;
        furthest = index;
        where = lines.line();
      }
    }
  }
  if (furthest > vertices) lines.damaged(where, "a face names a vertex that does not exist");
}

// A binary STL may begin with "solid" nevertheless.
bool isBinaryStl(std::string_view text) {
  const std::size_t start = std::min(text.find_first_not_of(" \t"), text.size());
  return !beginsWith(text.substr(start), "solid") || hasLengthOfBinaryStl(text);
}

/// Follows the solids of an STL and their facets. After an "endsolid" assimp reads on only if "solid" is
/// next.
class StlLines {
 public:
  StlLines(std::string_view text, const std::string& name) : lines_(text, name) {}

  void check() {
    while (lines_.next()) {
      const MeshWords words = wordsOf(lines_.text());
      if (words.empty()) continue;
      const std::string keyword = inSmallLetters(words[0]);
      const bool known = isKnown(keyword) || beginsWith(keyword, "solid") || beginsWith(keyword, "endsolid");
      if (keyword != words[0] && known)
        lines_.refuse("'" + std::string(words[0]) + "' is not read; write it in small letters");
      if (inSolid_ && !known)
        lines_.damaged("got '" + std::string(words[0]) + "', expected a line of a facet, or 'endsolid'");
      if (inSolid_)
        within(keyword, words);
      else
        between(keyword, words);
    }
    if (inFacet_) lines_.damaged("ends within a facet");
    if (inSolid_) lines_.damaged("ends within a solid; is the file whole? It must end by 'endsolid'");
  }

 private:
  static bool isKnown(std::string_view word) {
    constexpr std::string_view kWords[] = {"facet",  "normal",  "outer",   "loop",
                                           "vertex", "endloop", "endfacet"};
    return std::find(std::begin(kWords), std::end(kWords), word) != std::end(kWords);
  }

  void between(const std::string& keyword, const MeshWords& words) {
    if (beginsWith(keyword, "solid") && stray_ == 0)
      inSolid_ = !endsWithin(words, 2);
    else if (stray_ == 0)
      stray_ = lines_.line();
    if (keyword == "facet" || keyword == "vertex")
      lines_.damaged(stray_, "a line outside of any solid; assimp ignores the file from here on");
  }

  void within(const std::string& keyword, const MeshWords& words) {
    const auto begins = [](std::string_view word) { return word == "facet" || word == "vertex"; };
    if (!beginsWith(words[0], "endsolid") && std::any_of(words.begin() + 1, words.end(), begins))
      lines_.damaged("a facet or a vertex must begin its line");
    if (keyword == "vertex") {
      if (!inFacet_) lines_.damaged("a vertex outside of a facet");
      if (words.size() > 4) lines_.damaged("a vertex must be three numbers");
      checkCoordinates(words, lines_);
      ++corners_;
    } else if (keyword == "facet") {
      if (inFacet_) lines_.damaged("a facet begins within another one");
      inFacet_ = true;
      corners_ = 0;
    } else if (keyword == "endfacet") {
      if (!inFacet_) lines_.damaged("'endfacet' outside of a facet");
      if (corners_ != 3) lines_.damaged("a facet has " + std::to_string(corners_) + " vertices, expected 3");
      inFacet_ = false;
    }
    if (!endsWithin(words, 0)) return;
    if (inFacet_) lines_.damaged("a solid ends within a facet");
    inSolid_ = false;
  }

  // Whether one of the words from `first` on begins with "endsolid". The name of a solid does not count.
  static bool endsWithin(const MeshWords& words, std::size_t first) {
    return words.size() > first &&
           std::any_of(words.begin() + static_cast<std::ptrdiff_t>(first), words.end(),
                       [](std::string_view word) { return beginsWith(word, "endsolid"); });
  }

  MeshLines lines_;
  bool inSolid_ = false, inFacet_ = false;
  int corners_ = 0;
  int stray_ = 0;  // line number of the first line outside of any solid
};

/// The text after a byte-order mark. With the mark, assimp misses the first word, and with it a vertex.
std::string_view pastByteOrderMark(std::string_view text, const std::string& name) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (!beginsWith(text, kMark)) return text;
  text.remove_prefix(kMark.size());
  std::string_view first = text;
  if (!beginsWith(takeWord(first), "#"))
    throw Error(
        name +
        ":1: begins with a byte-order mark, which hides this line; save the file as UTF-8 without one");
  return text;
}

}  // namespace

bool hasLengthOfBinaryStl(std::string_view text) {
  constexpr std::size_t kHeader = 84, kTriangle = 50;
  if (text.size() < kHeader) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, text.data() + kHeader - sizeof count, sizeof count);
  return text.size() == kHeader + kTriangle * std::size_t{count};
}

double checkTextMesh(std::string_view text, const std::string& extension, const std::string& name) {
  const bool obj = extension == ".obj", off = extension == ".off", dae = extension == ".dae";
  const bool stl = extension == ".stl" && !isBinaryStl(text);
  if (stl && text.find('\0') != std::string_view::npos && text.find("facet") == std::string_view::npos)
    throw Error(
        name +
        ": is a binary STL, by its NUL bytes, whose length does not fit its count of triangles; the file is "
        "damaged, export it again");
  if (obj || off || dae || stl) refuseNul(text, name);
  const std::string_view behindMark = obj || off || stl ? pastByteOrderMark(text, name) : text;
  if (obj) checkObj(behindMark, name);
  if (stl) StlLines(text, name).check();
  if (off) checkOff(text, name);
  return dae ? checkCollada(text, name) : 0;
}

}  // namespace fcl_stpbv::detail
