// Two hulls brought to one frame and one scale, and their Minkowski difference as libccd wants it.
#pragma once

#include <ccd/ccd.h>

#include <Eigen/Geometry>
#include <array>

#include "fcl_stpbv/convex/hull_graph.h"
#include "fcl_stpbv/convex/relative_pose.h"

namespace fcl_stpbv::detail {

/// A point of the difference B - A, and the vertices that it is made of.
struct HullCorner {
  Eigen::Vector3d w{0, 0, 0};
  double gap = 0;
  int vertexA = -1, vertexB = -1;
};

/// A pair of hulls in A's frame, origin at A's centre, lengths divided by a
/// power of two so that the pair is about 1.
///
/// The scale being a power of two, scaling loses nothing. Support points climb from the last ones;
/// the struct lives on the stack of one query.
class PosedHulls {
 public:
  PosedHulls(const HullGraph& a, const Eigen::Isometry3d& poseA, const HullGraph& b,
             const Eigen::Isometry3d& poseB, const std::array<int, 2>& startVertices)
      : a_(a), b_(b), pose_(poseA, poseB), lastA_(startVertices[0]), lastB_(startVertices[1]) {
    if (!pose_.valid) return;
    offset_ = pose_.placed(pack(b.centre())) - pack(a.centre());
    fit();
  }

  /// Whether the poses are rigid and every coordinate is finite and small
  /// enough for products of three of them.
  bool usable() const { return usable_; }
  double scale() const { return scale_; }                     ///< scaled = metres * scale
  Eigen::Vector3d offset() const { return unpack(offset_); }  ///< B's centre, scaled
  int supports() const { return supports_; }

  /// The difference's point farthest against `n`, scaled: B's farthest point along -n minus A's along n.
  HullCorner support(const Eigen::Vector3d& n) {
    ++supports_;
    const int va = climbA(n), vb = climbB(n);
    const Eigen::Vector3d w = pointB(vb) - pointA(va);
    return {w, n.dot(w), va, vb};
  }

  Eigen::Vector3d pointA(int v) const { return scale_ * a_.point(v); }
  Eigen::Vector3d pointB(int v) const {
    return unpack(offset_ + scale_ * (pose_.rotation * pack(b_.point(v))));
  }

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
  /// Chooses the scale.
  void fit();

  int climbA(const Eigen::Vector3d& n) { return lastA_ = a_.extremeVertex(n, lastA_); }
  int climbB(const Eigen::Vector3d& n) { return lastB_ = b_.extremeVertex(pose_.opposite(n), lastB_); }

  // What libccd was given, a ring: its simplex holds only points of its last few steps.
  static constexpr int kLog = 64;
  struct Log {
    std::array<int, kLog> vertex;
    int count = 0;
    void add(int v) { vertex[static_cast<std::size_t>(count++ % kLog)] = v; }
  };

  const HullGraph& a_;
  const HullGraph& b_;
  RelativePose pose_;  // B's frame to A's
  Packed offset_{};
  Eigen::Vector3d first_{1, 0, 0};
  double scale_ = 1;
  bool usable_ = false;
  int lastA_, lastB_, supports_ = 0;
  Log logA_, logB_;
};

}  // namespace fcl_stpbv::detail
