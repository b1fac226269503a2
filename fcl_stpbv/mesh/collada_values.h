// Attributes and texts of COLLADA's elements.
#pragma once

#include <tinyxml2.h>

#include <string>
#include <vector>

#include "fcl_stpbv/words.h"

namespace fcl_stpbv::detail {

/// Throws for an element with a fault that only the author of the file can correct. @throws Error "name:line:
/// <element> ..."
[[noreturn]] void refuseCollada(const tinyxml2::XMLElement& element, const std::string& message,
                                const std::string& name);

/// The id that an attribute refers to as "#id". @throws Error if the attribute has another form.
std::string colladaTarget(const tinyxml2::XMLElement& element, const char* attribute,
                          const std::string& name);

/// @throws Error for an attribute that is not among `known`.
void checkColladaAttributes(const tinyxml2::XMLElement& element, const Words& known, const std::string& name);

/// The whole number in an attribute, or `missing` if there is no such attribute. @throws Error if it is not a
/// whole number from 0.
std::size_t colladaWhole(const tinyxml2::XMLElement& element, const char* attribute, std::size_t missing,
                         const std::string& name);

/// Number of numbers in the element's text. @throws Error if one of them is not a finite number, or if a
/// comment or another element divides the text, because then assimp reads only the first part.
std::size_t countNumbers(const tinyxml2::XMLElement& element, const std::string& name);

/// Number of indices in the element's text: whole numbers from 0. @throws Error as countNumbers() does.
std::size_t countIndices(const tinyxml2::XMLElement& element, const std::string& name);

/// The numbers that countNumbers() counts.
std::vector<double> numbersOf(const tinyxml2::XMLElement& element, const std::string& name);

}  // namespace fcl_stpbv::detail
