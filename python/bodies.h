// Python's options for the volumes of a robot's links: r, R, links and flat. They mean the same
// as -r, -R, --link and --flat of the tools.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"
#include "parts.h"

namespace fcl_stpbv {

/// The options for the volumes of a robot and of its obstacles.
struct BodyOptions {
  using Length = std::variant<double, std::string>;  ///< m, or "auto"
  using OfLinks = std::map<std::string, std::vector<double>>;
  using Names = std::variant<std::string, std::vector<std::string>>;  ///< one name, or several

  Length r;
  std::optional<Length> R;  ///< no value: fitted if r is, else the R of GeometryOptions
  OfLinks links = {};       ///< r, R and, if given, the over-cover's budget of single links (m)
  Names flat = std::vector<std::string>{};  ///< links whose meshes stay convex polyhedra, and "obstacles"

  /// @throws Error naming the argument.
  GeometryOptions ofAll() const;  ///< r and R, without links and flat
  GeometryOptions ofRobot(bool obstacles) const;
  GeometryOptions ofObstacles() const;

 private:
  std::vector<std::string> flatNames() const;
};

}  // namespace fcl_stpbv
