// Penetration depth of an STP-BV and a simple shape, for cases in which neither a single point of the shape
// (point_overlap.cpp) nor its normal cones (cone_overlap.cpp) give the depth.
//
// 1. EPA (convex/epa.h) on the difference of the two cores bounds the depth.
// 2. When EPA is near the answer, the maximum on one feature of the shape (deep_features.cpp) gives the
//    normal and points up to rounding. EPA's faces around it are then removed from the search.
#include <algorithm>
#include <cmath>
#include <optional>

#include "fcl_stpbv/convex/epa.h"
#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/distance/shape_distance.h"
#include "fcl_stpbv/distance/shape_query.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

/// The difference of the volume's core and the shape's core. Its corners also store the shape's point.
class ShapeDifference {
 public:
  struct Corner {
    Vector3d w{0, 0, 0};      ///< the point of the difference (m)
    Vector3d onA{0, 0, 0};    ///< the volume's part of it
    double gap = 0;           ///< between the supporting planes that it was found with (m)
    Vector3d shape{0, 0, 0};  ///< the shape's part, in the volume's frame
  };

  explicit ShapeDifference(ShapeQuery& q) : q_(q) {}

  /// EPA's normals jump back and forth, so the search for the patch starts from a table, not from the last
  /// patch.
  Corner support(const Vector3d& n) {
    const SupportPoint p = viewVolume(q_.body, n, -1, q_.steps);
    const Vector3d y = q_.facing(n);
    ++q_.pairs;
    return {y - p.point, p.point, p.gap(y), y};
  }

 private:
  ShapeQuery& q_;
};

/// Improves the best normal if rounding or the size of the polytope stopped EPA: tries normals around it, at
/// smaller and smaller angles.
template <typename Search>
void climbToLeastOverlap(Search& epa) {
  constexpr int kTrials = 4000;
  double step = 0.02;  // rad
  for (int trials = 0; step > 1e-9 && trials < kTrials;) {
    const Vector3d n = epa.n, e = n.unitOrthogonal(), f = n.cross(e);
    const double gap = epa.gap;
    for (int k = 0; k < 8 && epa.gap <= gap; ++k, ++trials) {
      const double angle = kPi / 4 * k + 40.0 * step;  // another direction in each round
      epa.look((n + step * (std::cos(angle) * e + std::sin(angle) * f)).normalized());
    }
    if (epa.gap <= gap) step *= 0.5;
  }
}

/// The shape's corners of EPA's answer, without duplicates.
template <typename Search>
ShapeCorners cornersMet(const Search& epa) {
  ShapeCorners met;
  for (int i = 0; i < epa.metCount; ++i) {
    const Vector3d& p = epa.met[at(i)].shape;
    if (std::find(met.p.begin(), met.p.begin() + met.count, p) == met.p.begin() + met.count)
      met.p[at(met.count++)] = p;
  }
  return met;
}

}  // namespace

LeastOverlap leastOverlap(ShapeQuery& q, const StartNormal& start) {
  ShapeDifference difference(q);
  Epa<ShapeDifference> epa(difference, q.rounding.gap, q.body.radii().rho);
  epa.look(start.n);
  std::optional<DeepFeature> top;
  bool ascend = false;
  const auto maximum = [&](Epa<ShapeDifference>& search) -> std::optional<LocalMaximum> {
    top = deepestFeature(q, {search.n, -1}, search.gap, cornersMet(search), ascend);
    if (!top) return {};
    if (top->at.gap > search.gap) search.gap = top->at.gap, search.n = top->at.n;
    return top->around;
  };
  if (!epa.run(maximum)) climbToLeastOverlap(epa);
  if (!top || epa.gap > top->at.gap + q.rounding.gap) {
    ascend = true;
    maximum(epa);
  }
  // The polytope's points are off by the rounding of the volume's core points.
  LeastOverlap best{{}, std::max(epa.bound, epa.gap) + q.rounding.across, true, epa.solved()};
  if (top) {
    best.at = top->at;
    return best;
  }
  best.at.n = epa.n;
  best.at.gap = epa.gap;
  best.at.y = epa.onB();
  best.at.corners = 1;
  return best;
}

}  // namespace fcl_stpbv::detail
