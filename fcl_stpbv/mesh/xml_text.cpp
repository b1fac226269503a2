// Parses untrusted XML: bounds size, depth and number of attributes; refuses document types, NUL bytes,
// control characters and xacro. Also prints XML.
#include "fcl_stpbv/mesh/xml_text.h"

#include <algorithm>
#include <string>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"

namespace fcl_stpbv::detail {
namespace {

// Ten thousand links with inertia and meshes take about 10 MB.
constexpr std::size_t kMaxBytes = 64u << 20;

std::string atLine(const std::string& name, int line) { return name + ":" + std::to_string(line) + ": "; }

void refuseDocumentType(const tinyxml2::XMLDocument& document, const std::string& name) {
  for (const tinyxml2::XMLNode* node = document.FirstChild(); node; node = node->NextSibling()) {
    const tinyxml2::XMLUnknown* unknown = node->ToUnknown();
    if (unknown && std::string_view(unknown->Value()).substr(0, 7) == "DOCTYPE") {
      throw Error(atLine(name, node->GetLineNum()) +
                  "a document type with its own entities is not read; remove <!DOCTYPE ...> and write the "
                  "entities out");
    }
  }
}

// Parsers search for a repeated name among all attributes that an element has so far, so a million bytes of
// attributes take a minute. This counts the quoted values in each tag. Text that is no tag, such as a
// comment, is not counted.
void refuseManyAttributes(std::string_view text, const std::string& name) {
  constexpr long kMost = 1000;
  const auto skipTo = [&](std::size_t from, std::string_view end) {
    return std::min(text.find(end, from), text.size());
  };
  for (std::size_t i = text.find('<'); i < text.size(); i = std::min(text.find('<', i), text.size())) {
    const std::string_view rest = text.substr(i);
    if (rest.substr(0, 4) == "<!--") {
      i = skipTo(i + 4, "-->");
    } else if (rest.substr(0, 9) == "<![CDATA[") {
      i = skipTo(i + 9, "]]>");
    } else {
      const std::size_t start = i;
      long quoted = 0;
      for (; i < text.size() && text[i] != '>'; ++i) {
        if (text[i] != '"' && text[i] != '\'') continue;
        i = skipTo(i + 1, text.substr(i, 1));
        if (++quoted > kMost)
          throw Error(
              atLine(name, 1 + static_cast<int>(std::count(
                                   text.begin(), text.begin() + static_cast<std::ptrdiff_t>(start), '\n'))) +
              "an element of more than " + std::to_string(kMost) +
              " attributes, which no robot description needs");
      }
    }
  }
}

bool isXacro(const tinyxml2::XMLElement& element, std::vector<std::string>& prefixes) {
  bool found = false;
  for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a; a = a->Next()) {
    const std::string_view attribute = a->Name(), value = a->Value();
    if (attribute.substr(0, 6) == "xmlns:") {
      if (value.find("xacro") != std::string_view::npos)
        prefixes.push_back(std::string(attribute.substr(6)) + ":");
      continue;
    }
    found = found || value.find("${") != std::string_view::npos || value.find("$(") != std::string_view::npos;
  }
  const std::string_view name = element.Name();
  return found || std::any_of(prefixes.begin(), prefixes.end(), [&](const std::string& prefix) {
           return name.substr(0, prefix.size()) == prefix;
         });
}

void refuseXacro(const tinyxml2::XMLElement& root, const std::string& name) {
  std::vector<std::string> prefixes{"xacro:"};
  std::vector<const tinyxml2::XMLElement*> open{&root};
  while (!open.empty()) {
    const tinyxml2::XMLElement& at = *open.back();
    open.pop_back();
    if (isXacro(at, prefixes))
      throw Error(xmlPlace(at, name) + "<" + at.Name() + "> is xacro, not plain XML; run 'xacro " + name +
                  " > robot.urdf' first");
    for (const tinyxml2::XMLElement* e = at.LastChildElement(); e; e = e->PreviousSiblingElement())
      if (std::string_view(e->Name()) != "gazebo") open.push_back(e);
  }
}

// XML has no control characters except blanks, but tinyxml2 makes them from "&#x1;". A name with one would go
// into the files that are written, and strict readers refuse those.
void refuseControls(const tinyxml2::XMLElement& root, const std::string& name) {
  const auto isControl = [](char c) {
    return static_cast<unsigned char>(c) < ' ' && c != '\t' && c != '\n' && c != '\r';
  };
  std::vector<const tinyxml2::XMLElement*> open{&root};
  while (!open.empty()) {
    const tinyxml2::XMLElement& at = *open.back();
    open.pop_back();
    for (const tinyxml2::XMLAttribute* a = at.FirstAttribute(); a; a = a->Next()) {
      const std::string_view value = a->Value();
      if (std::any_of(value.begin(), value.end(), isControl))
        throw Error(xmlPlace(at, name) + "the '" + a->Name() + "' of <" + at.Name() + ">, " + quoted(value) +
                    ", has a control character, which XML does not allow; write it without");
    }
    for (const tinyxml2::XMLElement* e = at.LastChildElement(); e; e = e->PreviousSiblingElement())
      open.push_back(e);
  }
}

/// The printer that printed() uses.
class AttributePrinter : public tinyxml2::XMLPrinter {
 public:
  using XMLPrinter::VisitEnter;
  bool VisitEnter(const tinyxml2::XMLElement& element, const tinyxml2::XMLAttribute* attributes) override {
    inTag_ = true;
    const bool goesOn = XMLPrinter::VisitEnter(element, attributes);
    inTag_ = false;
    return goesOn;
  }

 protected:
  void Write(const char* data, std::size_t size) override {
    if (!inTag_) return XMLPrinter::Write(data, size);
    for (const char c : std::string_view(data, size)) {
      const bool kept = c != '\n' && c != '\r' && c != '\t';
      const std::string text = kept ? std::string(1, c) : "&#" + std::to_string(static_cast<int>(c)) + ";";
      XMLPrinter::Write(text.data(), text.size());
    }
  }

 private:
  bool inTag_ = false;
};

}  // namespace

void parseXml(std::string_view text, const std::string& name, tinyxml2::XMLDocument& document) {
  if (text.size() > kMaxBytes) throw Error(name + ": larger than 64 MB, which no robot description needs");
  if (text.find('\0') != std::string_view::npos)
    throw Error(name + ": holds NUL bytes; expected a text in XML, in UTF-8 and not in UTF-16");
  refuseManyAttributes(text, name);
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    const bool deep = document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED;
    throw Error(atLine(name, document.ErrorLineNum()) +
                (deep ? "elements nested deeper than any robot description needs"
                      : std::string("not XML (") + tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()) +
                            "); expected a whole XML file"));
  }
  refuseDocumentType(document, name);
  const tinyxml2::XMLElement* root = document.RootElement();
  if (!root) throw Error(name + ": holds no XML element");
  if (const tinyxml2::XMLElement* second = root->NextSiblingElement())
    throw Error(xmlPlace(*second, name) + "<" + second->Name() +
                "> follows the root element, of which XML has one; give each a file of its own");
  refuseXacro(*root, name);
  refuseControls(*root, name);
}

std::string xmlPlace(const tinyxml2::XMLElement& element, const std::string& name) {
  return atLine(name, element.GetLineNum());
}

std::string readXml(const std::string& path) { return readText(path, kMaxBytes); }

void loadXml(const std::string& path, tinyxml2::XMLDocument& document) {
  parseXml(readXml(path), path, document);
}

std::string printed(const tinyxml2::XMLDocument& document) {
  AttributePrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

std::string requiredAttribute(const tinyxml2::XMLElement& element, const char* attribute,
                              const std::string& name) {
  const char* value = element.Attribute(attribute);
  if (!value || !*value) {
    throw Error(atLine(name, element.GetLineNum()) + "<" + element.Name() + "> has no '" + attribute +
                "'; give it one");
  }
  return value;
}

}  // namespace fcl_stpbv::detail
