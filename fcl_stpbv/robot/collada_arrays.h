// The arrays of numbers and of indices in COLLADA's geometries, as assimp reads them.
#pragma once

#include <tinyxml2.h>

#include <string>
#include <string_view>
#include <vector>

#include "fcl_stpbv/words.h"

namespace fcl_stpbv::detail {

/// Refuses the file at an element that only its writer can mend. @throws Error "name:line: <element> ..."
[[noreturn]] void refuseCollada(const tinyxml2::XMLElement& element, const std::string& message,
                                const std::string& name);

/// The id that an attribute refers to as "#id". @throws Error where it has another form.
std::string colladaTarget(const tinyxml2::XMLElement& element, const char* attribute,
                          const std::string& name);

/// @throws Error for an attribute that is not among `known`.
void checkColladaAttributes(const tinyxml2::XMLElement& element, const Words& known, const std::string& name);

/// How many numbers the element's text has. @throws Error where one is no finite number, or where a comment
/// or another element divides the text: assimp reads its first part only.
std::size_t countNumbers(const tinyxml2::XMLElement& element, const std::string& name);

/// These numbers themselves.
std::vector<double> numbersOf(const tinyxml2::XMLElement& element, const std::string& name);

/// Checks the geometries of a document: each array holds what its readers take from it, positions have x, y
/// and z, no index is below 0.
void checkColladaGeometries(const tinyxml2::XMLElement& root, const std::string& name);

}  // namespace fcl_stpbv::detail
