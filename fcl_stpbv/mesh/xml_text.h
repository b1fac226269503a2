// XML from untrusted files: size, depth, attributes and entities are checked before any other code reads it.
#pragma once

#include <tinyxml2.h>

#include <string>
#include <string_view>

namespace fcl_stpbv::detail {

/// Parses `text` into `document`. Not accepted are more than 64 MB, NUL bytes, a document type (URDF needs no
/// entities), elements nested too deeply, and xacro that was not expanded (elements of its namespace, and
/// `${...}` or `$(...)` in an attribute, except within `<gazebo>`, which is not used here).
/// @throws Error "name:line: ..." saying what is wrong.
void parseXml(std::string_view text, const std::string& name, tinyxml2::XMLDocument& document);

/// "name:line: " with the line where the element begins.
std::string xmlPlace(const tinyxml2::XMLElement& element, const std::string& name);

/// The text of a file, bounded in size as above. @throws Error naming the file.
std::string readXml(const std::string& path);

/// Reads a file and parses it. @throws Error naming the file.
void loadXml(const std::string& path, tinyxml2::XMLDocument& document);

/// The document's text. Line ends and tabs in attributes are written as character references, because other
/// readers replace the literal characters by spaces.
std::string printed(const tinyxml2::XMLDocument& document);

/// A required attribute. @throws Error naming file, line, element and attribute.
std::string requiredAttribute(const tinyxml2::XMLElement& element, const char* attribute,
                              const std::string& name);

}  // namespace fcl_stpbv::detail
