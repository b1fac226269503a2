// Joins triangles on one ball to rounding into k-gons:
// 1. grow groups of neighbours, each from the largest face that is left. A neighbour joins if all its corners
//    are within 32 units in the last place of the first face's ball, and its normals agree to 1e-12 rad (to
//    less if R is 1e8 times the extent or more);
// 2. replace a group by its boundary if that is a single loop and passes the checks of isSound(); otherwise
//    keep its faces.
#include "fcl_stpbv/volume/join_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/half_edges.h"
#include "fcl_stpbv/volume/rolling_ball.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// Whether the way from `a` over `b` to `c` turns left, or straight on to rounding, seen along the normal `n`.
bool turnsLeft(const Vector3d& n, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  constexpr double kStraight = 1e-7;  // rad
  const Vector3d arrive = b - a, leave = c - b;
  return n.dot(arrive.cross(leave)) >= -kStraight * arrive.norm() * leave.norm();
}

// Whether one ball fits all corners of a joined face: each corner is within `tolerance` of the ball, the
// heights of a side's two corners differ by at most `tilt` times its length, and the face is convex (a joined
// face can be concave if some neighbours did not join).
bool isSound(const std::vector<Vector3d>& points, const Ring& ring, double radius, long double tolerance,
             double tilt) {
  const auto corner = [&](std::size_t k) -> const Vector3d& { return points[at(ring[k % ring.size()])]; };
  const std::array<int, 3> t = wideTriangle(points, ring);
  const TouchingBall ball(points[at(t[0])], points[at(t[1])], points[at(t[2])], radius);
  if (!ball.valid()) return false;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vector3d &p = corner(k), &q = corner(k + 1);
    const long double here = ball.height(p), next = ball.height(q);
    if (std::abs(here) > tolerance || std::abs(next - here) > tilt * (q - p).norm() ||
        !turnsLeft(ball.normalAt(q), p, q, corner(k + 2)))
      return false;
  }
  return true;
}

// The patches of a joined face may have gaps as wide as the tilt times the radius. This width must be small
// against the cloud's size. A ball that replaces a plane has no patches.
double mostTilt(const std::vector<Vector3d>& points, double radius) {
  constexpr double kSeam = 1e-19;  // share of flatRadius(): the gap is at most 1e-4 of the cloud's extent
  const double plane = flatRadius(points);
  return radius < plane ? std::min(kJoinTilt, kSeam * plane / radius) : kJoinTilt;
}

class FaceJoiner {
 public:
  FaceJoiner(const std::vector<Vector3d>& points, const std::vector<Ring>& faces, double radius)
      : points_(points),
        faces_(faces),
        radius_(radius),
        tolerance_(touchTolerance(points)),
        tilt_(mostTilt(points, radius)),
        group_(faces.size(), -1) {
    int total = 0;
    for (const Ring& ring : faces) {
      const std::array<int, 3> t = wideTriangle(points, ring);
      const Vector3d &a = point(t[0]), &b = point(t[1]), &c = point(t[2]);
      balls_.emplace_back(a, b, c, radius);
      normals_.push_back(balls_.back().normalAt(point(ring[0])));
      area_.push_back((b - a).cross(c - a).squaredNorm());
      first_.push_back(total);
      total += static_cast<int>(ring.size());
    }
    halfEdges_ = pairHalfEdges(points, faces, normals_, radius);
  }

  std::vector<Ring> run() {
    std::vector<std::size_t> order(faces_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t i, std::size_t j) { return area_[i] > area_[j]; });
    std::vector<std::vector<std::size_t>> groups;
    for (const std::size_t seed : order)
      if (group_[seed] < 0) groups.push_back(grown(seed));

    std::vector<Ring> joined;
    for (const std::vector<std::size_t>& members : groups) {
      Ring ring = members.size() > 1 ? boundary(members) : Ring();
      if (!ring.empty() && isSound(points_, ring, radius_, tolerance_, tilt_))
        joined.push_back(std::move(ring));
      else
        for (const std::size_t f : members) joined.push_back(faces_[f]);
    }
    for (Ring& ring : joined)
      std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    std::sort(joined.begin(), joined.end());
    return joined;
  }

 private:
  const Vector3d& point(int i) const { return points_[at(i)]; }
  const HalfEdge& half(int h) const { return halfEdges_[at(h)]; }
  int acrossFrom(int h) const { return half(half(h).twin).face; }

  // The height alone is not enough: near the smallest radius the balls of opposite faces nearly coincide.
  bool isOnBallOf(std::size_t seed, std::size_t f) const {
    const Vector3d tilt = balls_[seed].normalAt(point(faces_[f][0])) - normals_[f];
    return tilt.norm() <= tilt_ && std::all_of(faces_[f].begin(), faces_[f].end(), [&](int i) {
             return std::abs(balls_[seed].height(point(i))) <= tolerance_;
           });
  }

  // A face and all connected faces that lie on its ball and are in no group yet.
  std::vector<std::size_t> grown(std::size_t seed) {
    std::vector<std::size_t> members{seed};
    group_[seed] = static_cast<int>(seed);
    for (std::size_t done = 0; done < members.size(); ++done) {
      const std::size_t f = members[done];
      for (int k = 0; k < static_cast<int>(faces_[f].size()); ++k) {
        const std::size_t g = at(acrossFrom(first_[f] + k));
        if (group_[g] >= 0 || !isOnBallOf(seed, g)) continue;
        group_[g] = static_cast<int>(seed);
        members.push_back(g);
      }
    }
    return members;
  }

  // The single loop around a group. Empty if the boundary is not a single loop: the group forms a ring or
  // meets itself in a vertex. Then its faces must stay separate.
  Ring boundary(const std::vector<std::size_t>& members) const {
    const auto next = [&](int h) {
      const HalfEdge& e = half(h);
      return first_[at(e.face)] + (e.corner + 1) % static_cast<int>(faces_[at(e.face)].size());
    };
    const auto isOuter = [&](int h) { return group_[at(acrossFrom(h))] != group_[members[0]]; };
    int start = -1, outer = 0;
    for (const std::size_t f : members)
      for (int k = 0; k < static_cast<int>(faces_[f].size()); ++k)
        if (isOuter(first_[f] + k)) start = first_[f] + k, ++outer;
    if (start < 0) return {};
    Ring ring;
    int h = start;
    do {
      ring.push_back(faces_[at(half(h).face)][at(half(h).corner)]);
      h = next(h);
      while (!isOuter(h)) h = next(half(h).twin);
    } while (h != start && static_cast<int>(ring.size()) <= outer);
    const bool isLoop = static_cast<int>(ring.size()) == outer &&
                        std::set<int>(ring.begin(), ring.end()).size() == ring.size();
    if (!isLoop || ring.size() < 3) return {};
    return ring;
  }

  const std::vector<Vector3d>& points_;
  const std::vector<Ring>& faces_;
  double radius_;
  long double tolerance_;
  double tilt_;
  std::vector<TouchingBall> balls_;  // one for each face, as the next four members
  std::vector<Vector3d> normals_;    // each at its face's first vertex
  std::vector<double> area_;         // squared, of each face's widest triangle
  // Index of each face's first half-edge; index of the face from which the face's group grew, -1 for none
  // yet.
  std::vector<int> first_, group_;
  std::vector<HalfEdge> halfEdges_;
};

}  // namespace

std::vector<Ring> joinFaces(const std::vector<Vector3d>& points, std::vector<Ring> faces, double radius) {
  if (faces.size() < 3) return faces;
  return FaceJoiner(points, faces, radius).run();
}

}  // namespace fcl_stpbv::detail
