// Two hulls for libccd's GJK. Scales the pair by a power of two to a size of about 1, because libccd's
// tolerances are absolute. Transforms both hulls into one frame, and provides libccd's callbacks for support
// points. Logs the vertices of the support points, so that the vertices of a simplex are known afterwards.
#pragma once

#include <ccd/ccd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "fcl_stpbv/convex/hull_graph.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

/// A point of the difference B - A, and the vertices of A and B that it is made of.
struct HullCorner {
  Eigen::Vector3d w{0, 0, 0};
  double gap = 0;
  std::array<int, 2> vertex{-1, -1};
};

/// A pair of hulls in A's frame, with the origin at A's centre. Lengths are divided by a power of two so that
/// the size of the pair is about 1.
///
/// Because the scale is a power of two, scaling does not round. Support points climb from the last ones. The
/// struct lives on the stack of one query.
class PosedHulls {
 public:
  PosedHulls(const HullGraph& a, const Eigen::Isometry3d& poseA, const HullGraph& b,
             const Eigen::Isometry3d& poseB, const std::array<int, 2>& startVertices)
      : hull_{&a, &b}, pose_(poseA, poseB), last_(startVertices) {
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

  /// The point of the difference B - A farthest against `n`, scaled: B's farthest point along -n minus A's
  /// along n.
  HullCorner support(const Eigen::Vector3d& n) {
    ++supports_;
    const std::array<int, 2> v{climb(0, n), climb(1, n)};
    const Eigen::Vector3d w = point(1, v[1]) - point(0, v[0]);
    return {w, n.dot(w), v};
  }

  /// A vertex of A (0) or B (1), scaled.
  Eigen::Vector3d point(std::size_t body, int v) const {
    const Eigen::Vector3d& p = hull_[body]->point(v);
    return body == 0 ? Eigen::Vector3d(scale_ * p) : unpack(offset_ + scale_ * (pose_.rotation * pack(p)));
  }

  /// Callbacks of support points for libccd. libccd passes this struct for both objects, as const. The const
  /// may be cast away, because the struct is ours and lives on one query's stack.
  template <std::size_t body>
  static void ccdSupport(const void* pair, const ccd_vec3_t* direction, ccd_vec3_t* point) {
    auto& self = *const_cast<PosedHulls*>(static_cast<const PosedHulls*>(pair));
    self.supports_ += body == 0;  // libccd asks for both bodies in turn
    const Eigen::Vector3d d = fromCcd(*direction);
    const int v = self.climb(body, body == 0 ? d : Eigen::Vector3d(-d));
    self.log_[body].add(v);
    toCcd(self.point(body, v), point);
  }
  static void ccdFirstDirection(const void* pair, const void*, ccd_vec3_t* direction) {
    toCcd(static_cast<const PosedHulls*>(pair)->first_, direction);
  }

  /// The direction with which libccd's search begins (any length).
  void setFirstDirection(const Eigen::Vector3d& n) { first_ = n; }

  /// The vertex of one of libccd's support points: the nearest of the points that libccd was given.
  template <std::size_t body>
  int loggedVertex(const ccd_vec3_t& given) const {
    const Eigen::Vector3d p = fromCcd(given);
    const Log& log = log_[body];
    int best = -1;
    double nearest = kInfinity;
    for (int i = 0; i < std::min(log.count, kLog); ++i) {
      const int v = log.vertex[at(i)];
      const double d = (point(body, v) - p).squaredNorm();
      if (d < nearest) nearest = d, best = v;
    }
    return best;
  }

 private:
  static Eigen::Vector3d fromCcd(const ccd_vec3_t& v) { return {v.v[0], v.v[1], v.v[2]}; }
  static void toCcd(const Eigen::Vector3d& v, ccd_vec3_t* out) { ccdVec3Set(out, v[0], v[1], v[2]); }

  /// Chooses the scale.
  void fit() {
    // A pair this many times farther apart than it is large is scaled by its distance instead, so that
    // products of three coordinates stay far from overflow.
    constexpr double kFar = 1e8;
    const Eigen::Vector3d far = unpack(offset_);
    double size = std::max(hull_[0]->radius() + hull_[1]->radius(), far.lpNorm<1>() / kFar);
    // If the rotation is not finite, the offset is not either.
    if (!far.allFinite() || !std::isfinite(size)) return;
    if (!(size > 0)) size = 1;  // two points at the same place
    int exponent = 0;
    std::frexp(size, &exponent);
    scale_ = std::ldexp(1.0, -exponent);
    offset_ *= scale_;
    usable_ = std::isfinite(scale_) && scale_ > 0;
  }

  /// A's furthest vertex along `n`, or B's against it.
  int climb(std::size_t body, const Eigen::Vector3d& n) {
    return last_[body] = hull_[body]->extremeVertex(body == 0 ? n : pose_.opposite(n), last_[body]);
  }

  // The last vertices that libccd was given, in a ring buffer. Its simplex has only points of its last few
  // steps.
  static constexpr int kLog = 64;
  struct Log {
    std::array<int, kLog> vertex;
    int count = 0;
    void add(int v) { vertex[at(count++ % kLog)] = v; }
  };

  std::array<const HullGraph*, 2> hull_;
  RelativePose pose_;  // from B's frame to A's
  Packed offset_{};
  Eigen::Vector3d first_{1, 0, 0};
  double scale_ = 1;
  bool usable_ = false;
  std::array<int, 2> last_;
  int supports_ = 0;
  std::array<Log, 2> log_;
};

}  // namespace fcl_stpbv::detail
