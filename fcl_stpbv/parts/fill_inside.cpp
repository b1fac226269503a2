// The part of the inside that the hulls do not cover is a union of convex pieces (inside_proof.h). Starting
// with the largest piece, each is added to the part whose excess stays smallest with it, or becomes a new
// part. A part that has grown may cover other pieces too, so the uncovered pieces are computed again after a
// few steps.
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/inside_proof.h"
#include "fcl_stpbv/parts/part_search.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

void sortLargestFirst(PartSearch::Parts& parts) {
  std::stable_sort(parts.begin(), parts.end(),
                   [](const PartPtr& a, const PartPtr& b) { return a->hull.volume > b->hull.volume; });
}

/// The pieces as parts, the largest first. Their excess is not measured, because they are inside the mesh.
PartSearch::Parts piecesOf(const std::vector<Cell>& cells) {
  PartSearch::Parts pieces;
  for (const Cell& cell : cells) {
    auto leaf = std::make_shared<BspLeaf>();
    leaf->corners = cell.corners();
    leaf->isFacet = true;
    auto piece = std::make_shared<Part>();
    piece->hull = partHull(leaf->corners);
    piece->leaves = {std::move(leaf)};
    pieces.push_back(std::move(piece));
  }
  sortLargestFirst(pieces);
  return pieces;
}

/// A part joined with a piece, and the index of the part.
struct Growth {
  PartPtr part;
  std::size_t place = 0;
};

/// The part that stays nearest to the mesh when it is joined with the piece.
Growth leastFar(const PartSearch::Parts& parts, const Part& piece, const PartSpace& space) {
  Growth best;
  double least = kInfinity;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    auto both = std::make_shared<Part>(joined(*parts[i], piece, space, {0.5 * space.fine, least}));
    if (best.part && !(both->excess.lower < least)) continue;
    least = both->excess.lower;
    best = {std::move(both), i};
  }
  return best;
}

bool isIn(const HullPlanes& hull, const std::vector<Vector3d>& points) {
  return !isFlat(hull) && std::all_of(hull.begin(), hull.end(), [&](const CutPlane& plane) {
    return std::all_of(points.begin(), points.end(), [&](const Vector3d& p) { return plane.height(p) <= 0; });
  });
}

}  // namespace

PartSearch::Parts filled(PartSearch::Parts parts, const PartSpace& space, int most, double bound) {
  constexpr int kRounds = 20, kEach = 12;
  constexpr std::size_t kMostPlanes = 3000, kMostOpen = 3000;  // more would take too long
  const auto planesOf = [&](const PartPtr& part) { return hullPlanes(part->hull.vertices, 2 * space.slack); };
  std::vector<HullPlanes> hulls;
  sortLargestFirst(parts);
  for (const PartPtr& part : parts) hulls.push_back(planesOf(part));
  for (int round = 0; round < kRounds; ++round) {
    std::size_t planes = 0;
    for (const HullPlanes& hull : hulls) planes += hull.size();
    if (planes > kMostPlanes) return {};
    const auto open = uncoveredInside(Cell(space.mesh), hulls, space.mesh, space.slack);
    if (!open || open->size() > kMostOpen) return {};
    int grown = 0;
    for (const PartPtr& piece : piecesOf(*open)) {
      const std::vector<Vector3d>& corners = piece->hull.vertices;
      if (std::any_of(hulls.begin(), hulls.end(), [&](const HullPlanes& h) { return isIn(h, corners); }))
        continue;
      const Growth best = leastFar(parts, *piece, space);
      if (best.part->excess.lower > bound) {
        if (parts.size() >= at(most)) return {};
        parts.push_back(piece);
        hulls.push_back(planesOf(piece));
      } else {
        parts[best.place] = best.part;
        hulls[best.place] = planesOf(best.part);
      }
      if (++grown == kEach) break;
    }
    if (grown == 0) return parts;  // each remaining piece is in one of the parts
  }
  return {};
}

}  // namespace fcl_stpbv::detail
