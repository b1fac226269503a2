// Subtracts convex hulls from a convex cell:
// 1. the planes of a hull cut the cell one after the other. The part outside of a plane is a piece that the
//    hull does not contain. The part that is left at the end is inside the hull;
// 2. the pieces are cut by the next hull in the same way;
// 3. a flat hull contains no volume, but its plane cuts the pieces in two;
// 4. since all triangles are in hulls, each remaining piece is completely inside or completely outside of the
//    solid. Testing one point decides.
#include "fcl_stpbv/parts/inside_proof.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/parts/part_hull.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// Adds the pieces of a cell that a hull does not contain.
void subtract(const Cell& cell, const HullPlanes& hull, double slack, std::vector<Cell>& out) {
  const auto apart = [&](const CutPlane& plane) { return cell.reach(plane).first >= -slack; };
  if (hull.empty() || std::any_of(hull.begin(), hull.end(), apart)) {
    out.push_back(cell);
    return;
  }
  if (isFlat(hull)) {
    for (const CutPlane& side : {hull.front(), hull.front().turned()}) out.push_back(cell.above(side, slack));
    return;
  }
  Cell rest = cell;
  for (const CutPlane& plane : hull) {
    const auto [low, high] = rest.reach(plane);
    if (high <= slack) continue;
    if (low >= -slack) {
      out.push_back(rest);
      return;
    }
    out.push_back(rest.above(plane, slack));
    rest = rest.above(plane.turned(), slack);
    if (rest.isFlat()) return;
  }
}

// The pieces of a cell that no hull contains. No value if there are too many pieces.
std::optional<std::vector<Cell>> outsideOf(const std::vector<HullPlanes>& hulls, const Cell& cell,
                                           double slack) {
  constexpr std::size_t kMostPieces = 20000;
  std::vector<Cell> pieces{cell};
  for (const HullPlanes& hull : hulls) {
    std::vector<Cell> left;
    for (const Cell& piece : pieces) subtract(piece, hull, slack, left);
    left.erase(std::remove_if(left.begin(), left.end(), [](const Cell& c) { return c.isFlat(); }),
               left.end());
    pieces = std::move(left);
    if (pieces.size() > kMostPieces) return std::nullopt;
  }
  return pieces;
}

// Whether a piece is outside of the solid. Each piece is completely inside or completely outside.
bool isOutside(const Cell& piece, const MeshSolid& mesh) {
  return mesh.side(piece.middle()) == MeshSolid::Side::outside;
}

// The plane of a flat hull, from its largest triangle. None for a line or a point.
HullPlanes planeOf(const PartHull& flat) {
  Vector3d normal = Vector3d::Zero();
  for (const Triangle& t : flat.surface) {
    const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
    if (n.squaredNorm() > normal.squaredNorm()) normal = n;
  }
  if (!(normal.norm() > 0)) return {};
  normal.normalize();
  return {{normal, normal.dot(flat.vertices.front())}};
}

}  // namespace

HullPlanes hullPlanes(const std::vector<Vector3d>& points, double cover) {
  const PartHull hull = partHull(points);
  if (!(hull.volume > 0)) return planeOf(hull);
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& v : hull.vertices) middle += v / static_cast<double>(hull.vertices.size());
  HullPlanes planes;
  for (const Triangle& t : hull.surface) {
    const Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
    if (!(n.norm() > 0)) continue;  // the neighbours bound the hull there
    CutPlane plane{n.normalized(), 0};
    if (plane.normal.dot(middle - t[0]) > 0) plane.normal = -plane.normal;
    // The offset is that of the farthest vertex, not of the triangle's own vertices, because the normal of a
    // sliver is inaccurate.
    plane.offset = plane.normal.dot(hull.vertices.front());
    for (const Vector3d& v : hull.vertices) plane.offset = std::max(plane.offset, plane.normal.dot(v));
    plane.offset += cover;
    planes.push_back(plane);
  }
  return planes;
}

std::optional<std::vector<Cell>> uncoveredInside(const Cell& cell, const std::vector<HullPlanes>& hulls,
                                                 const MeshSolid& mesh, double slack) {
  std::optional<std::vector<Cell>> left = outsideOf(hulls, cell, slack);
  if (left)
    left->erase(std::remove_if(left->begin(), left->end(), [&](const Cell& c) { return isOutside(c, mesh); }),
                left->end());
  return left;
}

bool isInsideCovered(const Cell& cell, const std::vector<HullPlanes>& hulls, const MeshSolid& mesh,
                     double slack) {
  const std::optional<std::vector<Cell>> left = outsideOf(hulls, cell, slack);
  return left && std::all_of(left->begin(), left->end(), [&](const Cell& c) { return isOutside(c, mesh); });
}

}  // namespace fcl_stpbv::detail
