// Two hulls brought to one frame and one scale, and their Minkowski difference as libccd wants it.
#pragma once

#include <ccd/ccd.h>

#include <Eigen/Geometry>
#include <array>

#include "fcl_stpbv/adapter/hull_graph.h"
#include "fcl_stpbv/adapter/simplex.h"
#include "fcl_stpbv/distance/rotation.h"

namespace fcl_stpbv {

/// A pair of hulls in A's frame, origin at A's centre, lengths divided by a power of two so that the pair is
/// about 1.
///
/// The scale being a power of two, scaling loses nothing. Support points climb from the last ones; the struct
/// lives on the stack of one query.
class PosedHulls {
 public:
  PosedHulls(const HullGraph& a, const Eigen::Isometry3d& poseA, const HullGraph& b,
             const Eigen::Isometry3d& poseB, const std::array<int, 2>& startVertices)
      : PosedHulls(a, poseA, b, poseB, Rotation(poseA), startVertices) {}

  /// Whether every coordinate is finite and small enough for products of three of them.
  bool usable() const { return usable_; }
  double scale() const { return scale_; }                     ///< scaled = metres * scale
  Eigen::Vector3d offset() const { return unpack(offset_); }  ///< B's centre, scaled
  int supports() const { return supports_; }

  /// The difference's point farthest along `n`, scaled: farthest point of A along n minus B's along -n.
  SimplexCorner support(const Eigen::Vector3d& n) {
    ++supports_;
    const int va = climbA(n), vb = climbB(n);
    return {pointA(va) - pointB(vb), va, vb};
  }

  Eigen::Vector3d pointA(int v) const { return scale_ * a_.point(v); }
  Eigen::Vector3d pointB(int v) const { return unpack(offset_ + scale_ * (rotation_ * pack(b_.point(v)))); }

  /// The same as callbacks for libccd, which sees both objects as this struct.
  static void ccdSupportA(const void* pair, const ccd_vec3_t* direction, ccd_vec3_t* point);
  static void ccdSupportB(const void* pair, const ccd_vec3_t* direction, ccd_vec3_t* point);
  static void ccdFirstDirection(const void* pair, const void*, ccd_vec3_t* direction);

  /// Direction libccd's search begins with (any length).
  void setFirstDirection(const Eigen::Vector3d& n) { first_ = n; }

  /// The vertices behind a support point that libccd holds: of those it was given, the nearest.
  int loggedVertexA(const ccd_vec3_t& point) const;
  int loggedVertexB(const ccd_vec3_t& point) const;

 private:
  PosedHulls(const HullGraph& a, const Eigen::Isometry3d& poseA, const HullGraph& b,
             const Eigen::Isometry3d& poseB, const Rotation& toWorld, const std::array<int, 2>& startVertices)
      : a_(a),
        b_(b),
        rotation_(toWorld.relative(poseB)),
        offset_(toWorld.inverse(column(poseB, 3) - column(poseA, 3)) + rotation_ * pack(b.centre()) -
                pack(a.centre())),
        lastA_(startVertices[0]),
        lastB_(startVertices[1]) {
    fit();
  }

  /// Chooses the scale.
  void fit();

  int climbA(const Eigen::Vector3d& n) { return lastA_ = a_.extremeVertex(n, lastA_); }
  int climbB(const Eigen::Vector3d& n) {
    return lastB_ = b_.extremeVertex(rotation_.inverse(Eigen::Vector3d(-n)), lastB_);
  }

  // What libccd was given, a ring: its simplex holds only points of its last few steps.
  static constexpr int kLog = 64;
  struct Log {
    std::array<int, kLog> vertex;
    int count = 0;
    void add(int v) { vertex[static_cast<std::size_t>(count++ % kLog)] = v; }
  };

  const HullGraph& a_;
  const HullGraph& b_;
  Rotation rotation_;  // B's frame to A's
  Packed offset_;
  Eigen::Vector3d first_{1, 0, 0};
  double scale_ = 1;
  bool usable_ = false;
  int lastA_, lastB_, supports_ = 0;
  Log logA_, logB_;
};

}  // namespace fcl_stpbv
