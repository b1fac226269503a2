// Checks of a finished volume:
// 1. no vertex is above the ball of its own face or a neighbouring face (which decides for all vertices and
//    balls, by Blaschke's theorem), and no given point is above the surface;
// 2. the solid angles of all regions, by Gauss-Bonnet, sum to 4 pi;
// 3. patches meet along their boundaries to rounding.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/join_faces.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/point_tree.h"
#include "fcl_stpbv/volume/regions.h"
#include "fcl_stpbv/volume/rolling_ball.h"
#include "fcl_stpbv/volume/surface_check.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

std::string brief(double value) { return formatted("%.3g", value); }

// Largest height of the volume's vertices and of a cloud's points over the surface pulled in by `margin` (m).
// A vertex lies on its own patch, but any other point may be nearest to an edge. Of a cloud only the vertices
// of its convex hull count.
double containmentOf(const StpBv& volume, const std::vector<Vector3d>& cloud, double margin) {
  double worst = vertexHeight(volume);
  if (cloud.empty()) return worst;
  const PointTree tree(volume.vertices());
  std::vector<int> near;
  for (const int i : convexHull(cloud).vertices) {
    const Vector3d& p = cloud[at(i)];
    tree.within(p, 0, &near, 1);
    if (near.empty() || margin > volume.radii().r)
      worst = std::max(worst, signedDistance(volume, p) + margin);
  }
  return worst;
}

struct BoundaryGap {
  double largest = 0;
  bool ok = true;
};

BoundaryGap boundaryGapOf(const StpBv& volume, double rounding) {
  BoundaryGap result;
  // A joined face's ball, and with it the edge's arc, may be tilted by as much as the join allows.
  const auto isJoined = [&](int face) { return face >= 0 && volume.faces()[at(face)].size() > 3; };
  const double tilted = rounding + 2 * kJoinTilt * volume.radii().rho;
  for (int e = 0; e < volume.edgeCount(); ++e) {
    const StpBv::Edge& edge = volume.edges()[at(e)];
    const EdgeGap gap = edgeGap(volume, e);
    const bool joined0 = isJoined(edge.face[0]), joined1 = isJoined(edge.face[1]);
    result.largest = std::max(result.largest, gap.largest());
    result.ok = result.ok && gap.ends <= rounding && gap.arc <= (joined0 || joined1 ? tilted : rounding) &&
                gap.side[0] <= (joined0 ? tilted : rounding) && gap.side[1] <= (joined1 ? tilted : rounding);
  }
  return result;
}

}  // namespace

std::vector<double> solidAngles(const StpBv& volume) { return regionAngles(volume).area; }

Verification verify(const StpBv& volume, const std::vector<Vector3d>& points) {
  return verify(volume, points, volume.radii().r);
}

Verification verify(const StpBv& volume, const std::vector<Vector3d>& points, double margin) {
  Verification result;
  const auto isFinite = [](const Vector3d& p) { return p.allFinite(); };
  if (!std::isfinite(margin) || !std::all_of(points.begin(), points.end(), isFinite)) {
    result.containment = kInfinity;
    result.message = "the margin or a point is not finite";
    return result;
  }
  std::vector<Vector3d> all = volume.vertices();
  all.insert(all.end(), points.begin(), points.end());
  result.containment = containmentOf(volume, points, margin);
  double sum = 0, least = 0;
  for (const double angle : solidAngles(volume)) sum += angle, least = std::min(least, angle);
  result.solidAngleError = sum - 4 * kPi;

  const double cosine = leastCosine(volume);
  // Heights and boundaries are off by a few roundings of lengths up to the body's size and, because of the
  // normals, by rho times their rounding. The circle around an edge, kappa = sqrt(rho^2 - half^2), is off by
  // the three roundings of rho^2 under its root, divided by 2 kappa.
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const double length = touchTolerance(all) + (8 + 1.5 / cosine) * kEpsilon * volume.radii().rho;
  const BoundaryGap boundaries = boundaryGapOf(volume, 4 * length);
  result.boundaryGap = boundaries.largest;
  // Each corner's angle is off by a few roundings, and an edge's turn by one over the cosine as much.
  const double angle = 1e-13 * (16 + volume.edgeCount()) + 4 * kEpsilon / cosine;
  // A point may have been merged into a vertex next to it, and that vertex may be outside the ball of a
  // joined face by the same length.
  if (!(result.containment <= length + touchTolerance(all)))
    result.message = "a point lies " + brief(result.containment) + " m nearer to the surface than the margin";
  else if (!(std::abs(result.solidAngleError) <= angle) || !(least >= -angle))
    result.message =
        "the regions of normals do not tile the sphere: off by " + brief(result.solidAngleError) + " sr";
  else if (!boundaries.ok)
    result.message =
        "neighbouring patches part by " + brief(result.boundaryGap) + " m at their region boundary";
  else
    result.message = "ok";
  result.ok = result.message == "ok";
  return result;
}

}  // namespace fcl_stpbv
