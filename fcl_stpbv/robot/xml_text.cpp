// See xml_text.h.
#include "fcl_stpbv/robot/xml_text.h"

#include <filesystem>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"

namespace fcl_stpbv {
namespace {

// Ten thousand links with inertia and meshes take about 10 MB.
constexpr std::size_t kMaxBytes = 64u << 20;

std::string at(const std::string& name, int line) { return name + ":" + std::to_string(line) + ": "; }

void refuseDocumentType(const tinyxml2::XMLDocument& document, const std::string& name) {
  for (const tinyxml2::XMLNode* node = document.FirstChild(); node; node = node->NextSibling()) {
    const tinyxml2::XMLUnknown* unknown = node->ToUnknown();
    if (unknown && std::string_view(unknown->Value()).substr(0, 7) == "DOCTYPE") {
      throw Error(at(name, node->GetLineNum()) +
                  "a document type with its own entities is not read; remove <!DOCTYPE ...> and write the "
                  "entities out");
    }
  }
}

}  // namespace

void parseXml(std::string_view text, const std::string& name, tinyxml2::XMLDocument& document) {
  if (text.size() > kMaxBytes) throw Error(name + ": larger than 64 MB, which no robot description needs");
  if (text.find('\0') != std::string_view::npos)
    throw Error(name + ": holds NUL bytes; expected a text in XML");
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    const bool deep = document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED;
    throw Error(at(name, document.ErrorLineNum()) +
                (deep ? "elements nested deeper than any robot description needs"
                      : std::string("not XML (") + tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()) +
                            "); expected a whole XML file"));
  }
  refuseDocumentType(document, name);
  const tinyxml2::XMLElement* root = document.RootElement();
  if (!root) throw Error(name + ": holds no XML element");
  if (text.find("<xacro:") != std::string_view::npos)
    throw Error(name + ": is xacro, not plain XML; run 'xacro " + name + " > robot.urdf' first");
}

void loadXml(const std::string& path, tinyxml2::XMLDocument& document) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw Error(path + ": is a folder, expected a file");
  if (!std::filesystem::exists(path, ignored)) throw Error(path + ": no such file");
  if (std::filesystem::is_regular_file(path, ignored) &&
      std::filesystem::file_size(path, ignored) > kMaxBytes)
    throw Error(path + ": larger than 64 MB, which no robot description needs");
  parseXml(readText(path), path, document);
}

std::string requiredAttribute(const tinyxml2::XMLElement& element, const char* attribute,
                              const std::string& name) {
  const char* value = element.Attribute(attribute);
  if (!value || !*value) {
    throw Error(at(name, element.GetLineNum()) + "<" + element.Name() + "> has no '" + attribute +
                "'; give it one");
  }
  return value;
}

}  // namespace fcl_stpbv
