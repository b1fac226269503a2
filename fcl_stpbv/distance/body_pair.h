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

/// What the two bodies look like along one normal: the exact gap there and its
/// gradient. Frame of the first body.
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

/// Both bodies in the first one's frame: however far the pair is from the world's origin, only the bodies'
/// own coordinates and their mutual distance enter.
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

  /// The second body's outward normal, in its own frame, where the first body's is `n`.
  Eigen::Vector3d opposite(const Eigen::Vector3d& n) const { return pose_.opposite(n); }
  Packed opposite(const Packed& n) const { return pose_.opposite(n); }

  PosedPatch patchA(int patch) const { return posedPatch(a_, patch); }
  PosedPatch patchB(int patch) const {
    PosedPatch p = posedPatch(b_, patch);
    p.anchor = pose_.placed(p.anchor);
    p.axis = pose_.rotation * p.axis;
    return p;
  }

  /// The gap along `n` when these two patches own it; the second form for patches already posed.
  Sample sample(const Eigen::Vector3d& n, const std::array<int, 2>& patch) const {
    return sample(pack(n), patch, patchA(patch[0]), patchB(patch[1]));
  }
  static Sample sample(const Packed& n, const std::array<int, 2>& patch, const PosedPatch& a,
                       const PosedPatch& b) {
    const CoreGap gap = coreGap(a, b, n);
    return {unpack(n), patch, gap.value, unpack(gap.across), unpack(gap.point)};
  }

  /// Patches near those that own `n`, of any length, and its opposite: of
  /// vertices about as far along them as any.
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

  /// One about as far against `n`, of any length, as any: from the tables of directions alone.
  Packed differenceAgainst(const Eigen::Vector3d& n) const { return vertexDifference(near(n)); }

  /// Second body's centre less the first one's.
  Packed centreDifference() const { return pose_.placed(pack(b_.centre())) - pack(a_.centre()); }

  /// The gap along `n`; the owners are looked for from `hint`. Adds the patches that changed to `steps`.
  Sample sampleFrom(const Eigen::Vector3d& n, const std::array<int, 2>& hint, int& steps) const;

  /// Sum of the radii beyond the cores (m).
  double margins() const { return a_.radii().r + b_.radii().r; }

  /// Rounding of a gap: coordinates up to the bodies' extents and mutual distance, a dozen operations (m).
  double gapRounding() const { return gapRounding_; }

  /// Bound on the rounding of a gap, of the poses that lead to it too: what a certificate is rounded outward
  /// by (m). The part of `acrossRounding` is what twice that across adds to the distance of core points more
  /// than `touching` apart: (2 a)^2 / (2 touching), of which `upper` adds two.
  double certificateRounding() const { return certificateRounding_; }

  /// How far a core point may lie beside the point that its normal touches (m).
  double acrossRounding() const { return acrossRounding_; }

  /// Cores nearer than this all but touch: a patch reaches past its boundary by the rounding of a normal,
  /// `rho` times that in metres, which is a part of the gap and turns the normal by as much. What starts from
  /// the vertices, which do not reach past theirs, is safe from it (m).
  double touching() const { return kTouching * acrossRounding_; }

  /// Whether the gap is as wide as it gets near the sample's normal: its gradient is rounding.
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
  double acrossRounding_;  // of `Sample::across`: a normal is good to an ulp, a face's point moves `rho`
                           // times as far
};

}  // namespace fcl_stpbv::detail
