// Pairs half-edges by their ends; where two vertices are joined by several edges, by the nearest twin ahead
// of the ball that rolls over them.
#include "fcl_stpbv/volume/half_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;
using Ring = std::vector<int>;

std::vector<HalfEdge> pairHalfEdges(const std::vector<Vector3d>& points, const std::vector<Ring>& faces,
                                    const std::vector<Vector3d>& normals, double radius) {
  const double curvature = std::isinf(radius) ? 0 : 1 / radius;
  const auto at = [&](int i) -> const Vector3d& { return points[static_cast<std::size_t>(i)]; };
  constexpr double kPi = 3.14159265358979323846;
  std::vector<HalfEdge> halfEdges;
  std::multimap<std::pair<int, int>, int> byEnds;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t k = 0; k < faces[f].size(); ++k) {
      byEnds.insert({{faces[f][k], faces[f][(k + 1) % faces[f].size()]}, static_cast<int>(halfEdges.size())});
      halfEdges.push_back({static_cast<int>(f), static_cast<int>(k)});
    }
  for (std::size_t h = 0; h < halfEdges.size(); ++h) {
    HalfEdge& edge = halfEdges[h];
    const Ring& ring = faces[static_cast<std::size_t>(edge.face)];
    const std::size_t k = static_cast<std::size_t>(edge.corner);
    const int a = ring[k], b = ring[(k + 1) % ring.size()];
    const Vector3d u = (at(b) - at(a)).normalized();
    const auto across = [&](int face) {
      const int first = faces[static_cast<std::size_t>(face)][0];
      const Vector3d m = normals[static_cast<std::size_t>(face)] + curvature * (at(a) - at(first));
      return Vector3d(m - m.dot(u) * u);
    };
    const Vector3d from = across(edge.face), side = u.cross(from);
    // Nearly a whole turn is possible only where the face's other vertices hardly rise over the arc that the
    // ball rolls on: straight ahead of its normal, seen along the edge.
    const bool isSpindle = std::any_of(ring.begin(), ring.end(), [&](int i) {
      const Vector3d q = (at(i) - at(a)) - (at(i) - at(a)).dot(u) * u;
      return i != a && i != b && q.dot(from) > 0.99 * q.norm() * from.norm();
    });
    const auto range = byEnds.equal_range({b, a});
    for (auto it = range.first; it != range.second; ++it) {
      const int face = halfEdges[static_cast<std::size_t>(it->second)].face;
      const Vector3d to = across(face);
      double turn = std::atan2(to.dot(side), to.dot(from));
      if (turn < 0) turn = turn > -1e-6 && !isSpindle ? 0 : turn + 2 * kPi;  // a turn of nothing, rounded
      if (edge.twin < 0 || turn < edge.turn) edge.twin = it->second, edge.turn = turn;
    }
    if (edge.twin < 0)
      throw Error("the faces do not close: the edge from vertex " + std::to_string(a) + " to vertex " +
                  std::to_string(b) + " of face " + std::to_string(edge.face) +
                  " has no face on its other side");
  }
  for (std::size_t h = 0; h < halfEdges.size(); ++h)
    if (halfEdges[static_cast<std::size_t>(halfEdges[h].twin)].twin != static_cast<int>(h))
      throw Error("the faces do not close: an edge of face " + std::to_string(halfEdges[h].face) +
                  " is shared by more than two");
  return halfEdges;
}

}  // namespace fcl_stpbv::detail
