// Finds the point where a ray from inside leaves a volume.
// 1. Walk from patch to patch: compute the exit of the ray through one patch in closed form. If the normal at
//    the exit is in the patch's region, the ray leaves there. Otherwise continue with the neighbour over the
//    boundary that the normal violates most.
// 2. If that walk finds no exit, minimise a convex function over the normals: the ray leaves the surface at
//    the first supporting plane that it meets. Each plane excludes half of the normals. The search ends if no
//    remaining normal can give a lower plane by more than rounding. The next normal to try is that of the
//    patch's exit, or the centroid of the remaining normals.
#include "fcl_stpbv/volume/surface_height.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/patch_view.h"
#include "fcl_stpbv/volume/query_tables.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Where a ray from inside leaves a patch that is continued over the whole sphere.
struct Exit {
  double height;    // along the ray (m)
  bool isThere;     // if false, the ray passes by the patch, and `height` is where it is nearest
  Vector3d normal;  // unit, outward
};

// The exit's height t above y along the unit direction d, from |y + t d - I| = c. I is the patch's point, or
// the point of its circle that is farthest from the exit. `normal` is not set.
Exit exitHeight(const Patch& patch, PatchKind kind, const Radii& radii, const Vector3d& y,
                const Vector3d& d) {
  const Vector3d q = y - patch.anchor;
  if (kind != PatchKind::edge) {
    // A face has |q + t d + rho m|^2 = R^2, a vertex |q + t d|^2 = r^2. The constant term contains no large
    // square.
    const double rho = kind == PatchKind::face ? radii.rho : 0,
                 c = kind == PatchKind::face ? radii.R : radii.r;
    const double half = d.dot(q + rho * patch.axis);
    const double constant = q.squaredNorm() + 2 * rho * q.dot(patch.axis) - radii.r * (c + rho);
    if (!(half * half > constant)) return {-half, false, {}};
    const double root = std::sqrt(half * half - constant);
    return {half > 0 ? -constant / (half + root) : root - half, true, {}};
  }
  // The distance to the circle's farthest point is convex along the ray. So Newton's method, started beyond
  // the exit, comes down monotonically.
  const double half = halfLength(patch, radii), half2 = half * half;
  const double rest = radii.r * (radii.R + radii.rho) + half2;  // R^2 - kappa^2
  double t = radii.r + sag(patch, radii) + half + q.norm();
  for (int round = 0; round < 60; ++round) {
    const Vector3d x = q + t * d;
    const double along = x.dot(patch.axis);
    const Vector3d side = x - along * patch.axis;
    const double across = side.norm();
    const double value = across * (across + 2 * patch.kappa) + along * along - rest;
    const double slope =
        2 * (along * d.dot(patch.axis) + (across > 0 ? (1 + patch.kappa / across) * side.dot(d) : 0));
    if (!(slope > 0)) return {t, false, {}};
    const double step = value / slope;
    t -= step;
    if (!(step > 1e-16 * (1 + std::abs(t)))) break;
  }
  return {t, true, {}};
}

Exit exitOf(const StpBv& volume, int index, const Vector3d& y, const Vector3d& d) {
  const Patch patch = volume.patch(index);
  const PatchKind kind = volume.kind(index);
  Exit exit = exitHeight(patch, kind, volume.radii(), y, d);
  Vector3d n = y + exit.height * d - unpack(posedPatch(volume, index).centre());
  if (kind == PatchKind::edge) {
    const Vector3d side = n - n.dot(patch.axis) * patch.axis;
    if (side.norm() > 0) n += patch.kappa * side.normalized();
  }
  exit.normal = n.normalized();
  return exit;
}

// Step 1, from patch `index` on. The result's patch is -1 if the walk finds no exit. Usually one or two
// patches are enough.
SurfaceHeight fromPatchToPatch(const StpBv& volume, const Vector3d& y, const Vector3d& d, int index) {
  constexpr int kPatches = 60;  // a longer way is left to the search over the whole volume
  int before = -1, tried = 0;
  while (tried < kPatches) {
    ++tried;
    const Exit exit = exitOf(volume, index, y, d);
    const Crossing over = volume.tables().patches.crossing(index, pack(exit.normal));
    if (!(over.past > kBoundaryRounding)) {
      if (!exit.isThere || !(exit.normal.dot(d) > 0)) break;
      return {exit.height, index, tried};
    }
    if (over.neighbour == before) break;  // back and forth between two patches
    before = std::exchange(index, over.neighbour);
  }
  return {0, -1, tried};
}

// A convex polygon that shrinks around a minimum.
class Fence {
 public:
  explicit Fence(double half = 0) : corners_{{-half, -half}, {half, -half}, {half, half}, {-half, half}} {}

  // Removes the part that lies beyond the line through `a` in the direction `uphill`, which is normal to the
  // line.
  void cut(const Vector2d& a, const Vector2d& uphill) {
    kept_.clear();
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      const Vector2d &p = corners_[k], &q = corners_[(k + 1) % corners_.size()];
      const double atP = uphill.dot(p - a), atQ = uphill.dot(q - a);
      if (atP <= 0) kept_.push_back(p);
      if ((atP < 0 && atQ > 0) || (atP > 0 && atQ < 0)) kept_.push_back(p + atP / (atP - atQ) * (q - p));
    }
    corners_.swap(kept_);
  }

  bool isSpent() const { return corners_.size() < 3; }

  bool holds(const Vector2d& a) const {
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      const Vector2d side = corners_[(k + 1) % corners_.size()] - corners_[k], to = a - corners_[k];
      if (!(side.x() * to.y() - side.y() * to.x() > 0)) return false;
    }
    return true;
  }

  // The least value inside the polygon, at most 0, of the linear function that is zero at `a` and has this
  // slope.
  double least(const Vector2d& a, const Vector2d& slope) const {
    double least = 0;
    for (const Vector2d& corner : corners_) least = std::min(least, slope.dot(corner - a));
    return least;
  }

  Vector2d centroid() const {
    Vector2d sum = Vector2d::Zero(), mean = Vector2d::Zero();
    double area = 0;
    for (std::size_t k = 1; k + 1 < corners_.size(); ++k) {
      const Vector2d b = corners_[k] - corners_[0], c = corners_[k + 1] - corners_[0];
      const double part = b.x() * c.y() - b.y() * c.x();
      area += part, sum += part * (b + c) / 3;
    }
    for (const Vector2d& corner : corners_) mean += corner / static_cast<double>(corners_.size());
    return area > 0 ? Vector2d(corners_[0] + sum / area) : mean;
  }

 private:
  std::vector<Vector2d> corners_, kept_;
};

// Step 2, by supporting planes, from patch `index` on.
SurfaceHeight lowestPlane(const StpBv& volume, const Vector3d& y, const Vector3d& d, int index) {
  // Consider all supporting planes that the ray can meet. Their normals are along d + a, with a perpendicular
  // to d. The ray leaves the surface at the first plane that it meets. Let H be the support function for
  // vectors of any length. The plane's height is H(d + a) - (d + a).y. It is convex in a, and its gradient is
  // the part of x - y perpendicular to d, where x is the surface point with that normal. Each plane leaves
  // half of the normals. If the exit through a patch has one of the patch's own normals, it is the answer.
  const Vector3d e = d.unitOrthogonal(), f = d.cross(e);
  const double reach = 2 * volume.enclosingRadius() + (y - volume.centre()).norm();
  constexpr double kWidest = 2e8;  // beyond it a ray grazes the surface
  SurfaceHeight best{kInfinity, index, 0};
  // Rounding of a surface point: that of its own coordinates, and rho times the rounding of its normal.
  const double rounding = 1e-15 * (reach + volume.radii().R + y.norm());
  Vector2d a = Vector2d::Zero();
  Fence fence;
  for (int step = 1; step <= 400; ++step) {
    const Vector3d along = d + a.x() * e + a.y() * f;
    const double stretch = along.norm();
    const Vector3d n = along / stretch;
    index = volume.owner(n, index);
    const double height =
        stretch * (n.dot(volume.patch(index).anchor - y) + supportAboveAnchor(volume, index, n));
    best.planes = step;
    if (height < best.height) best.height = height, best.patch = index;
    const Vector3d over = corePoint(volume, index, n) + volume.radii().r * n - y;
    const Vector2d uphill(over.dot(e), over.dot(f));
    if (uphill.norm() <= rounding) break;
    // Each plane is at least r from y, so no plane with a normal along d + a is lower than r |d + a|.
    if (step == 1) fence = Fence(std::min(kWidest, (height + rounding) / volume.radii().r));
    fence.cut(a, uphill);
    // The height is convex: no normal in the fence is lower than the tangent says. An exit normal that has
    // many roundings itself, as on a thin edge patch with r = 0, is recognised as the answer by this alone.
    if (fence.isSpent() || fence.least(a, uphill) >= -rounding) break;
    // Every third step goes to the centroid, which ensures progress.
    const Vector3d exit = exitOf(volume, index, y, d).normal;
    const double slope = exit.dot(d);
    const Vector2d target(exit.dot(e) / slope, exit.dot(f) / slope);
    if (slope > 0 && step % 3 != 0 && fence.holds(target)) {
      a = target;
    } else {
      a = fence.centroid(), index = -1;  // the centroid is usually far away, so there is no hint
    }
  }
  return best;
}

}  // namespace

SurfaceHeight surfaceHeight(const StpBv& volume, const Vector3d& y, const Vector3d& d, int hint) {
  const int first = volume.owner(d, hint);
  const SurfaceHeight found = fromPatchToPatch(volume, y, d, first);
  if (found.patch >= 0) return found;
  SurfaceHeight lowest = lowestPlane(volume, y, d, first);
  lowest.planes += found.planes;
  return lowest;
}

}  // namespace fcl_stpbv::detail
