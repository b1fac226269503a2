// Let b be a polytope's vertex furthest along the unit vector d. Another vertex v is not further than b along
// a unit vector e if (v - b).d + |v - b| |e - d| <= 0. So one pass over all vertices finds the candidates for
// all directions within a given chord of d. For a round body that is one vertex in forty.
#include "fcl_stpbv/convex/vertex_cap.h"

#include "fcl_stpbv/convex/vertex_set.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

constexpr double kChord = 0.15;  // between the axis and the directions that a cap is used for
constexpr double kWider = 0.16;  // that it is made for: so rounding cannot exclude a vertex

}  // namespace

bool VertexCap::isNearAxis(const Vector3d& d) const {
  constexpr double kCosine = 1.0 - 0.5 * kChord * kChord;
  const double along = d.dot(axis_);
  return along > 0.0 && along * along >= kCosine * kCosine * d.squaredNorm();
}

Vector3d VertexCap::furthest(const Vector3d& d, const Vector3d* vertices, int count) {
  if (!full_ && isNearAxis(d)) {
    if (count_ == 0) count_ = notBelow(furthest_, axis_, kWider, vertices, count, near_.data(), kRoom);
    full_ = count_ > kRoom;
    if (!full_) return near_[at(furthestAlong(d, near_.data(), count_))];
  }
  axis_ = d.normalized();
  count_ = 0;
  furthest_ = vertices[furthestAlong(d, vertices, count)];
  return furthest_;
}

VertexList VertexCap::candidates(const Vector3d& n, double chord, const Vector3d* vertices, int count) const {
  const bool known = count_ > 0 && !full_ && (n - axis_).norm() + chord <= kChord;
  return known ? VertexList{near_.data(), count_} : VertexList{vertices, count};
}

}  // namespace fcl_stpbv::detail
