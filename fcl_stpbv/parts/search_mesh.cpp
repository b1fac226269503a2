// Groups the triangles of a mesh, and replaces many triangles by few.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/part_search.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// Of the corners in each cell of a grid, the one farthest from the middle replaces all.
TriangleSoup coarser(const TriangleSoup& soup, const Vector3d& middle, double grid) {
  std::map<std::array<long, 3>, int> farthest;
  std::vector<int> stands;  // for each corner, an index into the soup's points
  const auto cellOf = [&](const Vector3d& p) {
    return std::array<long, 3>{std::lround(p.x() / grid), std::lround(p.y() / grid),
                               std::lround(p.z() / grid)};
  };
  const auto out = [&](int i) { return (soup.points[at(i)] - middle).squaredNorm(); };
  for (std::size_t i = 0; i < soup.points.size(); ++i) {
    const int corner = static_cast<int>(i);
    const auto [place, isNew] = farthest.try_emplace(cellOf(soup.points[i]), corner);
    if (!isNew && out(corner) > out(place->second)) place->second = corner;
  }
  TriangleSoup coarse;
  std::map<int, int> number;
  std::set<std::array<int, 3>> known;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const int corner = farthest.at(cellOf(soup.points[at(soup.triangles[t][k])]));
      const auto [place, isNew] = number.try_emplace(corner, static_cast<int>(coarse.points.size()));
      if (isNew) coarse.points.push_back(soup.points[at(corner)]);
      triangle[k] = place->second;
    }
    std::array<int, 3> sorted = triangle;
    std::sort(sorted.begin(), sorted.end());
    if (sorted[0] == sorted[1] || sorted[1] == sorted[2] || !known.insert(sorted).second) continue;
    coarse.triangles.push_back(triangle);
    coarse.facet.push_back(soup.facet[t]);
  }
  return coarse;
}

}  // namespace

std::vector<TriangleSoup> meshGroups(const MeshSolid& mesh, const std::vector<int>& facetOf, bool each) {
  const MeshPieces& all = mesh.pieces();
  std::vector<TriangleSoup> soups(each ? at(all.pieces()) : 1);
  std::vector<std::map<int, int>> number(soups.size());
  for (std::size_t t = 0; t < all.triangles.size(); ++t) {
    const std::size_t g = each ? at(all.piece[t]) : 0;
    std::array<int, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const int v = all.triangles[t][k];
      const auto [place, isNew] = number[g].try_emplace(v, static_cast<int>(soups[g].points.size()));
      if (isNew) soups[g].points.push_back(all.vertices[at(v)]);
      triangle[k] = place->second;
    }
    soups[g].triangles.push_back(triangle);
    soups[g].facet.push_back(facetOf[t]);
  }
  return soups;
}

TriangleSoup forSearch(const TriangleSoup& soup, const PartSpace& space) {
  TriangleSoup few = soup;
  const Vector3d middle = 0.5 * (space.mesh.low() + space.mesh.high());
  double grid = space.size / 150;
  while (few.triangles.size() > kSearched) {
    TriangleSoup coarse = coarser(soup, middle, grid);
    if (coarse.triangles.empty()) break;  // all triangles became slivers
    few = std::move(coarse);
    grid *= few.triangles.size() > 20 * kSearched ? 2.0 : 1.3;
  }
  return few;
}

}  // namespace fcl_stpbv::detail
