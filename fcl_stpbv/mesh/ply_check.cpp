// Checks a PLY file against its own header before assimp reads it: sizes, counts, the length of the data.
#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_checks.h"
#include "fcl_stpbv/mesh/mesh_lines.h"

namespace fcl_stpbv::detail {
namespace {

struct PlyType {
  std::size_t bytes = 0;
  bool isWhole = false;
  long least = 0, most = 0;  // range of a whole number
};

struct Property {
  std::string name;
  PlyType count;  // type of a list's count; without bytes for a single value
  PlyType value;
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { text, littleEndian, bigEndian };

struct Header {
  Encoding encoding = Encoding::text;
  std::vector<Element> elements;
};

PlyType readType(std::string_view word, const MeshLines& lines) {
  static const std::map<std::string_view, std::size_t> kSizes{
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = kSizes.find(word);
  if (found == kSizes.end()) lines.refuse("a property of unknown type, expected one of PLY's, such as float");
  PlyType type{found->second, word[0] != 'f' && word[0] != 'd'};
  if (!type.isWhole) return type;
  const bool isUnsigned = word[0] == 'u';
  type.most = (1L << (8 * type.bytes - (isUnsigned ? 0 : 1))) - 1;
  type.least = isUnsigned ? 0 : -type.most - 1;
  return type;
}

Encoding readEncoding(std::string_view word, const MeshLines& lines) {
  if (word == "ascii") return Encoding::text;
  if (word == "binary_little_endian") return Encoding::littleEndian;
  if (word == "binary_big_endian") return Encoding::bigEndian;
  lines.refuse("an unknown encoding, expected ascii, binary_little_endian or binary_big_endian");
}

Property readProperty(const MeshWords& words, const MeshLines& lines) {
  const bool isList = words.size() > 4 && words[1] == "list";
  if (words.size() < 3) lines.damaged("a property must have a type and a name");
  Property property;
  if (isList) property.count = readType(words[2], lines);
  property.value = readType(words[isList ? 3 : 1], lines);
  property.name = words[isList ? 4 : 2];
  return property;
}

Element readElement(const MeshWords& words, const MeshLines& lines) {
  long count = 0;
  if (words.size() < 3 || !readMeshIndex(words[2], count))
    lines.damaged("an element must have a name and a number, from 0 to 2147483647");
  // assimp takes an unknown element's name for its count. If the name consists of digits, that count has no
  // bound.
  if (std::isdigit(static_cast<unsigned char>(words[1][0])))
    lines.refuse("the element '" + std::string(words[1]) +
                 "', expected a name that is no number, such as vertex");
  return {std::string(words[1]), static_cast<std::size_t>(count), {}};
}

// assimp takes the format from the second line. It ends an element at the first line that is not one of the
// element's properties.
Header readHeader(MeshLines& lines) {
  Header header;
  if (!lines.next() || wordsOf(lines.text()) != MeshWords{"ply"}) lines.refuse("expected the line 'ply'");
  for (std::string last = "ply";;) {
    if (!lines.next()) lines.damaged("ends within its header");
    const MeshWords words = wordsOf(lines.text());
    const std::string word(words.empty() ? std::string_view() : words[0]);
    if (word == "end_header") return header;
    if ((word == "format") != (last == "ply") || (word == "format" && words.size() < 2))
      lines.refuse("expected the format in the line after 'ply' and nowhere else");
    if (word == "property" && last != "element" && last != "property")
      lines.refuse("a property is not read after '" + last +
                   "', only after its element and the other properties of that; move the line");
    if (word == "format")
      header.encoding = readEncoding(words[1], lines);
    else if (word == "element")
      header.elements.push_back(readElement(words, lines));
    else if (word == "property")
      header.elements.back().properties.push_back(readProperty(words, lines));
    else if (word != "comment" && word != "obj_info")
      lines.refuse("got '" + word + "' in the header, expected 'element', 'property' or 'end_header'");
    last = word;
  }
}

// assimp uses 0 for a coordinate that it does not find. It leaves out faces whose vertices it does not find,
// all but the last of several elements or properties with the same name, and all triangles of a strip but the
// first.
void checkPropertyNames(const Header& header, const std::string& name) {
  const auto require = [&](const Element& element, bool isList, std::initializer_list<const char*> names) {
    const auto fits = [&](const Property& property) {
      return (property.count.bytes != 0) == isList &&
             std::find(names.begin(), names.end(), property.name) != names.end();
    };
    const auto found = std::count_if(element.properties.begin(), element.properties.end(), fits);
    if (element.count > 0 && found != 1)
      throw Error(name + ": the element '" + element.name + "' has " +
                  (found == 0 ? "no " : "more than one ") + (isList ? "list" : "property") + " '" +
                  *names.begin() + "'; export the mesh again");
  };
  std::set<std::string> seen;
  for (const Element& element : header.elements) {
    if (!seen.insert(element.name).second)
      throw Error(name + ": has two elements '" + element.name +
                  "', of which one is read; export the mesh again");
    if (element.count > 0 && element.name == "tristrips")
      throw Error(name +
                  ": the element 'tristrips' is not read whole; export the mesh with triangles as faces");
    if (element.count > 0 && element.properties.empty())
      throw Error(name + ": the element '" + element.name + "' has no properties; export the mesh again");
    if (element.name == "vertex")
      for (const char* coordinate : {"x", "y", "z"}) require(element, false, {coordinate});
    if (element.name == "face") require(element, true, {"vertex_indices", "vertex_index"});
  }
}

constexpr char kMore[] = "holds more than the elements that the header promises";

class PlyBody {
 public:
  PlyBody(std::string_view bytes, Encoding encoding, const std::string& name)
      : bytes_(bytes), big_(encoding == Encoding::bigEndian), name_(name) {}

  void pass(const Element& element) {
    for (std::size_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        const std::size_t values = property.count.bytes == 0 ? 1 : number(property.count.bytes, element);
        skip(values * property.value.bytes, element);
      }
    }
  }

  void end() const {
    if (bytes_.find_first_not_of(std::string_view(" \t\r\n\0", 5)) != std::string_view::npos)
      throw Error(name_ + ": " + kMore);
  }

 private:
  void skip(std::size_t count, const Element& element) {
    if (count > bytes_.size()) {
      throw Error(name_ + ": ends within its elements '" + element.name + "', of which the header promises " +
                  std::to_string(element.count));
    }
    bytes_.remove_prefix(count);
  }

  std::size_t number(std::size_t size, const Element& element) {
    const std::string_view all = bytes_;
    skip(size, element);
    std::size_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      value = value << 8 | static_cast<unsigned char>(all[big_ ? i : size - 1 - i]);
    // An absurd count fails in skip(). The limit keeps its product with the values' size from overflowing.
    return std::min(value, std::numeric_limits<std::size_t>::max() / 16);
  }

  std::string_view bytes_;
  bool big_;
  const std::string& name_;
};

// assimp reads a number that does not fit its type as another number, or as two.
bool isWhole(std::string_view word, const PlyType& type) {
  long value = 0;
  const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
  return result.ec == std::errc() && result.ptr == word.data() + word.size() && value >= type.least &&
         value <= type.most;
}

/// The elements of a text PLY. assimp reads each line as one element, even if it is invalid.
class PlyLines {
 public:
  explicit PlyLines(MeshLines& lines) : lines_(lines) {}

  void pass(const Element& element) {
    for (std::size_t i = 0; i < element.count; ++i) {
      nextLine(element);
      for (const Property& property : element.properties) {
        long values = 1;
        if (property.count.bytes != 0 && !readMeshIndex(word(element), values))
          refuse(element, "the number of values in a list");
        for (long k = 0; k < values; ++k) passValue(element, property);
      }
      if (at_ < words_.size())
        lines_.damaged("the line holds more than one element '" + element.name +
                       "', expected a line for each");
    }
  }

  void end() {
    while (lines_.next())
      if (!wordsOf(lines_.text()).empty()) lines_.damaged(kMore);
  }

 private:
  // assimp skips one empty line.
  void nextLine(const Element& element) {
    bool more = lines_.next();
    if (more && lines_.text().empty() && lines_.end() == "\n") more = lines_.next();
    if (!more)
      lines_.damaged("ends within its elements '" + element.name + "', of which the header promises " +
                     std::to_string(element.count));
    words_ = wordsOf(lines_.text());
    at_ = 0;
  }

  std::string_view word(const Element& element) {
    if (at_ == words_.size())
      lines_.damaged("the line holds less than one element '" + element.name + "', expected a line for each");
    return words_[at_++];
  }

  void passValue(const Element& element, const Property& property) {
    const std::string_view value = word(element);
    const PlyType& type = property.value;
    if (type.isWhole ? !isWhole(value, type) : !isMeshNumber(value))
      refuse(element, type.isWhole ? "a whole number from " + std::to_string(type.least) + " to " +
                                         std::to_string(type.most) + ", as the header says"
                                   : std::string("a finite number, ") + kNumberForm);
  }

  [[noreturn]] void refuse(const Element& element, const std::string& expected) const {
    lines_.damaged("got '" + std::string(words_[at_ - 1]) + "' for a value of the element '" + element.name +
                   "', expected " + expected);
  }

  MeshLines& lines_;
  MeshWords words_;
  std::size_t at_ = 0;  // index of the next word
};

}  // namespace

void checkPly(std::string_view text, const std::string& name) {
  MeshLines lines(text, name);
  const Header header = readHeader(lines);
  checkPropertyNames(header, name);
  if (header.encoding == Encoding::text) {
    refuseNul(text, name);
    PlyLines body(lines);
    for (const Element& element : header.elements) body.pass(element);
    body.end();
  } else {
    if (lines.end() == "\r") lines.refuse("the line must end by a line feed before values in binary");
    // assimp skips all line feeds after this one, and would then read the values from other bytes.
    if (lines.end() == "\n" && lines.rest().substr(0, 1) == "\n")
      lines.refuse(
          "the values in binary begin with a byte that is not read right, 10 as of a line feed; export the "
          "mesh as text, or another format");
    PlyBody body(lines.rest(), header.encoding, name);
    for (const Element& element : header.elements) body.pass(element);
    body.end();
  }
}

}  // namespace fcl_stpbv::detail
