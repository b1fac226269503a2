// Checks a PLY file against its own header before assimp reads it: sizes, counts, the length of the data.
#include "fcl_stpbv/robot/ply_check.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"

namespace fcl_stpbv::detail {
namespace {

struct Property {
  std::size_t countBytes = 0;  // of a list's count, 0 for a single value
  std::size_t bytes = 0;
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

std::size_t sizeOf(TextScanner& in) {
  static const std::map<std::string_view, std::size_t> kSizes{
      {"char", 1},  {"uchar", 1},   {"int8", 1},   {"uint8", 1},  {"short", 2}, {"ushort", 2},
      {"int16", 2}, {"uint16", 2},  {"int", 4},    {"uint", 4},   {"int32", 4}, {"uint32", 4},
      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = kSizes.find(in.token("the type of a property"));
  if (found == kSizes.end()) in.fail("a property of unknown type, expected one of PLY's, such as float");
  return found->second;
}

Property readProperty(TextScanner& in) {
  TextScanner ahead = in;
  Property property;
  if (ahead.token("the type of a property") == "list") {
    in.token("list");
    property.countBytes = sizeOf(in);
  }
  property.bytes = sizeOf(in);
  in.token("the name of a property");
  return property;
}

Encoding readEncoding(TextScanner& in) {
  const std::string_view encoding = in.token("the encoding");
  if (encoding == "ascii") return Encoding::text;
  if (encoding == "binary_little_endian") return Encoding::littleEndian;
  if (encoding == "binary_big_endian") return Encoding::bigEndian;
  in.fail("an unknown encoding, expected ascii, binary_little_endian or binary_big_endian");
}

Header readHeader(TextScanner& in) {
  Header header;
  in.keyword("ply");
  for (;;) {
    const std::string_view word = in.token("the word 'end_header'");
    if (word == "end_header") break;
    if (word == "format") {
      header.encoding = readEncoding(in);
    } else if (word == "element") {
      const std::string name(in.token("the name of an element"));
      // assimp takes an unknown element's name for its count: of digits, it is one without a bound.
      if (std::isdigit(static_cast<unsigned char>(name[0])))
        in.fail("the element '" + name + "', expected a name that is no number, such as vertex");
      header.elements.push_back({name, static_cast<std::size_t>(in.count("number of elements", 0, 1)), {}});
    } else if (word == "property") {
      if (header.elements.empty()) in.fail("a property before the first element");
      header.elements.back().properties.push_back(readProperty(in));
    } else if (word != "comment" && word != "obj_info") {
      in.fail("an unknown word in the header, expected 'element', 'property' or 'end_header'");
    }
    in.restOfLine();
  }
  in.restOfLine();
  return header;
}

class PlyBody {
 public:
  PlyBody(std::string_view bytes, Encoding encoding, const std::string& name)
      : bytes_(bytes), big_(encoding == Encoding::bigEndian), name_(name) {}

  void pass(const Element& element) {
    for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i) {
      for (const Property& property : element.properties) {
        const std::size_t values = property.countBytes == 0 ? 1 : number(property.countBytes, element);
        skip(values * property.bytes, element);
      }
    }
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
    // A wild count fails in skip(); this keeps its product with the values' size from wrapping around.
    return std::min(value, std::numeric_limits<std::size_t>::max() / 16);
  }

  std::string_view bytes_;
  bool big_;
  const std::string& name_;
};

void passText(TextScanner& in, const Element& element) {
  const std::string what = "a value of the element '" + element.name + "'";
  for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i) {
    for (const Property& property : element.properties) {
      const int values = property.countBytes == 0 ? 1 : in.count("number of values in a list", 0, 1);
      for (int k = 0; k < values; ++k) in.number(what);
    }
  }
}

}  // namespace

void checkPly(std::string_view text, const std::string& name) {
  TextScanner in(text, name);
  const Header header = readHeader(in);
  if (header.encoding == Encoding::text) {
    for (const Element& element : header.elements) passText(in, element);
  } else {
    PlyBody body(text.substr(in.position()), header.encoding, name);
    for (const Element& element : header.elements) body.pass(element);
  }
}

}  // namespace fcl_stpbv::detail
