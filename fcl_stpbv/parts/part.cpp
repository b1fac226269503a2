// One part during the search: the hull of what its cells hold, and its excess over the mesh, known only as
// well as the search needs. Cutting clips each cell's triangles and corners; joining takes both parts'
// points.
#include "fcl_stpbv/parts/part.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

PartSpace::PartSpace(const MeshSolid& solid)
    : mesh(solid), size((solid.high() - solid.low()).norm()), slack(1e-7 * size), fine(5e-4 * size) {}

void measureAgain(Part& part, const PartSpace& space, const Measure& measure) {
  ExcessOptions options;
  options.absolute = std::max(measure.resolution, 0.5 * space.fine);
  options.relative = 0.1;
  options.queries = 1000 + 2 * static_cast<long>(part.hull.surface.size());
  options.enough = measure.enough;
  part.excess = excessOf(part.hull.surface, space.mesh, options);
  part.resolution = options.absolute;
}

Part makePart(Rooms rooms, const PartSpace& space, const Measure& measure) {
  std::vector<Vector3d> points;
  for (const auto& room : rooms) {
    points.insert(points.end(), room->soup.points.begin(), room->soup.points.end());
    points.insert(points.end(), room->corners.begin(), room->corners.end());
  }
  Part part{std::move(rooms), partHull(points), {}, 0};
  measureAgain(part, space, measure);
  return part;
}

Part joined(const Part& a, const Part& b, const PartSpace& space, const Measure& measure) {
  Part part;
  part.rooms = a.rooms;
  part.rooms.insert(part.rooms.end(), b.rooms.begin(), b.rooms.end());
  std::vector<Vector3d> points = a.hull.vertices;
  points.insert(points.end(), b.hull.vertices.begin(), b.hull.vertices.end());
  part.hull = partHull(points);
  measureAgain(part, space, measure);
  return part;
}

std::pair<Rooms, Rooms> cut(const Part& part, const CutPlane& plane, const PartSpace& space) {
  std::pair<Rooms, Rooms> sides;
  for (const auto& room : part.rooms) {
    const auto side = [&](const CutPlane& towards) {
      Room out;
      out.soup = above(room->soup, towards, space.slack);
      out.path = room->path;
      out.path.push_back(towards);
      out.group = room->group;
      return out;
    };
    Room up = side(plane), down = side(plane.turned());
    if (up.soup.triangles.empty() || down.soup.triangles.empty()) {
      (up.soup.triangles.empty() ? sides.second : sides.first).push_back(room);
      continue;
    }
    for (Room* half : {&up, &down}) {
      half->cell = room->cell.above(half->path.back(), space.slack, space.mesh);
      half->corners = half->cell.enclosedCorners();
    }
    sides.first.push_back(std::make_shared<const Room>(std::move(up)));
    sides.second.push_back(std::make_shared<const Room>(std::move(down)));
  }
  return sides;
}

double volumeOfCut(const Part& part, const CutPlane& plane, const PartSpace& space) {
  double sum = 0;
  for (const CutPlane& towards : {plane, plane.turned()}) {
    std::vector<Vector3d> points;
    for (const auto& room : part.rooms) pointsAbove(room->soup, towards, space.slack, points);
    if (points.empty()) return -1;
    sum += partHull(points).volume;
  }
  return sum;
}

}  // namespace fcl_stpbv::detail
