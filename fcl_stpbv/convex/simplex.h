// Finds the point of a simplex with up to four corners nearest to the origin, and the corners whose hull
// contains it.
//
// 1. One corner: the corner itself. Two: the foot on the segment, clamped to its ends.
// 2. Three: the foot on the triangle's plane by its barycentric coordinates, which are areas seen along the
//    normal. Outside the triangle, the nearest of the edges that it may lie beyond.
// 3. Four: inside if all four signed volumes have one sign, else the nearest of the faces that the origin
//    lies beyond.
// Each case is decided by comparing distances, never by the sign of a small determinant alone: flat and
// needle-shaped simplices are the rule near parallel faces (Ericson, Real-Time Collision Detection, 5.1;
// van den Bergen 2003, 4.3).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

/// Up to four points of a convex set, with the barycentric weights of the one nearest to the origin.
/// `Corner` has a member `w`, the point (m), and what else the caller needs to know about it.
template <typename Corner>
struct Simplex {
  std::array<Corner, 4> corner;
  std::array<double, 4> weight{};
  int size = 0;

  void add(const Corner& c) { corner[at(size++)] = c; }
  bool holds(const Eigen::Vector3d& w) const {
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i)
      if (corner[i].w == w) return true;
    return false;
  }
  /// Sum of the corners' `member`s with the weights of the nearest point.
  Eigen::Vector3d weighted(Eigen::Vector3d Corner::*member) const {
    Eigen::Vector3d sum(0, 0, 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(size); ++i) sum += weight[i] * (corner[i].*member);
    return sum;
  }
};

/// The point of a simplex nearest to the origin.
struct NearestPoint {
  /// The corners' weighted sum: in the simplex up to the rounding of coordinates, however thin the simplex
  /// is.
  Eigen::Vector3d point;
  /// The direction from the origin to the point, of any length. For a triangle near the origin it is the
  /// triangle's normal, which stays accurate however near the triangle is.
  Eigen::Vector3d direction;
  bool inside;  ///< the origin is inside a tetrahedron, or on the simplex up to rounding
};

namespace simplex_face {

using SimplexPoints = std::array<Eigen::Vector3d, 4>;

/// A face of the simplex that may contain the nearest point: its corners' indices and their weights.
struct SimplexFace {
  std::array<int, 3> corner{};
  std::array<double, 3> weight{};
  int size = 0;
  Eigen::Vector3d point{0, 0, 0}, direction{0, 0, 0};
  double squared = std::numeric_limits<double>::infinity();
};

inline const Eigen::Vector3d& at(const SimplexPoints& s, int i) { return s[detail::at(i)]; }

/// Makes a corner the best face if it is nearer than the best so far.
inline void offerCorner(const SimplexPoints& s, int i, SimplexFace& best) {
  const double squared = at(s, i).squaredNorm();
  if (squared < best.squared) best = {{i, 0, 0}, {1, 0, 0}, 1, at(s, i), at(s, i), squared};
}

/// The same for an edge, or the end of it that is nearest.
inline void offerEdge(const SimplexPoints& s, int i, int j, SimplexFace& best) {
  const Eigen::Vector3d &a = at(s, i), &b = at(s, j);
  const Eigen::Vector3d ab = b - a;
  const double along = -a.dot(ab), back = b.dot(ab);
  if (!(along > 0)) return offerCorner(s, i, best);
  if (!(back > 0)) return offerCorner(s, j, best);
  const double t = along / (along + back);  // both are accurate; their sum is |ab|^2
  const Eigen::Vector3d point = t < 0.5 ? Eigen::Vector3d(a + t * ab) : Eigen::Vector3d(b - (1 - t) * ab);
  const double squared = point.squaredNorm();
  if (squared < best.squared) best = {{i, j, 0}, {1 - t, t, 0}, 2, point, point, squared};
}

/// The same for a triangle, or the edge or the corner of it that is nearest.
inline void offerTriangle(const SimplexPoints& s, int i, int j, int k, SimplexFace& best) {
  const Eigen::Vector3d &a = at(s, i), &b = at(s, j), &c = at(s, k);
  const Eigen::Vector3d ab = b - a, ac = c - a, normal = ab.cross(ac);
  const double area2 = normal.squaredNorm();  // (height over the longest side times that side)^2
  const double wa = normal.dot(b.cross(c)), wb = normal.dot(c.cross(a)), wc = normal.dot(a.cross(b));
  bool allEdges = !(area2 > 0);
  if (!allEdges && wa > 0 && wb > 0 && wc > 0) {
    const double sum = wa + wb + wc, ta = wa / sum, tb = wb / sum, tc = wc / sum;
    const Eigen::Vector3d point = ta * a + tb * b + tc * c;
    const double squared = point.squaredNorm(),
                 longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (c - b).squaredNorm()});
    // Higher than far: the normal is better known than the way to the point.
    const bool isHigh = area2 > longest * squared;
    if (squared < best.squared) {
      best = {{i, j, k}, {ta, tb, tc}, 3, point, point, squared};
      if (isHigh) best.direction = (normal.dot(a) / area2) * normal;
    }
    if (isHigh) return;
    allEdges = true;
  }
  // The origin projects outside, or rounding of the corners may hide that it does: the best of the edges that
  // it may lie beyond.
  if (allEdges || wc <= 0) offerEdge(s, i, j, best);
  if (allEdges || wa <= 0) offerEdge(s, j, k, best);
  if (allEdges || wb <= 0) offerEdge(s, k, i, best);
}

/// Six times the signed volume of the tetrahedron from the origin over a triangle.
inline double volume(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return a.dot(b.cross(c));
}

/// The face of a tetrahedron nearest to the origin. False if the origin is inside; `weight` are then the
/// weights of the corners.
inline bool nearestOnTetrahedron(const SimplexPoints& s, SimplexFace& best, std::array<double, 4>& weight) {
  constexpr double kFlat = 1e-10;  // volumes below this fraction of the larger ones have an unknown sign
  const Eigen::Vector3d &a = s[0], &b = s[1], &c = s[2], &d = s[3];
  // Weights of the origin: volumes opposite each corner, all of one sign inside.
  const double va = -volume(b, c, d), vb = volume(a, c, d), vc = -volume(a, b, d), vd = volume(a, b, c);
  const double sum = va + vb + vc + vd;
  if ((va > 0 && vb > 0 && vc > 0 && vd > 0) || (va < 0 && vb < 0 && vc < 0 && vd < 0)) {
    weight = {va / sum, vb / sum, vc / sum, vd / sum};
    return false;
  }
  // Only faces that the origin lies beyond can contain the point. If the volume is only rounding, all can.
  const double slack = kFlat * std::abs(sum), side = sum < 0 ? -1 : 1;
  const bool flat = !(std::abs(sum) > kFlat * (std::abs(va) + std::abs(vb) + std::abs(vc) + std::abs(vd)));
  if (flat || side * va <= slack) offerTriangle(s, 1, 2, 3, best);
  if (flat || side * vb <= slack) offerTriangle(s, 0, 2, 3, best);
  if (flat || side * vc <= slack) offerTriangle(s, 0, 1, 3, best);
  if (flat || side * vd <= slack) offerTriangle(s, 0, 1, 2, best);
  return true;
}

}  // namespace simplex_face

/// Finds the point of `simplex` nearest to the origin. `reduced` gets the corners whose hull contains it;
/// their weights are positive and sum to 1.
template <typename Corner>
NearestPoint reduceToNearest(const Simplex<Corner>& simplex, Simplex<Corner>& reduced) {
  simplex_face::SimplexPoints s;
  for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.size); ++i) s[i] = simplex.corner[i].w;
  simplex_face::SimplexFace best{};
  switch (simplex.size) {
    case 1:
      simplex_face::offerCorner(s, 0, best);
      break;
    case 2:
      simplex_face::offerEdge(s, 0, 1, best);
      break;
    case 3:
      simplex_face::offerTriangle(s, 0, 1, 2, best);
      break;
    default: {
      std::array<double, 4> weight;
      if (!simplex_face::nearestOnTetrahedron(s, best, weight)) {
        reduced = simplex;
        reduced.weight = weight;
        return {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 0), true};
      }
    }
  }
  reduced.size = best.size;
  for (std::size_t i = 0; i < static_cast<std::size_t>(best.size); ++i) {
    reduced.corner[i] = simplex.corner[at(best.corner[i])];
    reduced.weight[i] = best.weight[i];
  }
  return {best.point, best.direction, !(best.squared > 0)};
}

}  // namespace fcl_stpbv::detail
