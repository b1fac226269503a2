// Two bodies placed relative to each other, and the gap between them along one normal.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/distance/patch_pair.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// Evaluation of the gap along one normal: the exact gap and its gradient. Frame of the first body.
struct Sample {
  Eigen::Vector3d n;         ///< unit, from the first body to the second
  std::array<int, 2> patch;  ///< patches owning `n` and `-n`
  double core;               ///< gap between the cores' supporting planes, s(n) + r_A + r_B (m)
  Eigen::Vector3d across;    ///< gradient of the gap on the sphere: core points' difference across `n` (m)
  Eigen::Vector3d point;     ///< the first core's point (m)

  /// A start for `settle` with gap = -inf.
  static Sample unevaluated(const Eigen::Vector3d& n, const std::array<int, 2>& patch) {
    Sample s;
    s.n = n;
    s.patch = patch;
    s.core = -std::numeric_limits<double>::infinity();
    return s;
  }
};

/// Two bodies in the frame of the first one. So rounding errors depend only on the bodies' own coordinates
/// and their mutual distance, not on their distance from the world's origin.
class BodyPair {
 public:
  /// `pose` is valid, and outlives the pair.
  BodyPair(const StpBv& a, const StpBv& b, const RelativePose& pose)
      : a_(a), b_(b), tablesA_(a.tables()), tablesB_(b.tables()), pose_(pose) {
    constexpr double kRounding = 8.0 * std::numeric_limits<double>::epsilon();
    const double size = a.extent() + b.extent() + unpack(pose.translation).lpNorm<1>();
    gapRounding_ = kRounding * size;
    acrossRounding_ = gapRounding_ + kRounding * (a.radii().rho + b.radii().rho);
    certificateRounding_ =
        kGapRounding * size + acrossRounding_ / kTouching + tablesA_.supportError + tablesB_.supportError;
  }

  const StpBv& a() const { return a_; }
  const StpBv& b() const { return b_; }
  const QueryTables& tablesA() const { return tablesA_; }
  const QueryTables& tablesB() const { return tablesB_; }
  const RelativePose& pose() const { return pose_; }

  /// The second body's outward normal, in its own frame, that is opposite the first body's normal `n`.
  Eigen::Vector3d opposite(const Eigen::Vector3d& n) const { return pose_.opposite(n); }
  Packed opposite(const Packed& n) const { return pose_.opposite(n); }

  PosedPatch patchA(int patch) const { return posedPatch(a_, patch); }
  PosedPatch patchB(int patch) const {
    PosedPatch p = posedPatch(b_, patch);
    p.anchor = pose_.placed(p.anchor);
    p.axis = pose_.rotation * p.axis;
    return p;
  }

  /// The gap along `n` if these two patches own it. The second overload takes posed patches.
  Sample sample(const Eigen::Vector3d& n, const std::array<int, 2>& patch) const {
    return sample(pack(n), patch, patchA(patch[0]), patchB(patch[1]));
  }
  static Sample sample(const Packed& n, const std::array<int, 2>& patch, const PosedPatch& a,
                       const PosedPatch& b) {
    const CoreGap gap = coreGap(a, b, n);
    return {unpack(n), patch, gap.value, unpack(gap.across), unpack(gap.point)};
  }

  /// Patches near the owners of `n` and of its opposite: vertices that are about the furthest along them. The
  /// length of `n` does not matter.
  std::array<int, 2> near(const Eigen::Vector3d& n) const {
    return {tablesA_.vertexNear[n], tablesB_.vertexNear[opposite(n)]};
  }

  /// A vertex of either body.
  Packed vertexA(int vertex) const { return pack(tablesA_.patches.vertex(vertex).point); }
  Packed vertexB(int vertex) const { return pose_.placed(pack(tablesB_.patches.vertex(vertex).point)); }

  /// Second body's vertex less the first one's: a point of the difference of the cores.
  Packed vertexDifference(const std::array<int, 2>& vertex) const {
    return vertexB(vertex[1]) - vertexA(vertex[0]);
  }

  /// A vertex difference that is about the furthest against `n`, from the direction tables alone. The length
  /// of `n` does not matter.
  Packed differenceAgainst(const Eigen::Vector3d& n) const { return vertexDifference(near(n)); }

  /// Second body's centre less the first one's.
  Packed centreDifference() const { return pose_.placed(pack(b_.centre())) - pack(a_.centre()); }

  /// The gap along `n`; the owners are looked for from `hint`. Adds the patches that changed to `steps`.
  Sample sampleFrom(const Eigen::Vector3d& n, const std::array<int, 2>& hint, int& steps) const;

  /// Sum of the radii beyond the cores (m).
  double margins() const { return a_.radii().r + b_.radii().r; }

  /// Rounding error of a gap: a dozen operations on coordinates up to the bodies' extents and mutual distance
  /// (m).
  double gapRounding() const { return gapRounding_; }

  /// Bound on the rounding error of a gap, including that of the poses; certificates are rounded outward by
  /// it (m). One part comes from `acrossRounding` a: an offset of 2 a perpendicular to the normal adds (2
  /// a)^2 / (2 touching) to the distance of core points that are more than `touching` apart. `upper` adds two
  /// of these.
  double certificateRounding() const { return certificateRounding_; }

  /// Largest error of a core point perpendicular to its normal, caused by the rounding of the normal (m).
  double acrossRounding() const { return acrossRounding_; }

  /// Cores nearer than this almost touch (m). A patch may extend past its boundary by `rho` times the
  /// rounding of a normal. For cores this near, that is a significant part of the gap and turns the normal. A
  /// search that starts from the vertices does not have this problem.
  double touching() const { return kTouching * acrossRounding_; }

  /// Whether the gap is at a local maximum at the sample's normal, because its gradient is only rounding.
  bool isStationary(const Sample& s) const {
    return s.across.squaredNorm() <= acrossRounding_ * acrossRounding_;
  }

 private:
  static constexpr double kTouching = 1e6;
  const StpBv& a_;
  const StpBv& b_;
  const QueryTables& tablesA_;
  const QueryTables& tablesB_;
  const RelativePose& pose_;
  double gapRounding_;
  double certificateRounding_;
  double acrossRounding_;  // error of `Sample::across`: a normal is accurate to an ulp, and a face's point
                           // moves `rho` times as far
};

}  // namespace fcl_stpbv::detail
