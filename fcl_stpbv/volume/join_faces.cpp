// Joins triangles on one ball to rounding into k-gons:
// 1. grow groups of neighbours from the largest face, while all corners are within 32 units in the last place
//    of its ball and normals agree to 1e-12 rad, and to less where R is 1e8 times their extent and more;
// 2. replace a group by its boundary, if that is a single loop and sound; else keep its faces.
#include "fcl_stpbv/volume/join_faces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/half_edges.h"
#include "fcl_stpbv/volume/rolling_ball.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// The single loop around a group of faces; empty where there is none (a ring, a
// pinch) and the group must stay apart.
Ring boundary(const std::vector<Ring>& faces, const std::vector<HalfEdge>& halfEdges,
              const std::vector<int>& first, const std::vector<int>& group,
              const std::vector<std::size_t>& members) {
  const int own = group[members[0]];
  const auto next = [&](int h) {
    const HalfEdge& e = halfEdges[static_cast<std::size_t>(h)];
    const int corners = static_cast<int>(faces[static_cast<std::size_t>(e.face)].size());
    return first[static_cast<std::size_t>(e.face)] + (e.corner + 1) % corners;
  };
  const auto isOuter = [&](int h) {
    const int twin = halfEdges[static_cast<std::size_t>(h)].twin;
    return group[static_cast<std::size_t>(halfEdges[static_cast<std::size_t>(twin)].face)] != own;
  };
  int start = -1, outer = 0;
  for (const std::size_t f : members)
    for (int k = 0; k < static_cast<int>(faces[f].size()); ++k)
      if (isOuter(first[f] + k)) start = first[f] + k, ++outer;
  if (start < 0) return {};
  Ring ring;
  int h = start;
  do {
    const HalfEdge& e = halfEdges[static_cast<std::size_t>(h)];
    ring.push_back(faces[static_cast<std::size_t>(e.face)][static_cast<std::size_t>(e.corner)]);
    h = next(h);
    while (!isOuter(h)) h = next(halfEdges[static_cast<std::size_t>(h)].twin);
  } while (h != start && static_cast<int>(ring.size()) <= outer);
  const bool isLoop =
      static_cast<int>(ring.size()) == outer && std::set<int>(ring.begin(), ring.end()).size() == ring.size();
  if (!isLoop || ring.size() < 3) return {};
  return ring;
}

// Whether the way from `a` over `b` to `c` turns left, or straight on to rounding, seen along the normal `n`.
bool turnsLeft(const Vector3d& n, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  constexpr double kStraight = 1e-7;  // rad
  const Vector3d arrive = b - a, leave = c - b;
  return n.dot(arrive.cross(leave)) >= -kStraight * arrive.norm() * leave.norm();
}

// Whether one ball will do for all corners of a joined face: each within `tolerance` of it, its normals along
// each side as they must be, and the face convex: where neighbours stay apart its boundary may turn in.
bool isSound(const std::vector<Vector3d>& points, const Ring& ring, double radius, long double tolerance,
             double tilt) {
  const auto at = [&](std::size_t k) -> const Vector3d& {
    return points[static_cast<std::size_t>(ring[k % ring.size()])];
  };
  const std::array<int, 3> t = wideTriangle(points, ring);
  const TouchingBall ball(points[static_cast<std::size_t>(t[0])], points[static_cast<std::size_t>(t[1])],
                          points[static_cast<std::size_t>(t[2])], radius);
  if (!ball.valid()) return false;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const long double here = ball.height(at(k)), next = ball.height(at(k + 1));
    if (std::abs(here) > tolerance || std::abs(next - here) > tilt * (at(k + 1) - at(k)).norm() ||
        !turnsLeft(ball.normalAt(at(k + 1)), at(k), at(k + 1), at(k + 2)))
      return false;
  }
  return true;
}

// The tilt times the radius is what a joined face's patches may part by: that must be little of the cloud's
// size. A ball that stands for a plane has no patches.
double mostTilt(const std::vector<Vector3d>& points, double radius) {
  constexpr double kSeam = 1e-19;  // of a radius that makes a plane: 1e-4 of the cloud's extent
  const double plane = flatRadius(points);
  return radius < plane ? std::min(kJoinTilt, kSeam * plane / radius) : kJoinTilt;
}

}  // namespace

std::vector<Ring> joinFaces(const std::vector<Vector3d>& points, std::vector<Ring> faces, double radius) {
  if (faces.size() < 3) return faces;
  const auto at = [&](int i) -> const Vector3d& { return points[static_cast<std::size_t>(i)]; };
  const long double tolerance = touchTolerance(points);
  const double most = mostTilt(points, radius);
  const std::size_t count = faces.size();

  std::vector<TouchingBall> balls;
  std::vector<Vector3d> normals;
  std::vector<double> area;
  std::vector<int> first;
  int total = 0;
  for (const Ring& ring : faces) {
    const std::array<int, 3> t = wideTriangle(points, ring);
    balls.emplace_back(at(t[0]), at(t[1]), at(t[2]), radius);
    normals.push_back(balls.back().normalAt(at(ring[0])));
    area.push_back((at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])).squaredNorm());
    first.push_back(total);
    total += static_cast<int>(ring.size());
  }
  const std::vector<HalfEdge> halfEdges = pairHalfEdges(points, faces, normals, radius);

  // Height alone does not tell: near the smallest radius the balls of opposite faces nearly coincide.
  const auto onOneBall = [&](std::size_t seed, std::size_t f) {
    const Vector3d tilt = balls[seed].normalAt(at(faces[f][0])) - normals[f];
    return tilt.norm() <= most && std::all_of(faces[f].begin(), faces[f].end(), [&](int i) {
             return std::abs(balls[seed].height(at(i))) <= tolerance;
           });
  };
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return area[i] > area[j]; });
  std::vector<int> group(count, -1);
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t seed : order) {
    if (group[seed] >= 0) continue;
    std::vector<std::size_t> members{seed};
    group[seed] = static_cast<int>(seed);
    for (std::size_t done = 0; done < members.size(); ++done) {
      const std::size_t f = members[done];
      for (std::size_t k = 0; k < faces[f].size(); ++k) {
        const int twin = halfEdges[static_cast<std::size_t>(first[f]) + k].twin;
        const std::size_t g = static_cast<std::size_t>(halfEdges[static_cast<std::size_t>(twin)].face);
        if (group[g] >= 0) continue;
        if (onOneBall(seed, g)) group[g] = static_cast<int>(seed), members.push_back(g);
      }
    }
    groups.push_back(std::move(members));
  }

  std::vector<Ring> joined;
  for (const std::vector<std::size_t>& members : groups) {
    Ring ring = members.size() > 1 ? boundary(faces, halfEdges, first, group, members) : Ring();
    if (!ring.empty() && isSound(points, ring, radius, tolerance, most))
      joined.push_back(std::move(ring));
    else
      for (const std::size_t f : members) joined.push_back(faces[f]);
  }
  for (Ring& ring : joined) std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
  std::sort(joined.begin(), joined.end());
  return joined;
}

}  // namespace fcl_stpbv::detail
