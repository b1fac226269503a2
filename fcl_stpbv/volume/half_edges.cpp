// Pairs half-edges by their ends; where two vertices are joined by several edges, by the nearest twin ahead
// of the ball that rolls over them.
#include "fcl_stpbv/volume/half_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;
using Ring = std::vector<int>;

std::vector<HalfEdge> pairHalfEdges(const std::vector<Vector3d>& points, const std::vector<Ring>& faces,
                                    const std::vector<Vector3d>& normals, double radius) {
  constexpr double kNothing = 1e-6;  // rad
  const double curvature = std::isinf(radius) ? 0 : 1 / radius;
  const auto at = [&](int i) -> const Vector3d& { return points[static_cast<std::size_t>(i)]; };
  std::vector<HalfEdge> halfEdges;
  std::size_t count = 0;
  for (const Ring& ring : faces) count += ring.size();
  halfEdges.reserve(count);
  // Those that start from vertex v are leaving[begin[v]] to leaving[begin[v + 1]], with where they lead.
  struct Leaving {
    int to, half;
  };
  std::vector<std::size_t> begin(points.size() + 1, 0);
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t k = 0; k < faces[f].size(); ++k) {
      halfEdges.push_back({static_cast<int>(f), static_cast<int>(k)});
      ++begin[static_cast<std::size_t>(faces[f][k]) + 1];
    }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Leaving> leaving(count);
  std::vector<std::size_t> filled(begin.begin(), begin.end() - 1);
  int half = 0;
  for (const Ring& ring : faces)
    for (std::size_t k = 0; k < ring.size(); ++k)
      leaving[filled[static_cast<std::size_t>(ring[k])]++] = {ring[(k + 1) % ring.size()], half++};
  const auto only = [&](int from, int to) {  // half-edge; -1 where there are several or none
    int found = -1;
    for (std::size_t i = begin[static_cast<std::size_t>(from)]; i < begin[static_cast<std::size_t>(from) + 1];
         ++i) {
      if (leaving[i].to != to) continue;
      if (found >= 0) return -1;
      found = leaving[i].half;
    }
    return found;
  };

  for (std::size_t h = 0; h < halfEdges.size(); ++h) {
    HalfEdge& edge = halfEdges[h];
    if (edge.twin >= 0) continue;
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
    // All but a whole turn is possible only where one of the face's other vertices hardly rises over the arc
    // that the ball rolls on, and is highest in what the turn lacks: straight ahead of its normal, seen along
    // the edge.
    const auto isSpindle = [&] {
      return std::any_of(ring.begin(), ring.end(), [&](int i) {
        const Vector3d q = (at(i) - at(a)) - (at(i) - at(a)).dot(u) * u;
        return i != a && i != b && q.dot(from) > 0 &&
               q.cross(from).norm() <= 2 * kNothing * q.norm() * from.norm();
      });
    };
    for (std::size_t i = begin[static_cast<std::size_t>(b)]; i < begin[static_cast<std::size_t>(b) + 1];
         ++i) {
      if (leaving[i].to != a) continue;
      const Vector3d to = across(halfEdges[static_cast<std::size_t>(leaving[i].half)].face);
      double turn = std::atan2(to.dot(side), to.dot(from));
      if (turn < 0)
        turn = turn > -kNothing && !isSpindle() ? 0 : turn + 2 * kPi;  // a turn of nothing, rounded
      if (edge.twin < 0 || turn < edge.turn) edge.twin = leaving[i].half, edge.turn = turn;
    }
    // As for nearly all edges: the ball rolls back by the same angle.
    if (only(b, a) >= 0 && only(a, b) >= 0) {
      HalfEdge& twin = halfEdges[static_cast<std::size_t>(edge.twin)];
      twin.twin = static_cast<int>(h), twin.turn = edge.turn;
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
