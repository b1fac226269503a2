// Distance of two meshes or primitives to 1e-7 m:
// 1. 0 where they meet or one is inside the other;
// 2. start from FCL's own distance, if isFartherThan() confirms it;
// 3. otherwise increase the distance in growing steps, then bisect. Each step is one call of isFartherThan().
#include "fcl_stpbv/report/mesh_distance.h"

#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "fcl_stpbv/adapter/fcl_distance.h"

namespace fcl_stpbv::report {
namespace {

constexpr double kWithin =
    1e-7;  // width of the answer (m): below what mesh files in single precision resolve

bool holdsPart(const ExactBody& outer, const Eigen::Isometry3d& poseOuter, const ExactBody& inner,
               const Eigen::Isometry3d& poseInner) {
  if (!outer.solid()) return false;  // a primitive is solid: its distance is not above 0 then
  const fcl::AABBd& box = outer.shape().aabb_local;
  const Eigen::Isometry3d between = poseOuter.inverse() * poseInner;
  return std::any_of(inner.partPoints().begin(), inner.partPoints().end(), [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d point = between * p;
    return box.contain(point) && outer.solid()->holds(point);
  });
}

// FCL's distance of two meshes; negative if FCL gives none.
double fclGuess(const ExactBody& a, const Eigen::Isometry3d& poseA, const ExactBody& b,
                const Eigen::Isometry3d& poseB) {
  if (!a.solid() || !b.solid()) return -1;
  try {
    fcl::DistanceResultd result;
    const double d = fcl::distance(&a.shape(), poseA, &b.shape(), poseB, fcl::DistanceRequestd(), result);
    return std::isfinite(d) ? d : -1;
  } catch (const std::exception&) {
    return -1;
  }
}

}  // namespace

MeshDistance meshDistance(const ExactBody& a, const Eigen::Isometry3d& poseA, const ExactBody& b,
                          const Eigen::Isometry3d& poseB, double atLeast) {
  const auto farther = [&](double x) { return isFartherThan(x, a.shape(), poseA, b.shape(), poseB); };
  const bool apart = atLeast > 0 || farther(0);
  if (!apart || holdsPart(a, poseA, b, poseB) || holdsPart(b, poseB, a, poseA)) return {0, 0};
  double low = std::max(0.0, atLeast), step = kWithin;
  const double guess = fclGuess(a, poseA, b, poseB) - kWithin / 2;
  if (guess > low && farther(guess)) low = guess;
  // Increases the distance in growing steps; one step is enough if the guess was right. Then bisects.
  double high = low + step;
  while (farther(high)) {
    low = high;
    high += step *= 4;
  }
  while (high - low > kWithin) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;  // lengths so large that there is no double in between
    (farther(middle) ? low : high) = middle;
  }
  return {low, high};
}

}  // namespace fcl_stpbv::report
