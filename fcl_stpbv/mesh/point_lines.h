// Reads a cloud of points as a text with one point a line.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace fcl_stpbv::detail {

/// Whether the first line that is neither empty nor a comment has three numbers or more.
bool looksLikePointLines(std::string_view text);

/// The points of a text whose lines have three coordinates each. The rest of a line after '#' is a comment.
/// @throws Error "name:line: ..." for any other line, and for a text without points.
std::vector<Eigen::Vector3d> parsePointLines(std::string_view text, const std::string& name);

}  // namespace fcl_stpbv::detail
