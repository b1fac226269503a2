// One part during the search.
// 1. Its hull is the hull of all points of its leaves. A joined part uses the hull vertices of both parts.
// 2. Its excess over the mesh (mesh_solid.h) is measured only as accurately as the search needs.
// 3. A cut clips each leaf's triangles (Sutherland-Hodgman) and its cell by the plane. A leaf with triangles
//    on one side only is not clipped.
#include "fcl_stpbv/parts/part.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

// The cost of one distance: triangles visited, relative to a usual mesh (20 to 60). It is high for large
// triangles that cross each other or a fan about one edge, because the mesh's tree of boxes can then exclude
// only little.
double costOf(const MeshSolid& mesh) {
  constexpr double kUsual = 60;
  constexpr std::size_t kTries = 200;
  const std::vector<Vector3d>& v = mesh.pieces().vertices;
  long tried = 0;
  for (std::size_t i = 0; i < kTries; ++i)  // from points between two corners from all over the mesh
    mesh.nearest(0.5 * (v[i * 7919 % v.size()] + v[(i * 104729 + v.size() / 2) % v.size()]), -1, 0, &tried);
  return std::max(1.0, static_cast<double>(tried) / (kTries * kUsual));
}

}  // namespace

PartSpace::PartSpace(const MeshSolid& solid)
    : mesh(solid),
      size((solid.high() - solid.low()).norm()),
      slack(1e-7 * size + 64 * std::numeric_limits<double>::epsilon() *
                              solid.low().cwiseAbs().cwiseMax(solid.high().cwiseAbs()).maxCoeff()),
      fine(5e-4 * size),
      costly(costOf(solid)),
      known(std::make_unique<KnownExcess>()) {}

void measureAgain(Part& part, const PartSpace& space, const Measure& measure) {
  ExcessOptions options;
  options.absolute = std::max(measure.resolution, 0.1 * space.fine);
  options.relative = measure.relative;
  options.queries = measure.queries + 2 * static_cast<long>(part.hull.surface.size());
  options.enough = measure.enough;
  if (space.isWhole) options.corners = space.slack;
  const MeshExcess before = part.excess;
  part.excess = excessOf(part.hull.surface, space.mesh, options, *space.known);
  if (part.queries == 0) {
    part.resolution = options.absolute;
  } else {  // both measurements are valid bounds
    part.excess.upper = std::min(part.excess.upper, before.upper);
    if (before.lower > part.excess.lower) part.excess.lower = before.lower, part.excess.where = before.where;
    part.resolution = std::min(part.resolution, options.absolute);
  }
  part.queries = std::max(part.queries, measure.queries);
}

Part makePart(BspLeaves leaves, const PartSpace& space, const Measure& measure) {
  std::vector<Vector3d> points;
  for (const auto& leaf : leaves)
    points.insert(points.end(), leaf->soup.points.begin(), leaf->soup.points.end());
  return makePart(std::move(leaves), partHull(points), space, measure);
}

Part makePart(BspLeaves leaves, PartHull hull, const PartSpace& space, const Measure& measure) {
  std::vector<Vector3d> corners;
  for (const auto& leaf : leaves) corners.insert(corners.end(), leaf->corners.begin(), leaf->corners.end());
  if (!corners.empty()) {
    corners.insert(corners.end(), hull.vertices.begin(), hull.vertices.end());
    hull = partHull(corners);
  }
  Part part{std::move(leaves), std::move(hull), {}, 0};
  measureAgain(part, space, measure);
  return part;
}

Part joined(const Part& a, const Part& b, const PartSpace& space, const Measure& measure) {
  Part part;
  part.leaves = a.leaves;
  part.leaves.insert(part.leaves.end(), b.leaves.begin(), b.leaves.end());
  std::vector<Vector3d> points = a.hull.vertices;
  points.insert(points.end(), b.hull.vertices.begin(), b.hull.vertices.end());
  part.hull = partHull(points);
  measureAgain(part, space, measure);
  return part;
}

std::pair<BspLeaves, BspLeaves> cut(const Part& part, const CutPlane& plane, const PartSpace& space) {
  std::pair<BspLeaves, BspLeaves> sides;
  for (const auto& leaf : part.leaves) {
    const auto side = [&](const CutPlane& towards) {
      BspLeaf out;
      out.soup = above(leaf->soup, towards, space.slack);
      out.path = leaf->path;
      out.path.push_back(towards);
      out.isFacet = leaf->isFacet;
      out.group = leaf->group;
      return out;
    };
    BspLeaf up = side(plane), down = side(plane.turned());
    if (up.soup.triangles.empty() || down.soup.triangles.empty()) {
      (up.soup.triangles.empty() ? sides.second : sides.first).push_back(leaf);
      continue;
    }
    for (BspLeaf* half : {&up, &down}) {
      half->cell = leaf->cell.above(half->path.back(), space.slack, &space.mesh);
      half->corners = half->cell.enclosedCorners();
    }
    sides.first.push_back(std::make_shared<const BspLeaf>(std::move(up)));
    sides.second.push_back(std::make_shared<const BspLeaf>(std::move(down)));
  }
  return sides;
}

std::optional<CutHulls> hullsOfCut(const Part& part, const CutPlane& plane, const PartSpace& space) {
  const auto half = [&](const CutPlane& towards) -> std::optional<PartHull> {
    std::vector<Vector3d> points;
    for (const auto& leaf : part.leaves) pointsAbove(leaf->soup, towards, space.slack, points);
    if (points.empty()) return std::nullopt;
    return partHull(points);
  };
  std::optional<PartHull> above = half(plane);
  if (!above) return std::nullopt;
  std::optional<PartHull> below = half(plane.turned());
  if (!below) return std::nullopt;
  constexpr double kLong = 0.002;
  const double longest = std::max(above->diagonal(), below->diagonal());
  const double volume = (above->volume + below->volume) * (1 + kLong * longest / part.hull.diagonal());
  return CutHulls{*std::move(above), *std::move(below), volume};
}

}  // namespace fcl_stpbv::detail
