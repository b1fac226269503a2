// Convex parts of a mesh:
// 1. take the connected pieces (mesh_solid.h) and make them coarser for the search;
// 2. search for few parts (part_search.h), by cutting and joining;
// 3. cut the whole mesh again by the same planes;
// 4. make sure that the inside is covered too. Parts made of joined facets grow until it is
//    (fill_inside.cpp). For parts made by cuts it is proven (inside_proof.h), and a part gets those corners
//    of its cells that the proof needs. If these corners increase the excess, two more methods are tried:
//    parts that grow, and a search with all corners in the parts from the start. The best result is used;
// 5. certify each hull's excess (mesh_solid.h).
#include "fcl_stpbv/parts/convex_parts.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/inside_proof.h"
#include "fcl_stpbv/parts/part_cuts.h"
#include "fcl_stpbv/parts/part_search.h"
#include "fcl_stpbv/volume/rolling_ball.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

constexpr int kStartPieces = 24;  // for a mesh that starts with one part per piece
constexpr double kHulls = 12000;  // number of hulls that the search may make at effort 1

// The mesh's points in a leaf, cut anew from the whole mesh. A facet's points are those of the whole mesh
// already.
std::vector<Vector3d> pointsIn(const BspLeaf& leaf, const std::vector<TriangleSoup>& groups,
                               const PartSpace& space) {
  if (leaf.isFacet) return leaf.soup.points;
  TriangleSoup soup = groups[at(leaf.group)];
  for (const CutPlane& plane : leaf.path) soup = above(soup, plane, space.slack);
  return soup.points;
}

void append(std::vector<Vector3d>& all, const std::vector<Vector3d>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

// The points whose hull is a part.
struct PartPoints {
  std::vector<Vector3d> found;   // by the search: all points of triangles, and corners if it had them
  std::vector<Vector3d> needed;  // corners of its cells that the inside needs in addition
};

// The points of the parts as the search found them.
std::vector<PartPoints> pointsOf(const PartSearch::Parts& parts, const std::vector<TriangleSoup>& groups,
                                 const PartSpace& space) {
  std::vector<PartPoints> points;
  for (const PartPtr& part : parts) {
    points.emplace_back();
    for (const auto& leaf : part->leaves) {
      append(points.back().found, pointsIn(*leaf, groups, space));
      append(points.back().found, leaf->corners);
    }
  }
  return points;
}

// If the hulls do not cover the inside of the mesh in a leaf's cell, adds the cell's corners, so that they
// do.
void coverInside(const PartSearch::Parts& parts, const std::vector<TriangleSoup>& groups,
                 const PartSpace& space, std::vector<PartPoints>& points) {
  std::vector<HullPlanes> hulls;
  for (const PartPoints& one : points)
    hulls.push_back(one.found.empty() ? HullPlanes() : hullPlanes(one.found, 2 * space.slack));
  for (std::size_t p = 0; p < parts.size(); ++p) {
    std::vector<HullPlanes> ownFirst = hulls;
    std::swap(ownFirst[0], ownFirst[p]);
    for (const auto& leaf : parts[p]->leaves) {
      if (!leaf->corners.empty()) continue;  // the search had its corners
      Cell cell(space.mesh);
      for (const CutPlane& plane : leaf->path) cell = cell.above(plane, space.slack, &space.mesh);
      const std::vector<Vector3d> corners = cell.enclosedCorners();
      if (corners.empty()) continue;
      // With its corners, the leaf contains all of the solid in its cell, so the rest of the cell does not
      // matter.
      std::vector<Vector3d> whole = corners;
      append(whole, pointsIn(*leaf, groups, space));
      if (const HullPlanes around = hullPlanes(whole, 2 * space.slack); !isFlat(around))
        for (const CutPlane& plane : around) cell = cell.above(plane.turned(), space.slack);
      if (!isInsideCovered(cell, ownFirst, space.mesh, space.slack)) append(points[p].needed, corners);
    }
  }
}

ConvexPart certified(const std::vector<Vector3d>& points, const PartSpace& space) {
  const MeshSolid& mesh = space.mesh;
  ConvexPart out;
  for (const int v : convexHull(points).vertices) out.points.push_back(points[at(v)]);
  const std::vector<Triangle> surface = hullTriangles(out.points);
  ExcessOptions open;
  open.absolute = 0.04 * space.fine;
  open.queries = std::max(10000L, static_cast<long>(1e6 / space.costly));
  out.excess = out.openExcess = excessOf(surface, mesh, open);
  open.filled = false;
  if (mesh.hasInside()) out.openExcess = excessOf(surface, mesh, open);
  return out;
}

struct Certified {
  ConvexParts parts;
  bool asFound = true;  // whether no part became farther from the mesh by added corners
};

Certified certified(std::vector<PartPoints> points, const PartSpace& space) {
  Certified out;
  for (PartPoints& one : points) {
    ConvexPart part;  // stays without points if only the coarse mesh has triangles in its cells
    if (!one.found.empty()) part = certified(one.found, space);
    if (!one.needed.empty()) {
      const double before = part.excess.upper;
      append(one.found, one.needed);
      part = certified(one.found, space);
      out.asFound = out.asFound && part.excess.upper <= before + 0.5 * space.fine;
    }
    if (part.points.empty()) continue;
    out.parts.excess = std::max(out.parts.excess, part.excess.upper);
    out.parts.openExcess = std::max(out.parts.openExcess, part.openExcess.upper);
    out.parts.parts.push_back(std::move(part));
  }
  return out;
}

// The groups uncut, one part each. `corners`: whether leaves that are cut from them get the corners of their
// cells.
PartSearch::Parts uncut(const std::vector<TriangleSoup>& soups, const PartSpace& space, bool corners) {
  PartSearch::Parts parts;
  for (std::size_t g = 0; g < soups.size(); ++g) {
    auto leaf = std::make_shared<BspLeaf>();
    leaf->soup = forSearch(soups[g], space);
    if (corners && space.mesh.hasInside()) leaf->cell = Cell(space.mesh);
    leaf->group = static_cast<int>(g);
    parts.push_back(std::make_shared<Part>(makePart({leaf}, space, {space.fine})));
  }
  return parts;
}

// Searches for parts of one mesh, for one bound after the other. Each search uses the measurements of the
// searches before.
class Searches {
 public:
  Searches(const PartSpace& space, const std::vector<TriangleSoup>& soups, int most)
      : space_(space), soups_(soups), most_(most), plain_(space, most), withCorners_(space, most) {}

  // Each way to search may make at most `work` hulls.
  ConvexParts within(double excess, long work);

 private:
  Certified byCells(const PartSearch::Parts& parts) const {
    std::vector<PartPoints> points = pointsOf(parts, soups_, space_);
    if (space_.mesh.hasInside()) coverInside(parts, soups_, space_, points);
    return certified(std::move(points), space_);
  }
  // For parts whose hulls contain the mesh's triangles. No value if one becomes farther from the mesh than
  // `bound` (m).
  std::optional<ConvexParts> byGrowing(PartSearch::Parts parts, double bound) const {
    if (space_.mesh.hasInside()) parts = filled(std::move(parts), space_, most_, bound);
    if (parts.empty()) return std::nullopt;
    return certified(pointsOf(parts, soups_, space_), space_).parts;
  }
  ConvexParts byCutsWithCorners(double excess, long work) {
    withCorners_.aim(excess);
    if (startWithCorners_.empty()) startWithCorners_ = uncut(soups_, space_, true);
    return byCells(withCorners_.byCuts(startWithCorners_, work)).parts;
  }

  const PartSpace& space_;
  const std::vector<TriangleSoup>& soups_;
  int most_;
  PartSearch plain_, withCorners_;
  PartSearch::Parts start_, startWithCorners_;
  bool needsCorners_ = false;  // whether the inside needs corners, and parts that have them from the start
                               // are nearer to the mesh
};

// 1. Join facets, if the result is good enough.
// 2. Cut parts. If the result is not good enough, join facets again and cut them further.
// 3. If the inside needs corners that increase the excess, try parts that grow instead, and cuts with all
//    corners from the start.
ConvexParts Searches::within(double excess, long work) {
  if (needsCorners_) return byCutsWithCorners(excess, work);
  plain_.aim(excess);
  const std::vector<PartSearch::Parts> facets = facetParts(soups_, space_, most_, excess);
  if (!facets.empty()) {
    const PartSearch::Parts few = plain_.improved(facets.front(), work / 10);
    if (plain_.isEnough(few))
      if (auto done = byGrowing(few, std::max(excess, space_.fine))) return *std::move(done);
  }
  if (start_.empty()) start_ = uncut(soups_, space_, false);
  const PartSearch::Parts cuts = plain_.byCuts(start_, work);
  if (!facets.empty() && !plain_.isEnough(cuts)) {
    PartSearch::Parts best;  // best of the facets' sets, after joining
    for (const PartSearch::Parts& one : facets) {
      PartSearch::Parts few = plain_.improved(one, 0L);
      if (best.empty() || PartSearch::isBetter(few, best)) best = std::move(few);
    }
    const PartSearch::Parts other = plain_.improved(best, work / 4);
    if (PartSearch::isBetter(other, cuts))
      if (auto done = byGrowing(other, PartSearch::worstExcess(cuts))) return *std::move(done);
  }
  Certified found = byCells(cuts);
  ConvexParts& best = found.parts;
  if (!found.asFound) {
    // Not for the search's coarser mesh, which does not show where the triangles are.
    if (auto grown = space_.isWhole ? byGrowing(cuts, best.excess) : std::nullopt;
        grown && grown->excess < best.excess)
      best = *std::move(grown);
    ConvexParts other = byCutsWithCorners(excess, work);
    needsCorners_ = other.excess < best.excess;
    if (needsCorners_) return other;
  }
  return std::move(best);
}

// Number of hulls for a search. With more than kSearched triangles it works on a coarser mesh, so it need not
// be as accurate. Two or three parts need fewer hulls.
long workFor(const PartSpace& space, const PartsOptions& options) {
  const double triangles = static_cast<double>(space.mesh.triangles().size());
  const double share =
      std::clamp(std::pow(kSearched / triangles, 1.5), 0.1, 1.0) * std::min(1.0, options.most / 4.0);
  return static_cast<long>(kHulls * options.effort * share / space.costly);
}

}  // namespace

ConvexParts convexParts(const TriangleMesh& input, const PartsOptions& options) {
  constexpr double kLargest = 1e6;  // m, and factor of the usual search: more than that is a mistake
  requireNumber("convexParts: most", options.most, 1, kLargest);
  requireNumber("convexParts: excess", options.excess, 0, kLargest);
  requireNumber("convexParts: effort", options.effort, 1e-3, kLargest);
  const MeshSolid mesh(input);
  PartSpace space(mesh);
  std::vector<int> facetOf;
  space.facets = flatParts(mesh, space.slack, facetOf);
  const bool each = mesh.pieces().pieces() <= kStartPieces;
  const std::vector<TriangleSoup> soups = meshGroups(mesh, facetOf, each);
  space.isWhole = std::all_of(soups.begin(), soups.end(),
                              [](const TriangleSoup& soup) { return soup.triangles.size() <= kSearched; });
  Searches searches(space, soups, options.most);
  const long work = workFor(space, options);
  ConvexParts out = searches.within(options.excess, work);
  // The search uses a coarser mesh, and parts get corners after it. If the result misses the goal by a
  // little, search again with a slightly smaller goal.
  const auto isNearMiss = [&] { return out.excess > options.excess && out.excess < 1.15 * options.excess; };
  double closer = options.excess;
  for (int again = 0; again < 2 && isNearMiss(); ++again) {
    closer *= 0.98 * options.excess / out.excess;
    ConvexParts other = searches.within(closer, work / 4);
    if (other.excess < out.excess) out = std::move(other);
  }
  out.pieces = mesh.pieces().pieces();
  out.closedPieces = mesh.pieces().closedPieces();
  out.slack = 2 * space.slack;
  return out;
}

}  // namespace fcl_stpbv
