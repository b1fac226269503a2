// How far the surface exceeds a convex hull.
// 1. Largest: the largest difference of the two support functions, at each face normal of the hull and over
//    the normals of each hull edge, where stationary points are found by bisection.
// 2. Mean: quadrature over the hull's triangles of the height of the surface above them.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/ball_side.h"
#include "fcl_stpbv/volume/covered_hull.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/patch_view.h"
#include "fcl_stpbv/volume/point_check.h"
#include "fcl_stpbv/volume/rolling_ball.h"
#include "fcl_stpbv/volume/surface_height.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

// Largest difference of the support functions over the normals of one hull edge. These normals form an arc
// about the edge. For all of them the hull's support function is that of the edge's points, such as `p`. The
// difference grows with the angle where the surface point lies ahead of the edge, on the side to which the
// normal turns.
double largestOverEdge(const StpBv& volume, const Vector3d& p, const Vector3d& u, const Vector3d& start,
                       double turn) {
  const Vector3d side = u.cross(start);
  int patch = -1;
  const auto normal = [&](double angle) {
    return Vector3d(std::cos(angle) * start + std::sin(angle) * side);
  };
  const auto excess = [&](double angle) {
    const Vector3d n = normal(angle);
    patch = volume.owner(n, patch);
    return n.dot(volume.patch(patch).anchor - p) + supportAboveAnchor(volume, patch, n);
  };
  const auto ahead = [&](double angle) {
    const Vector3d n = normal(angle);
    patch = volume.owner(n, patch);
    const Vector3d x = corePoint(volume, patch, n);
    return (x - p).dot(u.cross(n));
  };
  constexpr int kPieces = 8;
  double best = std::max(excess(0), excess(turn));
  for (int k = 0; k < kPieces; ++k) {
    double low = turn * k / kPieces, high = turn * (k + 1) / kPieces;
    best = std::max(best, excess(high));
    if (!(ahead(low) > 0 && ahead(high) < 0)) continue;
    for (int round = 0; round < 50; ++round) {
      const double middle = 0.5 * (low + high);
      (ahead(middle) > 0 ? low : high) = middle;
    }
    best = std::max(best, excess(low));
  }
  return best;
}

// Quadrature of degree five on a triangle: seven points in barycentric coordinates, with their weights.
struct TrianglePoint {
  double a, b, c, weight;
};
constexpr double kA1 = 0.059715871789770, kB1 = 0.470142064105115, kA2 = 0.797426985353087,
                 kB2 = 0.101286507323456;
constexpr double kW0 = 0.225, kW1 = 0.132394152788506, kW2 = 0.125939180544827;
constexpr std::array<TrianglePoint, 7> kTriangle{{{1.0 / 3, 1.0 / 3, 1.0 / 3, kW0},
                                                  {kA1, kB1, kB1, kW1},
                                                  {kB1, kA1, kB1, kW1},
                                                  {kB1, kB1, kA1, kW1},
                                                  {kA2, kB2, kB2, kW2},
                                                  {kB2, kA2, kB2, kW2},
                                                  {kB2, kB2, kA2, kW2}}};

// Mean height of a spindle over the segment between its vertices. The spindle's outline is an arc of radius
// R.
double meanOverSegment(const StpBv& volume) {
  const Radii& radii = volume.radii();
  const Patch patch = volume.patch(volume.edgePatch(0));
  const double half = halfLength(patch, radii);
  constexpr int kPieces = 1000;
  double sum = 0;
  for (int k = 0; k < kPieces; ++k) {
    const double s = half * (2 * (k + 0.5) / kPieces - 1);
    sum += radii.r + sag(patch, radii) - s * s / (radii.R + std::sqrt(radii.R * radii.R - s * s));
  }
  return sum / kPieces;
}

}  // namespace

CoveredHull::CoveredHull(const std::vector<Vector3d>& points) : points_(points) {
  const double flat = flatRadius(points);
  RolledHull hull = flatHull(points);
  faces_ = std::move(hull.faces);
  corners_ = std::move(hull.vertices);
  for (const std::vector<int>& ring : faces_) {
    const std::array<int, 3> wide = wideTriangle(points_, ring);
    // The normal of the ball that the builder uses. The cross product of a sliver's sides would be only
    // rounding.
    normals_.push_back(TouchingBall(at(wide[0]), at(wide[1]), at(wide[2]), flat).normalAt(at(ring[0])));
  }
  halfEdges_ = pairHalfEdges(points_, faces_, normals_, flat);
}

double CoveredHull::max(const StpBv& volume) const {
  const auto along = [&](const Vector3d& n, int vertex) {
    const int patch = volume.owner(n);
    return n.dot(volume.patch(patch).anchor - at(vertex)) + supportAboveAnchor(volume, patch, n);
  };
  double best = 0;
  if (faces_.empty()) {  // a point or a segment: counts as one edge with normals all the way round
    const Vector3d edge = at(corners_.back()) - at(corners_.front());
    const Vector3d u = edge.norm() > 0 ? Vector3d(edge.normalized()) : Vector3d::UnitX();
    best = std::max(along(u, corners_.back()), along(-u, corners_.front()));
    return std::max(best, largestOverEdge(volume, at(corners_.front()), u, u.unitOrthogonal(), kTwoPi));
  }
  for (std::size_t f = 0; f < faces_.size(); ++f) best = std::max(best, along(normals_[f], faces_[f][0]));
  for (std::size_t h = 0; h < halfEdges_.size(); ++h) {
    const HalfEdge& edge = halfEdges_[h];
    if (edge.twin < static_cast<int>(h)) continue;
    const std::vector<int>& ring = faces_[static_cast<std::size_t>(edge.face)];
    const Vector3d& a = at(ring[static_cast<std::size_t>(edge.corner)]);
    const Vector3d& b = at(ring[(static_cast<std::size_t>(edge.corner) + 1) % ring.size()]);
    const Vector3d u = (b - a).normalized(), n = normals_[static_cast<std::size_t>(edge.face)];
    best = std::max(best, largestOverEdge(volume, a, u, (n - n.dot(u) * u).normalized(), edge.turn));
  }
  return best;
}

double CoveredHull::mean(const StpBv& volume) const {
  if (faces_.empty()) return volume.edgeCount() == 1 ? meanOverSegment(volume) : volume.radii().r;
  double area = 0, sum = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    int patch = -1;
    const std::vector<int>& ring = faces_[f];
    for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
      const Vector3d a = at(ring[0]), b = at(ring[k]), c = at(ring[k + 1]);
      const double size = 0.5 * (b - a).cross(c - a).norm();
      area += size;
      for (const TrianglePoint& t : kTriangle) {
        const SurfaceHeight over = surfaceHeight(volume, t.a * a + t.b * b + t.c * c, normals_[f], patch);
        patch = over.patch;
        sum += size * t.weight * over.height;
      }
    }
  }
  return sum / area;
}

OverCover overCover(const StpBv& volume) { return overCover(volume, volume.vertices()); }

OverCover overCover(const StpBv& volume, const std::vector<Vector3d>& cloud) {
  if (cloud.empty()) throw Error("cannot measure the over-cover of no points: give at least one");
  requireFinite(cloud);
  return CoveredHull(cloud).of(volume);
}

}  // namespace fcl_stpbv
