// Attributes and texts of COLLADA's elements, read as assimp reads them.
#include "fcl_stpbv/mesh/collada_values.h"

#include <algorithm>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/mesh_lines.h"
#include "fcl_stpbv/mesh/xml_text.h"

namespace fcl_stpbv::detail {
namespace {

using tinyxml2::XMLElement;

constexpr const char* kIndex = "a whole number from 0";

// The line of the character `at` in a text. tinyxml2 gives the line of the text's first word.
int lineWithin(const tinyxml2::XMLText& text, std::size_t at) {
  const std::string_view value = text.Value();
  const std::size_t start = std::min(value.find_first_not_of(" \t\r\n"), at);
  return text.GetLineNum() +
         static_cast<int>(std::count(value.begin() + static_cast<std::ptrdiff_t>(start),
                                     value.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

std::size_t countWords(const XMLElement& element, bool (*good)(std::string_view), const std::string& expected,
                       const std::string& name) {
  const tinyxml2::XMLText* text = nullptr;
  for (const tinyxml2::XMLNode* node = element.FirstChild(); node != nullptr; node = node->NextSibling()) {
    if (node->ToText() == nullptr) continue;
    if (text != nullptr)
      throw Error(xmlPlace(element, name) + "<" + element.Name() +
                  "> is read only up to the comment or element amid its text; remove that");
    text = node->ToText();
  }
  if (text == nullptr) return 0;
  std::size_t count = 0;
  std::string_view rest = text->Value();
  for (std::string_view word = takeWord(rest); !word.empty(); word = takeWord(rest), ++count) {
    if (good(word)) continue;
    const std::size_t at = static_cast<std::size_t>(word.data() - text->Value());
    throw Error(name + ":" + std::to_string(lineWithin(*text, at)) + ": got '" + std::string(word) +
                "' in <" + element.Name() + ">, expected " + expected +
                "; the file is damaged, export it again");
  }
  return count;
}

}  // namespace

void refuseCollada(const XMLElement& element, const std::string& message, const std::string& name) {
  throw Error(xmlPlace(element, name) + "<" + element.Name() + "> " + message +
              "; the file is damaged, export it again");
}

std::string colladaTarget(const XMLElement& element, const char* attribute, const std::string& name) {
  const char* target = element.Attribute(attribute);
  if (target == nullptr || *target != '#') {
    throw Error(xmlPlace(element, name) + "<" + element.Name() + "> must have " + attribute +
                "=\"#...\", an element of this file; other files are not read");
  }
  return target + 1;
}

void checkColladaAttributes(const XMLElement& element, const Words& known, const std::string& name) {
  for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    if (holds(known, a->Name())) continue;
    std::string list;
    for (const std::string_view word : known) list += (list.empty() ? "" : ", ") + std::string(word);
    throw Error(xmlPlace(element, name) + "<" + element.Name() + "> has an attribute '" + a->Name() +
                "' that COLLADA does not know there; it knows " + list);
  }
}

std::size_t colladaWhole(const XMLElement& element, const char* attribute, std::size_t missing,
                         const std::string& name) {
  const char* text = element.Attribute(attribute);
  if (text == nullptr) return missing;
  long value = 0;
  std::string_view rest(text);
  if (!readMeshIndex(takeWord(rest), value) || !takeWord(rest).empty())
    refuseCollada(element, std::string("has ") + attribute + "=\"" + text + "\", expected " + kIndex, name);
  return static_cast<std::size_t>(value);
}

std::size_t countNumbers(const XMLElement& element, const std::string& name) {
  return countWords(element, isMeshNumber, std::string("a finite number, ") + kNumberForm, name);
}

std::size_t countIndices(const XMLElement& element, const std::string& name) {
  return countWords(element, isMeshIndex, kIndex, name);
}

std::vector<double> numbersOf(const XMLElement& element, const std::string& name) {
  std::vector<double> numbers(countNumbers(element, name));
  std::string_view rest;
  for (const tinyxml2::XMLNode* node = element.FirstChild(); node != nullptr; node = node->NextSibling())
    if (const tinyxml2::XMLText* text = node->ToText()) rest = text->Value();
  for (double& number : numbers) readMeshNumber(takeWord(rest), number);
  return numbers;
}

}  // namespace fcl_stpbv::detail
