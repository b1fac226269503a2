// Rolls a ball over a cloud (paper, IV.A, Algorithm 1; after Bernardini and others 1999):
// 1. let the ball touch a first, a second and a third point: the first face (first_face.cpp);
// 2. over each open edge pivot the ball to the point it meets next (pivot.cpp);
// 3. stop when no edge is open; join faces on one ball (join_faces.h).
// Sides are decided by one exact predicate (ball_side.h), so that faces found from different edges agree. If
// the roll fails because of rounded angles, the faces of a small cloud are found by their definition
// (ball_faces.h). The convex hull of a cloud in one plane is its outline (flat_outline.cpp).
#include "fcl_stpbv/volume/rolling_ball.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/ball_quickhull.h"
#include "fcl_stpbv/volume/ball_side.h"
#include "fcl_stpbv/volume/join_faces.h"
#include "fcl_stpbv/volume/rolling_cloud.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

/// The half-edges of a growing surface whose other side is not known yet, in one list for each vertex from
/// which they start. A vertex has few, so that each is found in a few steps.
class OpenEdges {
 public:
  explicit OpenEdges(std::size_t vertices) : first_(vertices, kNone) {}

  /// Adds the half-edge `from` -> `to` at a face's corner.
  void add(int from, int to, int face, int corner) {
    int& first = first_[at(from)];
    edges_.push_back({to, face, corner, first});
    first = static_cast<int>(edges_.size()) - 1;
  }

  /// Face of an open half-edge `from` -> `to`; -1 if there is none.
  int face(int from, int to) const {
    for (int e = first_[at(from)]; e != kNone; e = edge(e).next)
      if (edge(e).to == to) return edge(e).face;
    return kNone;
  }

  /// Removes the half-edge `from` -> `to` of this face. Returns its corner, or -1 if it is not open.
  int close(int from, int to, int face) {
    for (int* link = &first_[at(from)]; *link != kNone; link = &edge(*link).next) {
      const Edge found = edge(*link);
      if (found.to != to || found.face != face) continue;
      *link = found.next;
      return found.corner;
    }
    return kNone;
  }

 private:
  static constexpr int kNone = -1;
  struct Edge {
    int to, face, corner, next;
  };
  Edge& edge(int i) { return edges_[at(i)]; }
  const Edge& edge(int i) const { return edges_[at(i)]; }

  std::vector<int> first_;
  std::vector<Edge> edges_;
};

class Roller {
 public:
  Roller(const std::vector<Vector3d>& points, double radius)
      : cloud_(points, radius), faceAt_(points.size(), -1), open_(points.size()) {}

  void roll();
  std::vector<Ring> faces;
  std::vector<int> loneVertices;  // one or two points if the cloud has no face

 private:
  int addFace(Ring ring);
  Vector3d normalAt(int face, int vertex) const { return balls_[at(face)].normalAt(cloud_.at(vertex)); }

  RollingCloud cloud_;
  std::vector<TouchingBall> balls_;
  // Lists of faces, one list for each vertex that is the smallest of its ring. Rings start with this vertex.
  std::vector<int> faceAt_, nextFace_;
  // For each face and corner: whether the face on the other side is known.
  std::vector<std::vector<char>> matched_;
  struct Open {
    int face, corner;
  };
  OpenEdges open_;
  std::vector<Open> waiting_;
};

int Roller::addFace(Ring ring) {
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  int& first = faceAt_[at(ring[0])];
  for (int f = first; f >= 0; f = nextFace_[at(f)]) {
    const Ring& known = faces[at(f)];
    if (known[1] == ring[1] && known[2] == ring[2]) return f;
  }
  const std::array<int, 3> t = wideTriangle(cloud_.points, ring);
  const int face = static_cast<int>(faces.size());
  nextFace_.push_back(first);
  first = face;
  balls_.emplace_back(cloud_.at(t[0]), cloud_.at(t[1]), cloud_.at(t[2]), cloud_.radius);
  const int corners = static_cast<int>(ring.size());
  for (int k = 0; k < corners; ++k) {
    const int next = ring[at((k + 1) % corners)];
    open_.add(ring[at(k)], next, face, k);
    waiting_.push_back({face, k});
  }
  matched_.emplace_back(ring.size(), 0);
  faces.push_back(std::move(ring));
  return face;
}

void Roller::roll() {
  FirstFace first = firstFace(cloud_);
  loneVertices = std::move(first.lone);
  if (first.ring.empty()) return;
  addFace(std::move(first.ring));
  while (!waiting_.empty()) {
    const Open h = waiting_.back();
    waiting_.pop_back();
    auto& isMatched = matched_[at(h.face)][at(h.corner)];
    if (isMatched) continue;
    const Ring ring = faces[at(h.face)];
    const std::size_t k = static_cast<std::size_t>(h.corner);
    const int a = ring[k], b = ring[(k + 1) % ring.size()], c = ring[(k + 2) % ring.size()];

    const bool lone = isLone(cloud_, a, b);
    int face = lone ? open_.face(b, a) : -1;  // over a lone edge only one edge can join a and b
    if (face < 0) {
      const Vector3d u = (cloud_.at(b) - cloud_.at(a)).normalized(), m = normalAt(h.face, a);
      face = addFace(pivot(cloud_, a, b, (m - m.dot(u) * u).normalized(), c, lone));
    }
    const auto close = [&](int from, int to, int owner) {
      const int corner = open_.close(from, to, owner);
      if (corner >= 0) matched_[at(owner)][at(corner)] = 1;
      return corner >= 0;
    };
    if (!close(b, a, face) || !close(a, b, h.face) || faces.size() > 2 * cloud_.points.size() + 4)
      throw Error(
          "the rolling ball's faces do not close: the cloud's coordinates are too close to degenerate for "
          "double precision");
  }
}

}  // namespace

double flatRadius(const std::vector<Vector3d>& points) {
  const double extent = extentOf(points);
  return extent > 0 ? 1e15 * extent : 1;
}

namespace {

// The points that are in a ring, ascending.
std::vector<int> verticesOf(std::size_t points, const std::vector<Ring>& faces) {
  std::vector<char> isVertex(points, 0);
  for (const Ring& ring : faces)
    for (const int i : ring) isVertex[at(i)] = 1;
  std::vector<int> vertices;
  for (std::size_t i = 0; i < points; ++i)
    if (isVertex[i]) vertices.push_back(static_cast<int>(i));
  return vertices;
}

RolledHull hullOf(const std::vector<Vector3d>& points, std::vector<Ring> faces, std::vector<int> lone,
                  double radius) {
  RolledHull hull;
  hull.faces = joinFaces(points, std::move(faces), radius);
  hull.vertices = lone.empty() ? verticesOf(points.size(), hull.faces) : std::move(lone);
  std::sort(hull.vertices.begin(), hull.vertices.end());
  return hull;
}

/// Two points far apart: the two ends, if the points are on one line or in a spindle. Both may be the same
/// point.
std::array<int, 2> farEnds(const std::vector<Vector3d>& points) {
  const auto farthestFrom = [&](int from) {
    int best = from;
    double most = 0;
    for (int i = 0; i < static_cast<int>(points.size()); ++i) {
      const double away = (points[at(i)] - points[at(from)]).squaredNorm();
      if (away > most) best = i, most = away;
    }
    return best;
  };
  const int a = farthestFrom(0), b = farthestFrom(a);
  return {std::min(a, b), std::max(a, b)};
}

/// The two end points of a cloud whose points are on one line up to rounding. A face that rounding makes
/// there could miss an end point. Empty if some point is off the line.
std::vector<int> needleEnds(const std::vector<Vector3d>& points) {
  constexpr double kRounding = 3e-14;  // share of the length
  const auto [a, b] = farEnds(points);
  const Vector3d &start = points[at(a)], axis = points[at(b)] - start;
  const double length = axis.norm();
  if (!(length > 0)) return {};
  for (const Vector3d& p : points)
    if ((p - start).cross(axis).norm() > kRounding * length * length) return {};
  return {a, b};
}

}  // namespace

RolledHull rollBall(const std::vector<Vector3d>& points, double radius) {
  Roller roller(points, radius);
  try {
    roller.roll();
  } catch (const Error&) {
    if (points.size() > kMostByDefinition) throw;
    RolledHull hull = hullByDefinition(points, radius);
    if (hull.faces.empty()) throw;
    return hull;
  }
  return hullOf(points, std::move(roller.faces), std::move(roller.loneVertices), radius);
}

RolledHull convexHull(const std::vector<Vector3d>& points) {
  if (std::vector<int> ends = needleEnds(points); !ends.empty()) return {std::move(ends), {}};
  return flatHull(points);
}

RolledHull flatHull(const std::vector<Vector3d>& points) {
  const double radius = flatRadius(points);
  // When such a large ball rolls from one face to the next, no point inside both balls gets outside in
  // between. So the result of quickhull is the hull without a further check.
  try {
    RolledHull quick = quickBallHull(points, radius);
    if (!quick.faces.empty()) return quick;
  } catch (const Error&) {  // quickhull's faces do not close
  }
  try {
    return rollBall(points, radius);
  } catch (const Error&) {  // nor do the rolling ball's: many points on the sides of one polygon
    const Ring front = flatOutline(points);
    if (front.empty()) throw;
    return hullOf(points, {front, Ring(front.rbegin(), front.rend())}, {}, radius);
  }
}

RolledHull quickBallHull(const std::vector<Vector3d>& points, double radius) {
  QuickFaces quick = quickhull(points, radius);
  if (quick.faces.empty()) return {};
  if (quick.mayJoin) return hullOf(points, std::move(quick.faces), {}, radius);
  std::vector<int> vertices = verticesOf(points.size(), quick.faces);
  return {std::move(vertices), std::move(quick.faces)};
}

RolledHull hullByDefinition(const std::vector<Vector3d>& points, double radius) {
  std::vector<Ring> faces = facesByDefinition(points, radius);
  return faces.empty() ? spindleOf(points) : hullOf(points, std::move(faces), {}, radius);
}

RolledHull spindleOf(const std::vector<Vector3d>& points) {
  const auto [a, b] = farEnds(points);
  return {a == b ? std::vector<int>{a} : std::vector<int>{a, b}, {}};
}

}  // namespace fcl_stpbv::detail
