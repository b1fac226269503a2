#include "fcl_stpbv/adapter/simplex.h"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {
namespace {

using Eigen::Vector3d;

// Volumes below this part of the larger ones say nothing about a side.
constexpr double kFlat = 1e-10;

/// A face of the simplex that may hold the nearest point: its corners' numbers and their weights.
struct Candidate {
  std::array<int, 3> corner{};
  std::array<double, 3> weight{};
  int size = 0;
  Vector3d point = Vector3d::Zero();
  double squared = std::numeric_limits<double>::infinity();
};

const Vector3d& at(const Simplex& s, int i) { return s.corner[static_cast<std::size_t>(i)].point; }

Candidate nearestOnPoint(const Simplex& s, int i) {
  return {{i, 0, 0}, {1, 0, 0}, 1, at(s, i), at(s, i).squaredNorm()};
}

Candidate nearestOnSegment(const Simplex& s, int i, int j) {
  const Vector3d &a = at(s, i), &b = at(s, j);
  const Vector3d ab = b - a;
  const double along = -a.dot(ab), back = b.dot(ab);
  if (!(along > 0)) return nearestOnPoint(s, i);
  if (!(back > 0)) return nearestOnPoint(s, j);
  const double t = along / (along + back);  // both are accurate; their sum is |ab|^2
  const Vector3d point = t < 0.5 ? Vector3d(a + t * ab) : Vector3d(b - (1 - t) * ab);
  return {{i, j, 0}, {1 - t, t, 0}, 2, point, point.squaredNorm()};
}

Candidate closer(const Candidate& a, const Candidate& b) { return b.squared < a.squared ? b : a; }

Candidate nearestOnTriangle(const Simplex& s, int i, int j, int k) {
  const Vector3d &a = at(s, i), &b = at(s, j), &c = at(s, k);
  const Vector3d normal = (b - a).cross(c - a);
  const double squared = normal.squaredNorm();
  // Weights as areas seen along the normal.
  const double wa = normal.dot(b.cross(c)), wb = normal.dot(c.cross(a)), wc = normal.dot(a.cross(b));
  if (squared > 0 && wa > 0 && wb > 0 && wc > 0) {
    const double sum = wa + wb + wc;
    // From the plane, not from the weights: the direction then keeps its digits however near the origin is.
    const Vector3d point = (normal.dot(a) / squared) * normal;
    return {{i, j, k}, {wa / sum, wb / sum, wc / sum}, 3, point, point.squaredNorm()};
  }
  // The origin projects outside, or the triangle has no area to tell: the best of the edges it may lie
  // beyond.
  const bool flat = !(squared > 0);
  Candidate best;
  if (flat || wc <= 0) best = closer(best, nearestOnSegment(s, i, j));
  if (flat || wa <= 0) best = closer(best, nearestOnSegment(s, j, k));
  if (flat || wb <= 0) best = closer(best, nearestOnSegment(s, k, i));
  return best;
}

/// Six times the signed volume of the tetrahedron from the origin over a triangle.
double volume(const Vector3d& a, const Vector3d& b, const Vector3d& c) { return a.dot(b.cross(c)); }

void keep(const Simplex& s, const Candidate& best, Simplex& reduced) {
  reduced.size = best.size;
  for (std::size_t i = 0; i < static_cast<std::size_t>(best.size); ++i) {
    reduced.corner[i] = s.corner[static_cast<std::size_t>(best.corner[i])];
    reduced.weight[i] = best.weight[i];
  }
}

}  // namespace

FCL_STPBV_VECTORIZED
NearestPoint reduceToNearest(const Simplex& s, Simplex& reduced) {
  Candidate best{};
  switch (s.size) {
    case 1:
      best = nearestOnPoint(s, 0);
      break;
    case 2:
      best = nearestOnSegment(s, 0, 1);
      break;
    case 3:
      best = nearestOnTriangle(s, 0, 1, 2);
      break;
    default: {
      const Vector3d &a = at(s, 0), &b = at(s, 1), &c = at(s, 2), &d = at(s, 3);
      // Weights of the origin: volumes opposite each corner, all of one sign inside.
      const double va = -volume(b, c, d), vb = volume(a, c, d), vc = -volume(a, b, d), vd = volume(a, b, c);
      const bool inside = (va > 0 && vb > 0 && vc > 0 && vd > 0) || (va < 0 && vb < 0 && vc < 0 && vd < 0);
      if (inside) {
        const double sum = va + vb + vc + vd;
        reduced = s;
        reduced.weight = {va / sum, vb / sum, vc / sum, vd / sum};
        return {Vector3d(0, 0, 0), true};
      }
      // Only faces that the origin lies beyond can hold the point; all of them where the volume is rounding.
      const double sum = va + vb + vc + vd, slack = kFlat * std::abs(sum);
      const double side = sum < 0 ? -1 : 1;
      const bool flat =
          !(std::abs(sum) > kFlat * (std::abs(va) + std::abs(vb) + std::abs(vc) + std::abs(vd)));
      if (flat || side * va <= slack) best = closer(best, nearestOnTriangle(s, 1, 2, 3));
      if (flat || side * vb <= slack) best = closer(best, nearestOnTriangle(s, 0, 2, 3));
      if (flat || side * vc <= slack) best = closer(best, nearestOnTriangle(s, 0, 1, 3));
      if (flat || side * vd <= slack) best = closer(best, nearestOnTriangle(s, 0, 1, 2));
      break;
    }
  }
  keep(s, best, reduced);
  return {best.point, !(best.squared > 0)};
}

}  // namespace fcl_stpbv
