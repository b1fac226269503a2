// Small robots as URDF texts.
#pragma once

#include <string>

#include "fcl_stpbv/robot/robot_model.h"
#include "test/reference/volume_files.h"

namespace fcl_stpbv::test {

inline std::string robot(const std::string& body) {
  return "<?xml version=\"1.0\"?>\n<robot name=\"small\">" + body + "</robot>";
}
inline std::string link(const std::string& name, const std::string& geometry = "") {
  return "<link name=\"" + name + "\">" +
         (geometry.empty() ? "" : "<collision><geometry>" + geometry + "</geometry></collision>") + "</link>";
}
inline std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                         const std::string& child, const std::string& more = "", int limit = 1) {
  const std::string most = std::to_string(limit);
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child + "\"/><limit lower=\"-" + most + "\" upper=\"" + most +
         "\" effort=\"1\" velocity=\"1\"/>" + more + "</joint>";
}

/// The message with which a robot's text is refused.
inline std::string refused(const std::string& text) {
  return refusal([](const std::string& t) { parseUrdf(t, "small.urdf"); }, text);
}

/// Number of <collision> elements in a text, counted without a parser.
inline int collisionsIn(const std::string& text) {
  int count = 0;
  const std::string tag = "<collision";
  for (std::size_t at = text.find(tag); at != std::string::npos; at = text.find(tag, at + 1)) {
    const char next = text[at + tag.size()];
    count += next == '>' || next == ' ' || next == '/';
  }
  return count;
}

}  // namespace fcl_stpbv::test
