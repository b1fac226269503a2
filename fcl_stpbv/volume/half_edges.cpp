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
  const double curvature = std::isinf(radius) ? 0 : 1 / radius;
  const auto at = [&](int i) -> const Vector3d& { return points[static_cast<std::size_t>(i)]; };
  std::vector<HalfEdge> halfEdges;
  const auto startOf = [&](const HalfEdge& e) {
    return faces[static_cast<std::size_t>(e.face)][static_cast<std::size_t>(e.corner)];
  };
  const auto endOf = [&](const HalfEdge& e) {
    const Ring& ring = faces[static_cast<std::size_t>(e.face)];
    return ring[(static_cast<std::size_t>(e.corner) + 1) % ring.size()];
  };
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t k = 0; k < faces[f].size(); ++k)
      halfEdges.push_back({static_cast<int>(f), static_cast<int>(k)});
  // Those that start from vertex v are leaving[begin[v]] to leaving[begin[v + 1]].
  std::vector<std::size_t> begin(points.size() + 1, 0);
  for (const HalfEdge& e : halfEdges) ++begin[static_cast<std::size_t>(startOf(e)) + 1];
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> leaving(halfEdges.size());
  std::vector<std::size_t> filled(begin.begin(), begin.end() - 1);
  for (std::size_t h = 0; h < halfEdges.size(); ++h)
    leaving[filled[static_cast<std::size_t>(startOf(halfEdges[h]))]++] = static_cast<int>(h);

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
    const auto isSpindle = [&] {
      return std::any_of(ring.begin(), ring.end(), [&](int i) {
        const Vector3d q = (at(i) - at(a)) - (at(i) - at(a)).dot(u) * u;
        return i != a && i != b && q.dot(from) > 0.99 * q.norm() * from.norm();
      });
    };
    for (std::size_t i = begin[static_cast<std::size_t>(b)]; i < begin[static_cast<std::size_t>(b) + 1];
         ++i) {
      const HalfEdge& other = halfEdges[static_cast<std::size_t>(leaving[i])];
      if (endOf(other) != a) continue;
      const Vector3d to = across(other.face);
      double turn = std::atan2(to.dot(side), to.dot(from));
      if (turn < 0) turn = turn > -1e-6 && !isSpindle() ? 0 : turn + 2 * kPi;  // a turn of nothing, rounded
      if (edge.twin < 0 || turn < edge.turn) edge.twin = leaving[i], edge.turn = turn;
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
