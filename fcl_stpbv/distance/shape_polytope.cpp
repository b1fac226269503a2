// The nearest point of a polytope to an STP-BV's core, corner by corner.
#include <algorithm>

#include "fcl_stpbv/distance/shape_query.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

/// Up to four corners of the polytope, and the nearest point of their hull.
class CornerSet {
 public:
  bool holds(const Vector3d& p) const {
    return std::find(corner_.begin(), corner_.begin() + count_, p) != corner_.begin() + count_;
  }
  void add(const Vector3d& p) { corner_[static_cast<std::size_t>(count_++)] = p; }

  Nearest nearest(ShapeQuery& q, const StartNormal& start) {
    const Nearest found = search(q, start);
    if (found.apart) reduce(found);
    return found;
  }

 private:
  const Vector3d& at(int i) const { return corner_[static_cast<std::size_t>(i)]; }

  Nearest search(ShapeQuery& q, const StartNormal& start) const {
    if (count_ == 1) {
      Nearest found = nearestOn(q, PointFeature{corner_[0]}, start);
      found.corner[0] = 0;
      return found;
    }
    if (count_ == 2) return nearestOnSegment(q, corner_[0], corner_[1], start);
    if (count_ == 3) return nearestOnTriangle(q, corner_[0], corner_[1], corner_[2], start);
    // The fourth is the new one, and the nearest point lies on a face that has it.
    constexpr std::array<std::array<int, 3>, 3> kFaces{{{0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    Nearest best;
    for (const auto& face : kFaces) {
      Nearest next = nearestOnTriangle(q, at(face[0]), at(face[1]), at(face[2]), start);
      for (int& corner : next.corner) corner = face[static_cast<std::size_t>(corner)];
      if (!next.apart) return next;
      if (!best.apart || isNearer(q, next, best, corner_.data(), 4)) best = next;
    }
    return best;
  }

  void reduce(const Nearest& found) {
    const auto old = corner_;
    count_ = found.corners;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i)
      corner_[i] = old[static_cast<std::size_t>(found.corner[i])];
  }

  std::array<Vector3d, 4> corner_{Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(0, 0, 0)};
  int count_ = 0;
};

}  // namespace

Nearest nearestOnPolytope(ShapeQuery& q, const StartNormal& start) {
  if (q.shape.kind == ShapeKind::triangle)
    return nearestOnTriangle(q, q.posed(q.shape.corner[0]), q.posed(q.shape.corner[1]),
                             q.posed(q.shape.corner[2]), start);
  constexpr int kRounds = 60;  // a handful is usual; each lowers the distance, so none can come again
  CornerSet set;
  set.add(q.facing(start.n));
  Nearest found = set.nearest(q, start);
  Vector3d w = q.facing(found.n);
  for (int i = 0; i < kRounds && found.apart; ++i) {
    if (found.n.dot(found.y - w) <= 0.5 * q.rounding.gap || set.holds(w)) break;
    set.add(w);
    const Nearest next = set.nearest(q, {found.n, found.patch});
    const Vector3d facing = q.facing(next.n);
    const std::array<Vector3d, 2> both{w, facing};
    if (next.apart && !isNearer(q, next, found, both.data(), 2)) break;  // rounding
    found = next;
    w = facing;
  }
  return found;
}

}  // namespace fcl_stpbv
