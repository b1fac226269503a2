// Writes pairs into the text of an SRDF and leaves every other byte unchanged.
#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fcl_stpbv/mesh/mesh_lines.h"
#include "fcl_stpbv/mesh/xml_text.h"
#include "fcl_stpbv/robot/srdf.h"
#include "fcl_stpbv/robot/srdf_reason.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using tinyxml2::XMLElement;

bool isUtf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = [&](std::size_t k) {
      return static_cast<unsigned char>(k < text.size() ? text[k] : 0);
    };
    const int c = byte(i);
    const std::size_t length = c < 0x80 ? 1 : c >= 0xc2 && c < 0xe0 ? 2 : c >= 0xe0 && c < 0xf0 ? 3 : 4;
    if (length == 4 && (c < 0xf0 || c > 0xf4)) return false;
    for (std::size_t k = 1; k < length; ++k)
      if ((byte(i + k) & 0xc0) != 0x80) return false;
    i += length;
  }
  return true;
}

// If the URDF has another encoding, so have the names from it. A file that declares UTF-8 or no encoding
// would then be invalid XML to strict readers. So the file declares ISO-8859-1, in which each byte is a
// character.
std::string inItsEncoding(std::string text) {
  if (isUtf8(text)) return text;
  const bool declared = text.compare(0, 5, "<?xml") == 0;
  const std::size_t end = declared ? text.find("?>") + 2 : 0;
  const std::string value = inSmallLetters(text.substr(0, end));
  if (value.find("encoding") != std::string::npos && value.find("utf-8") == std::string::npos) return text;
  const std::string declaration = "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>";
  return text.replace(0, end, declared ? declaration : declaration + "\n");
}

struct Place {
  std::size_t begin, end;
};

// The places of the root's child elements, and of its end tag, in a text that tinyxml2 has parsed.
struct RootPlaces {
  std::vector<Place> children;
  Place end{0, 0};  // for a root without content, <robot/>, its last two characters
};

RootPlaces placesIn(std::string_view text) {
  RootPlaces places;
  int depth = 0;
  const auto after = [&](std::size_t from, std::string_view end) {
    return std::min(text.find(end, from), text.size() - end.size()) + end.size();
  };
  for (std::size_t i = text.find('<'), end = 0; i != std::string_view::npos; i = text.find('<', end)) {
    const std::string_view rest = text.substr(i);
    if (rest.substr(0, 4) == "<!--") {
      end = after(i + 4, "-->");
    } else if (rest.substr(0, 9) == "<![CDATA[") {
      end = after(i + 9, "]]>");
    } else if (rest.substr(0, 2) == "<?") {
      end = after(i, "?>");
    } else if (rest.substr(0, 2) == "<!") {
      end = after(i, ">");
    } else if (rest.substr(0, 2) == "</") {
      end = after(i, ">");
      --depth;
      if (depth == 1) places.children.back().end = end;
      if (depth == 0) places.end = {i, end};
    } else {
      for (end = i; end < text.size() && text[end] != '>'; ++end)
        if (text[end] == '"' || text[end] == '\'') end = text.find(text[end], end + 1);
      ++end;
      const bool closed = text[end - 2] == '/';
      if (depth == 1) places.children.push_back({i, end});
      if (depth == 0 && closed) places.end = {end - 2, end};
      depth += closed ? 0 : 1;
    }
  }
  return places;
}

// The beginning of the line in which `at` is, if only blanks are before it; else `at`.
std::size_t lineBegin(const std::string& text, std::size_t at) {
  std::size_t begin = at;
  while (begin > 0 && (text[begin - 1] == ' ' || text[begin - 1] == '\t')) --begin;
  return begin > 0 && text[begin - 1] == '\n' ? begin : at;
}

// Removes an element, and its line if there is nothing else in it.
void erase(std::string& text, const Place& place) {
  const std::size_t begin = lineBegin(text, place.begin);
  std::size_t end = place.end;
  while (end < text.size() && (text[end] == ' ' || text[end] == '\t' || text[end] == '\r')) ++end;
  const bool alone = end < text.size() && text[end] == '\n' && begin > 0 && text[begin - 1] == '\n';
  text.erase(alone ? begin : place.begin, alone ? end + 1 - begin : place.end - place.begin);
}

// A line for the SRDF. tinyxml2 ends an element's line, but not a comment's.
std::string lineOf(tinyxml2::XMLDocument& document, tinyxml2::XMLNode* node) {
  document.InsertEndChild(node);
  const std::string line = "    " + printed(document);
  return line.back() == '\n' ? line : line + "\n";
}

using Names = std::pair<std::string, std::string>;  // in ascending order

bool namesLinks(const XMLElement& e) { return e.Attribute("link1") && e.Attribute("link2"); }
Names namesIn(const XMLElement& e) {
  return std::minmax<std::string>(e.Attribute("link1"), e.Attribute("link2"));
}

// The text with the tools' own entries removed. `taken` receives the pairs that need no entry: those that the
// user's entries leave out, and those that the file enables, because in other readers a disabled pair
// overrides an enabled one. An entry that the robot's reader ignored (for a link of another variant of the
// robot) is the user's.
std::string withoutFound(const Srdf& srdf, bool wasRead, std::set<Names>& taken,
                         std::set<std::string>& comments) {
  tinyxml2::XMLDocument document;
  parseXml(srdf.text, srdf.path, document);
  std::set<Names> read;
  for (const Srdf::Pair& pair : srdf.disabled) read.insert(std::minmax(pair.link1, pair.link2));
  const std::vector<Place> places = placesIn(srdf.text).children;
  std::vector<Place> found;
  std::size_t i = 0;
  for (const XMLElement* e = document.RootElement()->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const Place& place = places[i++];
    const std::string_view name = e->Name();
    const bool disables = name == "disable_collisions";
    const char* reason = e->Attribute("reason");
    if (disables && reason && usualReason(reason) != "User" &&
        (!wasRead || !namesLinks(*e) || read.count(namesIn(*e)) > 0))
      found.push_back(place);
    else if ((disables || name == "enable_collisions") && namesLinks(*e))
      taken.insert(namesIn(*e));
  }
  for (const tinyxml2::XMLNode* n = document.RootElement()->FirstChild(); n; n = n->NextSibling())
    if (n->ToComment()) comments.insert(n->Value());
  std::string text = srdf.text;
  for (auto place = found.rbegin(); place != found.rend(); ++place) erase(text, *place);
  return text;
}

std::string written(const Srdf* srdf, bool wasRead, const std::string& robotName,
                    const std::vector<Srdf::Pair>& pairs, const std::vector<std::string>& comments) {
  std::set<Names> taken;
  std::set<std::string> known;
  std::string text;
  tinyxml2::XMLDocument document;
  if (srdf) {
    text = withoutFound(*srdf, wasRead, taken, known);
  } else {
    document.InsertEndChild(document.NewDeclaration());
    XMLElement* root = document.NewElement("robot");
    root->SetAttribute("name", robotName.c_str());
    document.InsertEndChild(root);
    text = printed(document);
  }
  std::string lines;
  for (std::string comment : comments) {
    comment = " " + comment + " ";
    for (std::size_t at; (at = comment.find("--")) != std::string::npos;)
      comment[at] = '~';  // "--" would end the comment
    tinyxml2::XMLDocument line;
    if (known.count(comment) == 0) lines += lineOf(line, line.NewComment(comment.c_str()));
  }
  for (const Srdf::Pair& pair : pairs) {
    if (!taken.insert(std::minmax(pair.link1, pair.link2)).second) continue;
    tinyxml2::XMLDocument line;
    XMLElement* e = line.NewElement("disable_collisions");
    e->SetAttribute("link1", pair.link1.c_str());
    e->SetAttribute("link2", pair.link2.c_str());
    e->SetAttribute("reason", pair.reason.c_str());
    lines += lineOf(line, e);
  }
  if (text.find("\r\n") != std::string::npos)
    for (std::size_t i = lines.find('\n'); i != std::string::npos; i = lines.find('\n', i + 2))
      lines.insert(i, 1, '\r');
  if (lines.empty()) return inItsEncoding(text);
  const Place end = placesIn(text).end;
  if (text[end.begin] == '/') {
    text.replace(end.begin, 2, ">\n" + lines + "</robot>");
  } else {
    const std::size_t at = lineBegin(text, end.begin);
    text.insert(at, at > 0 && text[at - 1] == '\n' ? lines : "\n" + lines);
  }
  return inItsEncoding(text);
}

}  // namespace

std::string withPairs(const std::string& path, const std::string& robotName,
                      const std::vector<Srdf::Pair>& pairs, const std::vector<std::string>& comments) {
  Srdf srdf;
  srdf.path = path;
  if (!path.empty()) srdf.text = readXml(path);
  return written(path.empty() ? nullptr : &srdf, false, robotName, pairs, comments);
}

std::string withPairs(const Srdf* srdf, const std::string& robotName, const std::vector<Srdf::Pair>& pairs,
                      const std::vector<std::string>& comments) {
  return written(srdf, true, robotName, pairs, comments);
}

}  // namespace fcl_stpbv
