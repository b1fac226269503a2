#include "fcl_stpbv/distance/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/distance/ascent.h"
#include "fcl_stpbv/distance/body_pair.h"
#include "fcl_stpbv/distance/wide_search.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr std::array<int, 2> kNoHint{-1, -1};

/// Makes the nearly orthonormal axes of a rotation orthonormal: poses come from integrated joints, files and single
/// precision. False for axes that are not finite or no rotation's.
bool orthonormalize(Vector3d& x, Vector3d& y, Vector3d& z) {
  constexpr double kFine = 4e-15;  // the rounding of the product of two rotations
  constexpr double kOneStep = 1e-8, kRotation = 0.1;
  for (int i = 0; i < 5; ++i) {
    const double xx = x.dot(x) - 1.0, yy = y.dot(y) - 1.0, zz = z.dot(z) - 1.0;
    const double xy = x.dot(y), yz = y.dot(z), zx = z.dot(x);
    const double off2 = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx);
    if (!(off2 < kRotation * kRotation)) return false;  // also what is not a number
    if (off2 <= kFine * kFine) return true;
    // Newton for the polar factor, q (3 - q^T q) / 2: the error squares.
    const Vector3d dx = xx * x + xy * y + zx * z, dy = xy * x + yy * y + yz * z, dz = zx * x + yz * y + zz * z;
    x -= 0.5 * dx;
    y -= 0.5 * dy;
    z -= 0.5 * dz;
    if (off2 <= kOneStep * kOneStep) return true;
  }
  return true;
}

/// `n` of unit length, without the root where it is already close.
Vector3d renormalized(const Vector3d& n) {
  const double length2 = n.squaredNorm();
  return std::abs(length2 - 1.0) < 1e-8 ? Vector3d((1.5 - 0.5 * length2) * n) : n.normalized();
}

/// The first guess when nothing is remembered: from centre to centre.
Vector3d centreLine(const BodyPair& pair) {
  const Vector3d d = pair.rotation() * pair.b().centre() + pair.translation() - pair.a().centre();
  const double length = d.norm();
  return length > 0.0 ? Vector3d(d / length) : Vector3d::UnitX();
}

/// The patches that `memory` names, which a small motion carries along with the bodies; after a large one the
/// world's normal is the better memory, and none are named.
std::array<int, 2> carried(const BodyPair& pair, const Vector3d& n, const std::array<int, 2>& memory) {
  constexpr double kSmallMotion = 0.1;  // rad from the last normal to the region of the patch, which has moved
  const auto near = [](const StpBv& body, int patch, const Vector3d& m) {
    return patch >= 0 && patch < body.patchCount() && body.outside(patch, m) <= kSmallMotion;
  };
  return near(pair.a(), memory[0], n) && near(pair.b(), memory[1], pair.opposite(n)) ? memory : kNoHint;
}

Start startOf(const BodyPair& pair, const Rotation& toWorld, const PairCache* cache) {
  const Vector3d last = cache ? toWorld.inverse(cache->normal) : Vector3d(0, 0, 0);
  const double length2 = last.squaredNorm();
  if (!(length2 > 0.25 && length2 < 4.0)) return {centreLine(pair), kNoHint, false};
  const Vector3d n = renormalized(last);
  return {n, carried(pair, n, cache->patch), cache->overlap};
}

}  // namespace

FCL_STPBV_VECTORIZED
Distance distance(const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB,
                  PairCache* cache) {
  constexpr double kHuge = 1e300;  // squares must not overflow
  Distance result;
  result.lower = -std::numeric_limits<double>::infinity();
  result.upper = std::numeric_limits<double>::infinity();
  const Rotation toWorld(poseA.linear());
  Vector3d x = toWorld.inverse(poseB.linear().col(0)), y = toWorld.inverse(poseB.linear().col(1)),
           z = toWorld.inverse(poseB.linear().col(2));
  const Vector3d translation = toWorld.inverse(poseB.translation() - poseA.translation());
  if (!orthonormalize(x, y, z) || !(translation.squaredNorm() < kHuge)) return result;

  const BodyPair pair(a, b, Rotation(x, y, z), translation);
  const Start start = startOf(pair, toWorld, cache);
  Found found{Sample::unevaluated(start.n, start.patch[0] >= 0 ? start.patch : pair.near(start.n)),
              DistanceStatus::exact, 0.0};
  Work work;
  // After a large motion between overlapping cores a hop rarely leads to a maximum.
  const bool settled = !(start.overlap && start.patch[0] < 0) && hop(pair, found.at, work);
  // Cores that all but touch: a patch reaches past its seam by the rounding of a normal, `rho` times that in
  // metres, which is a part of the gap and turns the normal by as much. The wide search starts from the
  // vertices, which do not reach past theirs.
  constexpr double kTouching = 1e6;
  if (!settled || !(found.at.core > kTouching * pair.acrossRounding()))
    searchWidely(pair, start, settled && !(found.at.core > 0.0), found, work);

  const Sample& at = found.at;
  result.status = found.status;
  result.lower = at.core - pair.margins();
  result.upper =
      (found.status == DistanceStatus::local ? std::max(found.bound, at.core)
                                             : std::sqrt(at.core * at.core + at.across.squaredNorm())) -
      pair.margins();
  result.distance = result.lower;
  result.patch = at.patch;
  result.normal = renormalized(toWorld * at.n);
  result.point[0] = poseA.translation() + toWorld * (at.point + a.radii().r * at.n);
  result.point[1] = poseA.translation() + toWorld * (at.point + at.across + (at.core - b.radii().r) * at.n);
  result.patchPairs = work.pairs;
  result.patchSteps = work.steps;
  if (cache) {
    cache->normal = result.normal;
    cache->patch = result.patch;
    cache->overlap = at.core <= 0.0;
  }
  return result;
}

}  // namespace fcl_stpbv
