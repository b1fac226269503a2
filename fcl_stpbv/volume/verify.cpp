// A built volume checks itself:
// 1. no vertex above the ball of its own or a neighbouring face (which decides for all, by Blaschke's
//    theorem), no given point above the surface;
// 2. the solid angles of all regions, by Gauss-Bonnet, sum to 4 pi;
// 3. patches meet along their boundaries to rounding.
#include "fcl_stpbv/volume/verify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/join_faces.h"
#include "fcl_stpbv/volume/measure.h"
#include "fcl_stpbv/volume/patch_view.h"
#include "fcl_stpbv/volume/point_tree.h"
#include "fcl_stpbv/volume/regions.h"
#include "fcl_stpbv/volume/rolling_ball.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

// Angle by which a walk along unit direction a must turn left, about the outward normal n, to follow b: (-pi,
// pi].
double exteriorAngle(const Vector3d& n, const Vector3d& a, const Vector3d& b) {
  return std::atan2(n.dot(a.cross(b)), a.dot(b));
}

std::string brief(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

// Largest height of a vertex over the ball of its own face or of one beside it. That decides for all vertices
// and all balls where the regions of normals tile the sphere once: the patches are then one closed convex
// surface whose radii of curvature are at most R, and any ball of radius R that touches such a surface from
// around holds it (Blaschke).
double vertexHeight(const StpBv& volume) {
  double worst = -std::numeric_limits<double>::infinity();
  const auto consider = [&](int f, int vertex) {
    const Patch face = volume.patch(volume.facePatch(f));
    const Vector3d q = at(volume, vertex) - face.anchor;
    worst = std::max(worst, q.squaredNorm() / (2 * volume.radii().rho) + q.dot(face.axis));
  };
  for (int f = 0; f < volume.faceCount(); ++f)
    for (const int vertex : volume.faces()[static_cast<std::size_t>(f)]) consider(f, vertex);
  for (const StpBv::Edge& edge : volume.edges()) {
    if (edge.face[0] < 0) continue;
    for (const std::size_t side : {0u, 1u}) {
      const StpBv::Ring& ring = volume.faces()[static_cast<std::size_t>(edge.face[side])];
      const auto from =
          static_cast<std::size_t>(std::find(ring.begin(), ring.end(), edge.vertex[side]) - ring.begin());
      consider(edge.face[1 - side], ring[(from + 2) % ring.size()]);
      consider(edge.face[1 - side], ring[(from + ring.size() - 1) % ring.size()]);
    }
  }
  return worst;
}

// Largest height over the surface pulled in by `margin`, of the volume's own vertices and of a cloud's. A
// vertex is on its own patch; any other point may come closest to an edge, and of a cloud only the hull
// counts.
double containmentOf(const StpBv& volume, const std::vector<Vector3d>& cloud, double margin) {
  double worst = vertexHeight(volume);
  if (cloud.empty()) return worst;
  const PointTree tree(volume.vertices());
  std::vector<int> near;
  for (const int i : rollBall(cloud).vertices) {
    const Vector3d& p = cloud[static_cast<std::size_t>(i)];
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
  const auto compare = [&](int a, int b, const Vector3d& n, double allowed) {
    const double gap = (corePoint(volume, a, n) - corePoint(volume, b, n)).norm();
    result.largest = std::max(result.largest, gap);
    result.ok = result.ok && gap <= allowed;
  };
  for (int e = 0; e < volume.edgeCount(); ++e) {
    const StpBv::Edge& edge = volume.edges()[static_cast<std::size_t>(e)];
    const double sine =
        0.5 * (at(volume, edge.vertex[1]) - at(volume, edge.vertex[0])).norm() / volume.radii().rho;
    const double cosine = volume.patch(volume.edgePatch(e)).kappa / volume.radii().rho;
    const Arc arc = edgeArc(volume, e);
    // A joined face's ball, and with it the edge's arc, may be tilted by as much as the join allows.
    const auto isJoined = [&](int face) {
      return face >= 0 && volume.faces()[static_cast<std::size_t>(face)].size() > 3;
    };
    const double tilted = rounding + 2 * kJoinTilt * volume.radii().rho;
    const double beside = isJoined(edge.face[0]) || isJoined(edge.face[1]) ? tilted : rounding;
    for (int k = 0; k <= 8; ++k) {
      const Vector3d w = arc.at(k / 8.0);
      compare(volume.edgePatch(e), edge.vertex[0], cosine * w - sine * arc.axis, rounding);
      compare(volume.edgePatch(e), edge.vertex[1], cosine * w + sine * arc.axis, rounding);
      if (k > 0 && k < 8)
        compare(volume.edgePatch(e), volume.owner(w), w, beside);  // the region holds its arc
    }
    if (edge.face[0] < 0) continue;
    for (const int face : edge.face) {
      const Vector3d a = volume.corner(face, edge.vertex[0]), b = volume.corner(face, edge.vertex[1]);
      for (int k = 0; k <= 4; ++k)
        compare(volume.edgePatch(e), volume.facePatch(face), ((1 - k / 4.0) * a + k / 4.0 * b).normalized(),
                isJoined(face) ? tilted : rounding);
    }
  }
  return result;
}

}  // namespace

std::vector<double> solidAngles(const StpBv& volume) {
  std::vector<double> angles(static_cast<std::size_t>(volume.patchCount()), 0.0);
  if (volume.edgeCount() == 0) {
    angles[0] = 4 * kPi;
    return angles;
  }
  // By Gauss-Bonnet: 2 pi minus the boundary's turning. Faces turn at their corners only; a vertex region is
  // bounded by the cones of its edges, small circles, which turn along the way too.
  for (int v = 0; v < volume.vertexCount(); ++v) angles[static_cast<std::size_t>(v)] = 2 * kPi;
  for (int e = 0; e < volume.edgeCount(); ++e) {
    const StpBv::Edge& edge = volume.edges()[static_cast<std::size_t>(e)];
    const double sine =
        0.5 * (at(volume, edge.vertex[1]) - at(volume, edge.vertex[0])).norm() / volume.radii().rho;
    angles[static_cast<std::size_t>(volume.edgePatch(e))] = 2 * sine * edge.turn;
    for (const int v : edge.vertex) angles[static_cast<std::size_t>(v)] -= sine * edge.turn;
  }
  for (int f = 0; f < volume.faceCount(); ++f) {
    const StpBv::Ring& ring = volume.faces()[static_cast<std::size_t>(f)];
    double& area = angles[static_cast<std::size_t>(volume.facePatch(f))];
    area = 2 * kPi;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const int before = ring[(k + ring.size() - 1) % ring.size()], here = ring[k],
                after = ring[(k + 1) % ring.size()];
      const Vector3d n = volume.corner(f, here);
      const Vector3d arrive = at(volume, here) - at(volume, before),
                     leave = at(volume, after) - at(volume, here);
      const double turn =
          exteriorAngle(n, n.cross(arrive.cross(n)).normalized(), n.cross(leave.cross(n)).normalized());
      area -= turn;
      // At the same corner the vertex region turns between the cones of the two edges.
      angles[static_cast<std::size_t>(here)] -=
          exteriorAngle(n, leave.cross(n).normalized(), arrive.cross(n).normalized()) + kPi;
    }
  }
  return angles;
}

Verification verify(const StpBv& volume, const std::vector<Vector3d>& points) {
  return verify(volume, points, volume.radii().r);
}

Verification verify(const StpBv& volume, const std::vector<Vector3d>& points, double margin) {
  Verification result;
  std::vector<Vector3d> all = volume.vertices();
  all.insert(all.end(), points.begin(), points.end());
  result.containment = containmentOf(volume, points, margin);
  double sum = 0, least = 0;
  for (const double angle : solidAngles(volume)) sum += angle, least = std::min(least, angle);
  result.solidAngleError = sum - 4 * kPi;

  // Near the smallest R an edge's normals lie close to its line, by the cosine kappa/rho.
  double cosine = 1;
  for (int e = 0; e < volume.edgeCount(); ++e)
    cosine = std::min(cosine, volume.patch(volume.edgePatch(e)).kappa / volume.radii().rho);
  // Heights and boundaries: a few roundings of lengths up to the body's size and, for normals, of rho times
  // their rounding. The circle around an edge, kappa = sqrt(rho^2 - half^2), is off by the three roundings
  // under its root, of rho^2 each, by 2 kappa.
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const double length = touchTolerance(all) + (8 + 1.5 / cosine) * kEpsilon * volume.radii().rho;
  const BoundaryGap boundaries = boundaryGapOf(volume, 4 * length);
  result.boundaryGap = boundaries.largest;
  // Angles: each corner is rounded by a few units, and an edge's turn by one over the cosine as much.
  const double angle = 1e-13 * (16 + volume.edgeCount()) + 4 * kEpsilon / cosine;
  // A point may have vanished into a vertex next to it, and the vertex may be as much outside a face that was
  // joined.
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
