// The regions of normals as areas bounded by arcs. A face's region is bounded by its sides' planes, a
// vertex's region by its edges' cones. Each region has a centre for drawing and integrating.
#include "fcl_stpbv/volume/regions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// The centre is the mean of the boundary. If the region is like half the sphere, its boundary has no clear
// mean, and the centre is the mean of the region. This works because the region is convex.
void setCentre(Region* region) {
  constexpr double kTellsNothing = 0.1;
  Vector3d sum = Vector3d::Zero();
  double length = 0;
  for (const Arc& arc : region->boundary) {
    const double weight = std::max(arc.turn, 1e-12);
    for (int k = 0; k < 8; ++k) sum += weight * arc.at((k + 0.5) / 8);
    length += 8 * weight;
  }
  region->centre = (sum.norm() > kTellsNothing * length ? sum : vectorArea(*region)).normalized();
}

}  // namespace

Vector3d Arc::at(double part) const {
  const double angle = turn * part;
  const Vector3d along = axis.dot(start) * axis, across = start - along;
  return along + std::cos(angle) * across + std::sin(angle) * axis.cross(across);
}

Vector3d Region::normal(std::size_t arc, double part, double out) const {
  return (centre + out * (boundary[arc].at(part) - centre)).normalized();
}

Vector3d vectorArea(const Region& region) {
  Vector3d sum = Vector3d::Zero();
  for (const Arc& arc : region.boundary) {
    const double along = arc.axis.dot(arc.start), across2 = 1 - along * along;
    const Vector3d chord = arc.at(1) - arc.start;
    sum += across2 * arc.turn * arc.axis + along * arc.axis.cross(chord);
  }
  return 0.5 * sum;
}

double leastCosine(const StpBv& volume) {
  double cosine = 1;
  for (int e = 0; e < volume.edgeCount(); ++e)
    cosine = std::min(cosine, volume.patch(volume.edgePatch(e)).kappa / volume.radii().rho);
  return cosine;
}

Arc edgeArc(const StpBv& volume, int edge) {
  const StpBv::Edge& e = volume.edges()[at(edge)];
  const Vector3d u = volume.patch(volume.edgePatch(edge)).axis;
  Vector3d start = u.unitOrthogonal();
  if (e.face[0] >= 0) {
    const Vector3d m = volume.corner(e.face[0], e.vertex[0]);
    start = (m - m.dot(u) * u).normalized();
  }
  return {start, u, e.turn};
}

std::vector<Region> regions(const StpBv& volume) {
  std::vector<Region> all(static_cast<std::size_t>(volume.vertexCount()));
  for (int v = 0; v < volume.vertexCount(); ++v) all[at(v)].patch = v;
  if (volume.edgeCount() == 0) {
    const Vector3d z = Vector3d::UnitZ();
    return {{0, z, {{Vector3d::UnitX(), z, kTwoPi}}}, {0, -z, {{Vector3d::UnitX(), -z, kTwoPi}}}};
  }
  // Key: a face and the vertex where the edge starts in the face's ring.
  std::map<std::pair<int, int>, int> edgeFrom;
  for (int e = 0; e < volume.edgeCount(); ++e) {
    const StpBv::Edge& edge = volume.edges()[at(e)];
    const Arc middle = edgeArc(volume, e);
    const double sine =
        0.5 * (at(volume, edge.vertex[1]) - at(volume, edge.vertex[0])).norm() / volume.radii().rho;
    const double cosine = volume.patch(volume.edgePatch(e)).kappa / volume.radii().rho;
    // Seen in the direction of the edge's turn, the second vertex lies on the left, the first one on the
    // right.
    const Vector3d u = middle.axis;
    all[at(edge.vertex[1])].boundary.push_back({cosine * middle.start + sine * u, u, edge.turn, e});
    all[at(edge.vertex[0])].boundary.push_back({cosine * middle.at(1) - sine * u, -u, edge.turn, e});
    // In the ring of face[0] the edge runs from its first vertex, in the ring of face[1] from its second.
    for (const std::size_t side : {0u, 1u}) edgeFrom[{edge.face[side], edge.vertex[side]}] = e;
  }
  for (int f = 0; f < volume.faceCount(); ++f) {
    const StpBv::Ring& ring = volume.faces()[at(f)];
    Region region{volume.facePatch(f), Vector3d::Zero(), {}};
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const int i = ring[k], j = ring[(k + 1) % ring.size()];
      const Vector3d from = volume.corner(f, i), to = volume.corner(f, j);
      // Both normals are offsets of the two points from the ball's centre, so their plane contains the edge.
      // The difference of the points keeps the digits that the difference of the normals loses if R is large.
      const Vector3d across = from.cross(at(volume, j) - at(volume, i));
      const double turn = std::atan2(across.norm() / volume.radii().rho, from.dot(to));
      region.boundary.push_back({from, across.normalized(), turn, edgeFrom.at({f, i})});
    }
    all.push_back(std::move(region));
  }
  for (Region& region : all) setCentre(&region);
  return all;
}

}  // namespace fcl_stpbv::detail
