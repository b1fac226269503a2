// Reader of qhull's text: a header of counts decides between a polyhedron (points, facets) and a point file.
// Points are kept. Facets are only checked, to notice a file that was cut off.
#include <algorithm>
#include <cctype>
#include <limits>

#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/io/volume_files.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

constexpr std::size_t kPointBytes = 6;  // "0 0 0\n"
constexpr std::size_t kFacetBytes = 8;  // "3 0 1 2\n"
constexpr std::size_t kIndexBytes = 2;
constexpr long kMostDimension = 1000;  // anything larger is no dimension but a damaged number

// Cuts the first line that contains any words from the front of `text`, and returns its words.
std::vector<std::string_view> takeLine(std::string_view& text) {
  std::vector<std::string_view> words;
  while (!text.empty() && words.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    constexpr std::string_view kBlanks = " \t\r\v\f";
    for (;;) {
      line.remove_prefix(std::min(line.size(), line.find_first_not_of(kBlanks)));
      if (line.empty()) break;
      words.push_back(line.substr(0, line.find_first_of(kBlanks)));
      line.remove_prefix(words.back().size());
    }
  }
  return words;
}

bool isWhole(std::string_view word) {
  return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
}

// How many numbers are on the line of counts: 3 for a polyhedron, 1 for a plain point file, 0 for neither.
std::size_t countsOnSecondLine(std::string_view text) {
  // qhull's input may have a comment after the dimension. A number there makes the line a point's.
  const std::vector<std::string_view> first = takeLine(text);
  double ignored;
  const bool dimension =
      !first.empty() && isWhole(first[0]) &&
      (first.size() == 1 || !(isWhole(first[1].substr(0, 1)) || readDecimal(first[1], ignored)));
  const std::vector<std::string_view> second = takeLine(text);
  const bool counts = std::all_of(second.begin(), second.end(), isWhole);
  return dimension && counts && (second.size() == 1 || second.size() == 3) ? second.size() : 0;
}

void checkFacets(TextScanner& in, int facets, int points) {
  for (int facet = 0; facet < facets; ++facet) {
    const int corners = in.count("number of a facet's points", 3, kIndexBytes);
    for (int corner = 0; corner < corners; ++corner) in.integer("a facet's point", 0, points - 1L);
  }
}

}  // namespace

std::vector<Eigen::Vector3d> parseQhullPoints(std::string_view text, const std::string& name) {
  TextScanner in(text, name);
  const long dimension = in.integer("the dimension 3", 1, kMostDimension);
  if (dimension != 3) in.fail("points of dimension " + std::to_string(dimension) + ", expected 3");
  const std::size_t counts = countsOnSecondLine(text);
  if (counts == 0) {
    in.fail(
        "not a file of qhull's, expected the dimension and then a line with the number of points, "
        "or with the numbers of points, facets and ridges");
  }
  in.restOfLine();

  const int pointCount = in.count("number of points", 1, kPointBytes);
  const bool polyhedron = counts == 3;
  const int facetCount = polyhedron ? in.count("number of facets", 0, kFacetBytes) : 0;
  if (polyhedron) in.integer("the number of ridges", 0, std::numeric_limits<int>::max());

  std::vector<Eigen::Vector3d> points(static_cast<std::size_t>(pointCount));
  for (Eigen::Vector3d& point : points) point = in.vector("a point coordinate");
  if (polyhedron) {
    checkFacets(in, facetCount, pointCount);
  } else {
    in.end();
  }
  return points;
}

std::vector<Eigen::Vector3d> loadQhullPoints(const std::string& path) {
  return parseQhullPoints(readText(path), path);
}

bool looksLikeQhull(std::string_view text) { return countsOnSecondLine(text) != 0; }

}  // namespace fcl_stpbv
