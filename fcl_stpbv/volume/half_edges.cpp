// Pairs half-edges by their two ends. If two vertices are joined by several edges, the twin of a half-edge is
// the first one that the rolling ball reaches.
#include "fcl_stpbv/volume/half_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;
using Ring = std::vector<int>;

namespace {

/// The half-edges, sorted by the vertex that they leave. They are numbered face by face.
class LeavingEdges {
 public:
  LeavingEdges(std::size_t vertices, const std::vector<Ring>& faces) : begin_(vertices + 1, 0) {
    for (const Ring& ring : faces)
      for (const int v : ring) ++begin_[at(v) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    ways_.resize(begin_.back());
    std::vector<std::size_t> filled(begin_.begin(), begin_.end() - 1);
    int half = 0;
    for (const Ring& ring : faces)
      for (std::size_t k = 0; k < ring.size(); ++k)
        ways_[filled[at(ring[k])]++] = {ring[(k + 1) % ring.size()], half++};
  }

  std::size_t count() const { return ways_.size(); }

  /// Calls `look` with each half-edge from the vertex `from` to the vertex `to`.
  template <typename Look>
  void between(int from, int to, const Look& look) const {
    for (std::size_t i = begin_[at(from)]; i < begin_[at(from) + 1]; ++i)
      if (ways_[i].to == to) look(ways_[i].half);
  }

  /// Whether exactly one half-edge leads from `from` to `to`.
  bool isOne(int from, int to) const {
    int found = 0;
    between(from, to, [&](int) { ++found; });
    return found == 1;
  }

 private:
  struct Way {
    int to, half;
  };
  // Vertex v's half-edges begin at ways_[begin_[v]] and end before ways_[begin_[v + 1]].
  std::vector<std::size_t> begin_;
  std::vector<Way> ways_;
};

/// The ball on its way over one edge of a face.
class RollingBall {
 public:
  /// `normal` is the face's normal at the edge's start.
  RollingBall(const std::vector<Vector3d>& points, const Ring& ring, int start, int end,
              const Vector3d& normal)
      : points_(points),
        ring_(ring),
        start_(start),
        end_(end),
        along_((points[at(end)] - points[at(start)]).normalized()),
        from_(across(normal)),
        ahead_(along_.cross(from_)) {}

  /// Angle by which the ball rolls to the face `ring` that has this normal at the edge's start, [0, 2 pi].
  double turnTo(const Ring& ring, const Vector3d& normal) const {
    const Vector3d to = across(normal);
    const double forward = to.dot(ahead_), turn = std::atan2(forward, to.dot(from_));
    if (turn <= -kNothing) return turn + 2 * kPi;
    if (turn >= kNothing || forward > kRounding) return turn;
    // A turn of zero and one of 2 pi may be rounded to either side.
    return isSpindle(ring_) && isSpindle(ring) ? 2 * kPi + std::min(turn, 0.0) : std::max(turn, 0.0);
  }

 private:
  static constexpr double kNothing = 1e-6;                                          // rad
  static constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();  // of a unit normal's part

  Vector3d across(const Vector3d& v) const { return v - v.dot(along_) * along_; }

  /// A turn of almost 2 pi is possible only if, of each of the two faces, one of the other vertices rises
  /// very little over the arc on which the ball rolls, and is highest in the small angle by which the turn
  /// falls short of 2 pi. Seen along the edge, such a vertex lies in the direction of the face's normal.
  bool isSpindle(const Ring& ring) const {
    return std::any_of(ring.begin(), ring.end(), [&](int i) {
      const Vector3d q = across(points_[at(i)] - points_[at(start_)]);
      return i != start_ && i != end_ && q.dot(from_) > 0 &&
             q.cross(from_).norm() <= 2 * kNothing * q.norm() * from_.norm();
    });
  }

  const std::vector<Vector3d>& points_;
  const Ring& ring_;
  int start_, end_;
  // The edge's direction; the face's normal without its part along it; the direction into which that turns.
  Vector3d along_, from_, ahead_;
};

}  // namespace

std::vector<HalfEdge> pairHalfEdges(const std::vector<Vector3d>& points, const std::vector<Ring>& faces,
                                    const std::vector<Vector3d>& normals, double radius) {
  const double curvature = std::isinf(radius) ? 0 : 1 / radius;
  const LeavingEdges leaving(points.size(), faces);
  std::vector<HalfEdge> halfEdges;
  halfEdges.reserve(leaving.count());
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t k = 0; k < faces[f].size(); ++k)
      halfEdges.push_back({static_cast<int>(f), static_cast<int>(k)});

  for (std::size_t h = 0; h < halfEdges.size(); ++h) {
    HalfEdge& edge = halfEdges[h];
    if (edge.twin >= 0) continue;
    const Ring& ring = faces[at(edge.face)];
    const int a = ring[at(edge.corner)], b = ring[(at(edge.corner) + 1) % ring.size()];
    const auto normalAt = [&](int face) -> Vector3d {  // at the vertex a
      return normals[at(face)] + curvature * (points[at(a)] - points[at(faces[at(face)][0])]);
    };
    const RollingBall ball(points, ring, a, b, normalAt(edge.face));
    leaving.between(b, a, [&](int twin) {
      const int over = halfEdges[at(twin)].face;
      const double turn = ball.turnTo(faces[at(over)], normalAt(over));
      if (edge.twin < 0 || turn < edge.turn) edge.twin = twin, edge.turn = turn;
    });
    if (edge.twin < 0)
      throw Error("the faces do not close: the edge from vertex " + std::to_string(a) + " to vertex " +
                  std::to_string(b) + " of face " + std::to_string(edge.face) +
                  " has no face on its other side");
    // If one edge joins the two vertices, as nearly always, the ball rolls back by the same angle.
    if (leaving.isOne(b, a) && leaving.isOne(a, b)) {
      HalfEdge& twin = halfEdges[at(edge.twin)];
      twin.twin = static_cast<int>(h), twin.turn = edge.turn;
    }
  }
  for (std::size_t h = 0; h < halfEdges.size(); ++h)
    if (halfEdges[at(halfEdges[h].twin)].twin != static_cast<int>(h))
      throw Error("the faces do not close: an edge of face " + std::to_string(halfEdges[h].face) +
                  " is shared by more than two");
  return halfEdges;
}

}  // namespace fcl_stpbv::detail
