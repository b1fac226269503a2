// Clouds of points in qhull's text formats: polyhedra (`*-ch.txt`, `*.otp`) and plain point files.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace fcl_stpbv {

/// Reads the points of a file that qhull printed with `o f` (dimension, `points facets ridges`, points,
/// facets) or that it takes as input (dimension, number of points, points). Facets are checked, then left
/// aside: the volume is built from the points. What follows the facets is qhull's report and is not read.
/// @throws Error "file:line: got ..., expected ..." for a damaged file or another dimension than 3.
std::vector<Eigen::Vector3d> loadQhullPoints(const std::string& path);

/// The same from a text in memory; `name` stands for it in messages.
std::vector<Eigen::Vector3d> parseQhullPoints(std::string_view text, const std::string& name);

/// Whether a text begins like such a file: a line with the dimension, a line with one or three counts.
bool looksLikeQhull(std::string_view text);

}  // namespace fcl_stpbv
