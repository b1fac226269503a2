// Makes triangles of the surface for viewing, with a grid over each patch's region of normals. Points on a
// common boundary are identified by the vertex, edge or face they belong to, not by their coordinates. So
// neighbours share them even if points are very close together, and the mesh is closed.
#include "fcl_stpbv/volume/tessellate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/patch_view.h"
#include "fcl_stpbv/volume/regions.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

class Tessellator {
 public:
  Tessellator(const StpBv& volume, double angle) : volume_(volume), angle_(angle) {
    // A region between two arcs with one step each would become two triangles back to back.
    std::vector<int> arcs(static_cast<std::size_t>(volume.vertexCount()), 0);
    for (const StpBv::Edge& edge : volume.edges())
      for (const int v : edge.vertex) arcs[at(v)] += steps(edge.turn) > 1 ? 3 : 1;
    leastRound_ = std::count(arcs.begin(), arcs.end(), 2) > 0 ? 2 : 1;
  }

  TriangleMesh run() {
    for (int e = 0; e < volume_.edgeCount(); ++e) addEdge(e);
    const std::vector<Region> all = regions(volume_);
    for (std::size_t k = 0; k < all.size(); ++k) addRegion(all[k], static_cast<int>(k));
    return std::move(mesh_);
  }

 private:
  // Identifies a point by its kind and by indices within that kind.
  enum Kind { atVertex, atCorner, besideVertex, besideFace, within, onRing };
  using Place = std::array<int, 4>;

  const StpBv::Edge& edge(int e) const { return volume_.edges()[at(e)]; }
  /// Half the turn of the normals along an edge (rad).
  double halfTurn(int e) const { return std::asin(std::min(1.0, volume_.patch(volume_.edgePatch(e)).sine)); }

  int steps(double turn) const { return std::max(1, static_cast<int>(std::ceil(turn / angle_))); }
  /// Steps around an edge, and along the arcs of the vertex regions at both of its ends.
  int stepsRound(double turn) const { return std::max(leastRound_, steps(turn)); }
  /// Steps along an edge, and along the side of each of its faces. At least two, because the surface bulges
  /// most over the middle.
  int stepsAlong(int e) const { return std::max(2, steps(2 * halfTurn(e))); }

  int point(const Place& place, int patch, const Vector3d& n) {
    const auto [found, isNew] = known_.try_emplace(place, static_cast<int>(mesh_.vertices.size()));
    if (isNew) mesh_.vertices.push_back(onCore(patch, n) + volume_.radii().r * n);
    return found->second;
  }

  // corePoint(), except that a face's height is computed from the part across the axis. The length of the
  // normal is off by rounding, and the height would be off by R times as much.
  Vector3d onCore(int patch, const Vector3d& n) const {
    if (volume_.kind(patch) != PatchKind::face) return corePoint(volume_, patch, n);
    const Patch face = volume_.patch(patch);
    const Vector3d turned = n - face.axis, across = turned - turned.dot(face.axis) * face.axis;
    return face.anchor + volume_.radii().rho * (across - turned.squaredNorm() / 2 * face.axis);
  }

  // A corner where four patches meet. Without a margin a vertex's patch is just the vertex.
  Place corner(int face, int vertex) const {
    return volume_.radii().r > 0 ? Place{atCorner, face, vertex, 0} : Place{atVertex, vertex, 0, 0};
  }

  // A place on the boundary between the region of an edge and that of one of its ends: step i of `round`,
  // from the edge's first face to its second. On a spindle the last step is the first one again.
  Place besideEnd(int e, std::size_t end, int i, int round) const {
    const StpBv::Edge& of = edge(e);
    if (volume_.radii().r == 0) return {atVertex, of.vertex[end], 0, 0};
    if (of.face[0] < 0) return {besideVertex, e, static_cast<int>(end), i % round};
    if (i == 0 || i == round) return corner(of.face[i == 0 ? 0 : 1], of.vertex[end]);
    return {besideVertex, e, static_cast<int>(end), i};
  }

  // A place on the boundary between the region of an edge and that of one of its faces: step j of `along`,
  // from the edge's first vertex.
  Place besideSide(int e, std::size_t side, int j, int along) const {
    if (j == 0 || j == along) return corner(edge(e).face[side], edge(e).vertex[j == 0 ? 0 : 1]);
    return {besideFace, e, static_cast<int>(side), j};
  }

  void triangle(int a, int b, int c) {
    if (a != b && b != c && c != a) mesh_.triangles.push_back({a, b, c});
  }

  void addEdge(int e) {
    const Arc arc = edgeArc(volume_, e);
    const int patch = volume_.edgePatch(e), round = stepsRound(arc.turn), along = stepsAlong(e);
    const double half = halfTurn(e);
    const bool hasFaces = edge(e).face[0] >= 0;
    const auto at = [&](int i, int j) {
      const double tilt = half * (2.0 * j / along - 1);
      const Place place = j == 0 || j == along     ? besideEnd(e, j == 0 ? 0 : 1, i, round)
                          : hasFaces && i == 0     ? besideSide(e, 0, j, along)
                          : hasFaces && i == round ? besideSide(e, 1, j, along)
                                                   : Place{within, e, hasFaces ? i : i % round, j};
      // At an end the vertex's patch gives the point, because along the edge points are off by R times the
      // rounding of the normal.
      const int own = j == 0 ? edge(e).vertex[0] : j == along ? edge(e).vertex[1] : patch;
      return point(place, own,
                   std::cos(tilt) * arc.at(static_cast<double>(i) / round) + std::sin(tilt) * arc.axis);
    };
    for (int i = 0; i < round; ++i)
      for (int j = 0; j < along; ++j) {
        triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
  }

  // stepsOf(): number of steps along an arc of a region's boundary, as for the edge beside it. placeOn(): the
  // place of step i.
  int stepsOf(const Region& region, const Arc& arc) const {
    return arc.edge >= 0 && volume_.kind(region.patch) == PatchKind::face ? stepsAlong(arc.edge)
                                                                          : stepsRound(arc.turn);
  }
  Place placeOn(const Region& region, const Arc& arc, int i, int count) const {
    // The rim that both halves of a sphere share; they run along it in opposite directions.
    if (arc.edge < 0) {
      const int k = arc.axis.z() > 0 ? i : count - i;
      return volume_.radii().r > 0 ? Place{besideVertex, 0, 0, k % count} : Place{atVertex, 0, 0, 0};
    }
    const StpBv::Edge& beside = edge(arc.edge);
    if (volume_.kind(region.patch) == PatchKind::face) {
      const std::size_t side = volume_.facePatch(beside.face[0]) == region.patch ? 0 : 1;
      return besideSide(arc.edge, side, side == 0 ? i : count - i, count);
    }
    const std::size_t end = beside.vertex[0] == region.patch ? 0 : 1;
    return besideEnd(arc.edge, end, end == 1 ? i : count - i, count);
  }

  // Divides a region by rings about its centre. A point on a ring is identified by the boundary point that it
  // corresponds to.
  void addRegion(const Region& region, int number) {
    double widest = 0;
    for (const Arc& arc : region.boundary)
      widest = std::max(widest, std::acos(std::clamp(region.centre.dot(arc.start), -1.0, 1.0)));
    const bool isPoint = volume_.radii().r == 0 && volume_.kind(region.patch) == PatchKind::vertex;
    const int rings = isPoint ? 1 : steps(widest);
    const int centre = point(isPoint ? Place{atVertex, region.patch, 0, 0} : Place{within, -1, number, 0},
                             region.patch, region.centre);
    for (std::size_t a = 0; a < region.boundary.size(); ++a) {
      const Arc& arc = region.boundary[a];
      const int count = stepsOf(region, arc);
      const auto at = [&](int k, int i) {
        if (k == 0) return centre;
        const double part = static_cast<double>(i) / count;
        const int rim = point(placeOn(region, arc, i, count), region.patch, region.normal(a, part, 1));
        if (k == rings) return rim;
        return point({onRing, number, k, rim}, region.patch,
                     region.normal(a, part, static_cast<double>(k) / rings));
      };
      for (int k = 0; k < rings; ++k)
        for (int i = 0; i < count; ++i) {
          triangle(at(k, i), at(k + 1, i), at(k + 1, i + 1));
          triangle(at(k, i), at(k + 1, i + 1), at(k, i + 1));
        }
    }
  }

  const StpBv& volume_;
  double angle_;
  int leastRound_ = 1;
  TriangleMesh mesh_;
  std::map<Place, int> known_;
};

}  // namespace

TriangleMesh tessellate(const StpBv& volume, double angle) {
  requireNumber("tessellate: angle", angle, 0.02, 1);
  return Tessellator(volume, angle).run();
}

}  // namespace fcl_stpbv
