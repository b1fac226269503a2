// The paper's map from polyhedral features to smooth patches (IV.B to IV.D), and statistics of how often it
// is right.
//
// 1. For each feature of the hulls take the patch of the same vertices.
// 2. If the other body's witness point lies outside that patch's Voronoi region, take the neighbour on that
//    side.
// 3. Repeat step 2 with the smooth points of these patches.
#include "fcl_stpbv/adapter/feature_map.h"

#include <algorithm>

#include "fcl_stpbv/distance/patch_pair.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// A normal this far past a region boundary still counts as on it: both patches agree there, and neither
// mapping is wrong.
constexpr double kBothAgree = 1e-12;

/// Normal at the patch's point nearest to `x`: the widest one of the patch and a point (docs/theory.md, 5).
UnnormalizedNormal towards(const StpBv& volume, int index, const Vector3d& x) {
  const PosedPatch point{pack(x), Packed{}, 0, 0, PatchKind::vertex, &volume.radii()};
  return widestNormal(posedPatch(volume, index), point, Packed{1, 0, 0, 0});
}

/// One step from a patch to the neighbour on whose side `x` lies, if `x` is
/// outside the patch's Voronoi region.
int chooseNeighbour(const StpBv& volume, int patch, const Vector3d& x) {
  const UnnormalizedNormal to = towards(volume, patch, x);
  const Crossing over = volume.tables().patches.crossing(patch, to.d, to.length);
  return over.past > kBothAgree * to.length ? over.neighbour : patch;
}

/// The patch's core point nearest to `x`, even if that is outside the patch's region.
Vector3d nearestCorePoint(const StpBv& volume, int patch, const Vector3d& x) {
  const PosedPatch posed = posedPatch(volume, patch);
  return unpack(posed.anchor + viewCore(posed, towards(volume, patch, x).unit()).offset);
}

bool contains(const StpBv::Ring& ring, int v) { return std::find(ring.begin(), ring.end(), v) != ring.end(); }

/// Whether two patches share a region boundary, or are a face and one of its
/// vertices, whose regions share a corner.
bool areNeighbours(const StpBv& volume, int p, int q) {
  for (const RegionBoundary s : volume.tables().patches.boundaries(p))
    if (s.neighbour == q) return true;
  if (volume.kind(p) == PatchKind::face) std::swap(p, q);
  if (volume.kind(p) != PatchKind::vertex || volume.kind(q) != PatchKind::face) return false;
  return contains(volume.faces()[at(q - volume.facePatch(0))], p);
}

/// 0 if the mapped patch owns the normal, 1 if a neighbour does, 2 if a patch farther away does.
int stepsAway(const StpBv& volume, int mapped, int answer, const Vector3d& normal) {
  if (mapped == answer || volume.outside(mapped, normal) <= kBothAgree) return 0;
  return areNeighbours(volume, mapped, answer) ? 1 : 2;
}

}  // namespace

FCL_STPBV_VECTORIZED
std::array<int, 2> mapFeatures(const StpBvGeometry& a, const Isometry3d& poseA, const StpBvGeometry& b,
                               const Isometry3d& poseB, const PolyhedralWitness& witness) {
  if (witness.verdict != PolyhedralWitness::Verdict::separated) return {-1, -1};
  const Matrix3d toB = poseB.linear().transpose() * poseA.linear();
  const Vector3d offset = poseB.linear().transpose() * (poseA.translation() - poseB.translation());
  const Vector3d bInA = poseA.linear().transpose() * (witness.point[1] - poseA.translation());
  const Vector3d aInB = poseB.linear().transpose() * (witness.point[0] - poseB.translation());
  const int p = chooseNeighbour(a.volume(), a.patchOf(witness.feature[0]), bInA);
  const int q = chooseNeighbour(b.volume(), b.patchOf(witness.feature[1]), aInB);
  // The same test once more, with the smooth points of these patches in place of the polyhedral ones. It
  // halves the wrong choices near contact. Far from contact it leaves one in ten of them (docs/fcl.md).
  const Vector3d smoothA = nearestCorePoint(a.volume(), p, bInA),
                 smoothB = nearestCorePoint(b.volume(), q, aInB);
  return {chooseNeighbour(a.volume(), p, toB.transpose() * (smoothB - offset)),
          chooseNeighbour(b.volume(), q, toB * smoothA + offset)};
}

void countMapping(const StpBv& a, const Isometry3d& poseA, const StpBv& b, const Isometry3d& poseB,
                  const std::array<int, 2>& mapped, const Distance& answer, MappingCounts& counts) {
  if (answer.status == DistanceStatus::invalid) return;
  if (mapped[0] < 0 || mapped[1] < 0) {
    ++counts.unmapped;
    return;
  }
  const Vector3d nA = poseA.linear().transpose() * answer.normal;
  const Vector3d nB = -(poseB.linear().transpose() * answer.normal);
  switch (
      std::max(stepsAway(a, mapped[0], answer.patch[0], nA), stepsAway(b, mapped[1], answer.patch[1], nB))) {
    case 0:
      ++counts.right;
      break;
    case 1:
      ++counts.neighbour;
      break;
    default:
      ++counts.farther;
      break;
  }
}

}  // namespace fcl_stpbv::detail
