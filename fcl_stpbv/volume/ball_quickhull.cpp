// Quickhull (quickhull.h) with balls of radius rho in place of planes.
// Why it works: the possible centres of the balls form a convex body, the intersection of the balls around
// all points. A new point intersects this body with one more ball. Usually the part of the surface that is
// cut off is one disc, with a single loop as its rim. This fails if the cut removes the middle of an arc and
// leaves both ends, or the reverse. Then the cloud is left to the rolling ball. Sides are decided exactly, in
// double precision where that is certain (quick_ball.h).
#include "fcl_stpbv/volume/ball_quickhull.h"

#include <algorithm>
#include <array>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/quick_ball.h"
#include "fcl_stpbv/volume/quickhull.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// Whether each face's ball contains its neighbours' corners, and no two corners are closer together than
// `same` (m). Sets `mayJoin` if neighbours may lie on one ball up to rounding.
bool isSound(Quickhull<QuickBall>& hull, double same, bool& mayJoin) {
  const double joined =
      same + 1e-9 * same;  // for heights of joined faces, which join_faces.h computes with other roundings
  for (auto& f : hull.faces()) {
    if (f.isGone) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& over = hull.faces()[at(f.beside[k])];
      const int from = f.corner[k], to = f.corner[(k + 1) % 3];
      if (!((hull.at(to) - hull.at(from)).norm() > same)) return false;
      const int opposite = over.corner[0] + over.corner[1] + over.corner[2] - from - to;
      double height = 0;
      if (f.surface.side(hull.at(opposite), &height) > 0) return false;
      mayJoin = mayJoin || !(height < -joined - f.surface.heightError(hull.at(opposite)));
    }
  }
  return true;
}

std::vector<Ring> triangles(const Quickhull<QuickBall>& hull) {
  std::vector<std::array<int, 3>> sorted;
  for (const auto& f : hull.faces()) {
    if (f.isGone) continue;
    std::array<int, 3> t{};
    for (const std::size_t k : {0u, 1u, 2u}) t[k] = hull.original(f.corner[k]);
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    sorted.push_back(t);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<Ring> rings;
  rings.reserve(sorted.size());
  for (const std::array<int, 3>& t : sorted) rings.emplace_back(t.begin(), t.end());
  return rings;
}

}  // namespace

QuickFaces quickhull(const std::vector<Vector3d>& points, double radius) {
  Quickhull<QuickBall> hull(points, radius);
  bool mayJoin = false;
  if (!hull.make() || !isSound(hull, touchTolerance(points), mayJoin)) return {};
  return {triangles(hull), mayJoin, hull.asked()};
}

}  // namespace fcl_stpbv::detail
