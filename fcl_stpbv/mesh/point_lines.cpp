// See point_lines.h.
#include "fcl_stpbv/mesh/point_lines.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/mesh/mesh_lines.h"

namespace fcl_stpbv::detail {
namespace {

MeshWords pointWords(std::string_view line) { return wordsOf(line.substr(0, line.find('#'))); }

}  // namespace

bool looksLikePointLines(std::string_view text) {
  const std::string name;
  MeshLines lines(text, name);
  while (lines.next()) {
    const MeshWords words = pointWords(lines.text());
    double ignored;
    if (!words.empty())
      return words.size() >= 3 && std::all_of(words.begin(), words.end(), [&](std::string_view word) {
               return readDecimal(word, ignored);
             });
  }
  return false;
}

std::vector<Eigen::Vector3d> parsePointLines(std::string_view text, const std::string& name) {
  refuseNul(text, name);
  std::vector<Eigen::Vector3d> points;
  MeshLines lines(text, name);
  while (lines.next()) {
    const MeshWords words = pointWords(lines.text());
    if (words.empty()) continue;
    if (words.size() == 1 && points.empty())
      lines.refuse(
          "got " + quoted(words[0]) +
          ", expected three coordinates; a count of points, and a comment after it as in chemistry's "
          "files, are not read: remove them");
    if (words.size() != 3)
      lines.refuse("got " + std::to_string(words.size()) + (words.size() == 1 ? " word" : " words") +
                   ", expected three coordinates with blanks between");
    Eigen::Vector3d& point = points.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      if (double& value = point[static_cast<Eigen::Index>(k)];
          !readDecimal(words[k], value) || !std::isfinite(value))
        lines.refuse("got " + quoted(words[k]) + ", expected a coordinate, a finite number");
  }
  if (points.empty()) throw Error(name + ": holds no points, expected lines of three coordinates");
  return points;
}

}  // namespace fcl_stpbv::detail
