// Convex parts of a mesh:
// 1. take the connected pieces (mesh_pieces.h) and make them coarser for the search;
// 2. search for few parts (part_search.h), by cutting and joining;
// 3. cut the whole mesh again by the same planes, and certify each hull's excess (mesh_excess.h).
#include "fcl_stpbv/parts/convex_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/parts/cut_planes.h"
#include "fcl_stpbv/parts/part_search.h"
#include "fcl_stpbv/volume/rolling_ball.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

constexpr int kStartPieces = 24;         // of a mesh that begins as one part a piece
constexpr std::size_t kSearched = 2500;  // triangles that the search looks at
constexpr double kHulls = 15000;         // what the search spends at effort 1

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// The mesh's triangles by group: one a piece, or all in one.
std::vector<TriangleSoup> groups(const MeshSolid& mesh, const std::vector<int>& facetOf, bool each) {
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

// Few triangles for the search: of the corners in each cell of a grid, the one farthest out stands for all.
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

TriangleSoup forSearch(const TriangleSoup& soup, const PartSpace& space) {
  TriangleSoup few = soup;
  const Vector3d middle = 0.5 * (space.mesh.low() + space.mesh.high());
  for (double grid = space.size / 150; few.triangles.size() > kSearched; grid *= 1.3) {
    TriangleSoup coarse = coarser(soup, middle, grid);
    if (coarse.triangles.empty()) break;  // nothing but slivers
    few = std::move(coarse);
  }
  return few;
}

// All corners of what the mesh has in a part's leaves, cut anew from the whole mesh.
std::vector<Vector3d> pointsIn(const Part& part, const std::vector<TriangleSoup>& groups,
                               const PartSpace& space) {
  std::vector<Vector3d> points;
  for (const auto& leaf : part.leaves) {
    TriangleSoup soup = groups[at(leaf->group)];
    for (const CutPlane& plane : leaf->path) soup = above(soup, plane, space.slack);
    points.insert(points.end(), soup.points.begin(), soup.points.end());
    points.insert(points.end(), leaf->corners.begin(), leaf->corners.end());
  }
  return points;
}

ConvexPart certified(const std::vector<Vector3d>& points, const MeshSolid& mesh) {
  ConvexPart out;
  for (const int v : rollBall(points).vertices) out.points.push_back(points[at(v)]);
  const std::vector<Triangle> surface = hullTriangles(out.points);
  out.excess = out.openExcess = excessOf(surface, mesh);
  ExcessOptions open;
  open.filled = false;
  if (mesh.pieces().closedPieces() > 0) out.openExcess = excessOf(surface, mesh, open);
  return out;
}

}  // namespace

ConvexParts convexParts(const TriangleMesh& input, const PartsOptions& options) {
  constexpr double kLargest = 1e6;  // m, and times the usual search: beyond either is a mistake
  requireNumber("convexParts: most", options.most, 1, kLargest);
  requireNumber("convexParts: excess", options.excess, 0, kLargest);
  requireNumber("convexParts: effort", options.effort, 1e-3, kLargest);
  const MeshSolid mesh(input);
  PartSpace space(mesh);
  std::vector<int> facetOf;
  space.facets = flatParts(mesh, space.slack, facetOf);
  const bool each = mesh.pieces().pieces() <= kStartPieces;
  PartSearch::Parts start;
  const Cell cell = mesh.pieces().closedPieces() > 0 ? Cell(mesh) : Cell();
  std::vector<TriangleSoup> soups = groups(mesh, facetOf, each);
  for (std::size_t g = 0; g < soups.size(); ++g) {
    auto leaf = std::make_shared<BspLeaf>();
    leaf->soup = forSearch(soups[g], space);
    leaf->cell = cell;
    leaf->group = static_cast<int>(g);
    start.push_back(std::make_shared<Part>(makePart({leaf}, space, {space.fine})));
  }
  PartSearch search(space, static_cast<long>(kHulls * options.effort));
  const PartSearch::Parts found = search.fewParts(start, options.most, options.excess);
  ConvexParts out;
  out.pieces = mesh.pieces().pieces();
  out.closedPieces = mesh.pieces().closedPieces();
  out.slack = 2 * space.slack;
  for (const PartPtr& part : found) {
    const std::vector<Vector3d> points = pointsIn(*part, soups, space);
    if (points.empty()) continue;  // a leaf of the coarse mesh alone
    out.parts.push_back(certified(points, mesh));
    out.excess = std::max(out.excess, out.parts.back().excess.upper);
    out.openExcess = std::max(out.openExcess, out.parts.back().openExcess.upper);
  }
  return out;
}

}  // namespace fcl_stpbv
