// A triangle cut by a few planes.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>

#include "fcl_stpbv/parts/mesh_solid.h"

namespace fcl_stpbv::detail {

/// The remainder of a triangle after cuts by up to three planes: a convex polygon, or nothing.
class CutTriangle {
 public:
  CutTriangle() = default;
  explicit CutTriangle(const Triangle& t) {
    for (const Eigen::Vector3d& p : t) add(p);
  }
  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  const Eigen::Vector3d& operator[](std::size_t i) const { return corners_[i]; }
  const Eigen::Vector3d* begin() const { return corners_.data(); }
  const Eigen::Vector3d* end() const { return corners_.data() + size_; }
  double area() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t k = 1; k + 1 < size_; ++k)
      sum += (corners_[k] - corners_[0]).cross(corners_[k + 1] - corners_[0]);
    return 0.5 * sum.norm();
  }

  /// Cuts the polygon into the part where along.p >= offset, and the rest. Corners within `slack` of that
  /// plane count as on it.
  std::pair<CutTriangle, CutTriangle> cut(const Eigen::Vector3d& along, double offset, double slack) const {
    const CutTriangle& ring = *this;
    std::pair<CutTriangle, CutTriangle> out;
    std::array<double, 6> heights;
    bool above = false, below = false;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const double h = along.dot(ring[k]) - offset;
      heights[k] = std::abs(h) <= slack ? 0 : h;
      above = above || heights[k] > 0, below = below || heights[k] < 0;
    }
    if (!below) return {above ? ring : CutTriangle(), {}};
    if (!above) return {{}, ring};
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const std::size_t next = (k + 1) % ring.size();
      const double first = heights[k], second = heights[next];
      if (first >= 0) out.first.add(ring[k]);
      if (first <= 0) out.second.add(ring[k]);
      if (first * second < 0) {
        const Eigen::Vector3d p = ring[k] + first / (first - second) * (ring[next] - ring[k]);
        out.first.add(p);
        out.second.add(p);
      }
    }
    return out;
  }

 private:
  void add(const Eigen::Vector3d& p) {
    if (size_ < corners_.size()) corners_[size_++] = p;
  }
  std::array<Eigen::Vector3d, 6> corners_;  // a cut adds at most one corner, and there are three cuts
  std::size_t size_ = 0;
};

}  // namespace fcl_stpbv::detail
