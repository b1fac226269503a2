// Writes pairs into an SRDF and leaves everything else unchanged.
#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "fcl_stpbv/robot/mesh_lines.h"
#include "fcl_stpbv/robot/srdf.h"
#include "fcl_stpbv/robot/srdf_reason.h"
#include "fcl_stpbv/robot/xml_text.h"

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

// The document's text. If the URDF has another encoding, so have the names from it. A file that declares
// UTF-8 or no encoding would then be invalid XML to strict readers. So the file declares ISO-8859-1, in which
// each byte is a character.
std::string printedInItsEncoding(tinyxml2::XMLDocument& document) {
  const std::string text = printed(document);
  if (isUtf8(text)) return text;
  tinyxml2::XMLNode* first = document.FirstChild();
  tinyxml2::XMLDeclaration* said = first ? first->ToDeclaration() : nullptr;
  const std::string value = inSmallLetters(said ? said->Value() : "");
  if (value.find("encoding") != std::string::npos && value.find("utf-8") == std::string::npos) return text;
  if (said) document.DeleteChild(said);
  document.InsertFirstChild(document.NewDeclaration("xml version=\"1.0\" encoding=\"ISO-8859-1\""));
  return printed(document);
}

}  // namespace

std::string withPairs(const std::string& path, const std::string& robotName,
                      const std::vector<Srdf::Pair>& pairs, const std::vector<std::string>& comments) {
  Srdf srdf;
  srdf.path = path;
  if (!path.empty()) srdf.text = readXml(path);
  return withPairs(path.empty() ? nullptr : &srdf, robotName, pairs, comments);
}

std::string withPairs(const Srdf* srdf, const std::string& robotName, const std::vector<Srdf::Pair>& pairs,
                      const std::vector<std::string>& comments) {
  tinyxml2::XMLDocument document;
  if (srdf) {
    parseXml(srdf->text, srdf->path, document);
  } else {
    document.InsertEndChild(document.NewDeclaration());
    XMLElement* root = document.NewElement("robot");
    root->SetAttribute("name", robotName.c_str());
    document.InsertEndChild(root);
  }
  XMLElement* root = document.RootElement();
  for (XMLElement* e = root->FirstChildElement("disable_collisions"); e;) {
    XMLElement* next = e->NextSiblingElement("disable_collisions");
    const char* reason = e->Attribute("reason");
    if (reason && usualReason(reason) != "User") root->DeleteChild(e);
    e = next;
  }
  // In other readers a disabled pair overrides an enabled one. So pairs that the file enables are not
  // disabled.
  std::set<std::pair<std::string, std::string>> enabled;
  for (const XMLElement* e = root->FirstChildElement("enable_collisions"); e;
       e = e->NextSiblingElement("enable_collisions"))
    if (e->Attribute("link1") && e->Attribute("link2"))
      enabled.insert(std::minmax<std::string>(e->Attribute("link1"), e->Attribute("link2")));
  for (std::string comment : comments) {
    comment = " " + comment + " ";
    for (std::size_t at; (at = comment.find("--")) != std::string::npos;)
      comment[at] = '~';  // "--" would end the comment
    root->InsertEndChild(document.NewComment(comment.c_str()));
  }
  for (const Srdf::Pair& pair : pairs) {
    if (enabled.count(std::minmax(pair.link1, pair.link2))) continue;
    XMLElement* e = document.NewElement("disable_collisions");
    e->SetAttribute("link1", pair.link1.c_str());
    e->SetAttribute("link2", pair.link2.c_str());
    e->SetAttribute("reason", pair.reason.c_str());
    root->InsertEndChild(e);
  }
  return printedInItsEncoding(document);
}

}  // namespace fcl_stpbv
