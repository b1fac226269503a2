// XML from files that nobody vouches for: size, depth and entities are bounded before anything else reads it.
#pragma once

#include <tinyxml2.h>

#include <string>
#include <string_view>

namespace fcl_stpbv {

/// Parses `text` into `document`. Refused: more than 64 MB, NUL bytes, a document type (nothing in URDF needs
/// entities of its own), elements nested too deep, and xacro that was not expanded.
/// @throws Error "name:line: ..." saying what is wrong.
void parseXml(std::string_view text, const std::string& name, tinyxml2::XMLDocument& document);

/// Reads a file and parses it. @throws Error naming the file.
void loadXml(const std::string& path, tinyxml2::XMLDocument& document);

/// An attribute that must be there. @throws Error naming file, line, element and attribute.
std::string requiredAttribute(const tinyxml2::XMLElement& element, const char* attribute,
                              const std::string& name);

}  // namespace fcl_stpbv
