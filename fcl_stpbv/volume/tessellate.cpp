// Triangles of the surface for viewing: a grid over each patch's region of normals. Neighbours share the
// steps along their boundary, so the mesh is closed.
#include "fcl_stpbv/volume/tessellate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/volume/patch_view.h"
#include "fcl_stpbv/volume/regions.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

class Tessellator {
 public:
  Tessellator(const StpBv& volume, double angle) : volume_(volume), angle_(std::clamp(angle, 0.02, 1.0)) {
    // What rounding can part at a boundary: a few units of the coordinates and of rho times the normal.
    constexpr double kRounding = 2e-14, kWidest = 1e-6;
    const double size = volume.enclosingRadius() + volume.radii().rho + volume.centre().norm();
    grid_ = std::min(kRounding / leastCosine(volume), kWidest) * size;
    // A region between two arcs of one step each would be two triangles back to back.
    std::vector<int> arcs(static_cast<std::size_t>(volume.vertexCount()), 0);
    for (const StpBv::Edge& edge : volume.edges())
      for (const int v : edge.vertex) arcs[static_cast<std::size_t>(v)] += steps(edge.turn) > 1 ? 3 : 1;
    leastRound_ = std::count(arcs.begin(), arcs.end(), 2) > 0 ? 2 : 1;
  }

  TriangleMesh run() {
    for (int e = 0; e < volume_.edgeCount(); ++e) addEdge(e);
    for (const Region& region : regions(volume_)) addRegion(region);
    return std::move(mesh_);
  }

 private:
  int steps(double turn) const { return std::max(1, static_cast<int>(std::ceil(turn / angle_))); }
  /// Around an edge, and along the arcs of vertex regions on both of its ends.
  int stepsRound(double turn) const { return std::max(leastRound_, steps(turn)); }

  // Points are shared by place: patches meet at equal points but for rounding (docs/theory.md, 3).
  int point(int patch, const Vector3d& n) {
    const Vector3d x = corePoint(volume_, patch, n) + volume_.radii().r * n;
    const auto key = [&](double c) { return static_cast<long long>(std::llround(c / grid_)); };
    const Vector3d local = x - volume_.centre();
    // A point near a cell's border may have been filed in the next cell.
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const auto found = filed_.find({key(local.x()) + dx, key(local.y()) + dy, key(local.z()) + dz});
          if (found != filed_.end()) return found->second;
        }
    const int index = static_cast<int>(mesh_.vertices.size());
    filed_[{key(local.x()), key(local.y()), key(local.z())}] = index;
    mesh_.vertices.push_back(x);
    return index;
  }

  void triangle(int a, int b, int c) {
    if (a != b && b != c && c != a) mesh_.triangles.push_back({a, b, c});
  }

  void addEdge(int e) {
    const Arc arc = edgeArc(volume_, e);
    const int patch = volume_.edgePatch(e);
    const double half = std::asin(std::min(1.0, volume_.patch(patch).sine));
    const int round = stepsRound(arc.turn), along = steps(2 * half);
    const auto at = [&](int i, int j) {
      const double tilt = half * (2.0 * j / along - 1);
      return point(patch,
                   std::cos(tilt) * arc.at(static_cast<double>(i) / round) + std::sin(tilt) * arc.axis);
    };
    for (int i = 0; i < round; ++i)
      for (int j = 0; j < along; ++j) {
        triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
        triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
      }
  }

  void addRegion(const Region& region) {
    double widest = 0;
    for (const Arc& arc : region.boundary)
      widest = std::max(widest, std::acos(std::clamp(region.centre.dot(arc.start), -1.0, 1.0)));
    const int rings = steps(widest), centre = point(region.patch, region.centre);
    for (std::size_t a = 0; a < region.boundary.size(); ++a) {
      const Arc& arc = region.boundary[a];
      // The same steps as the neighbouring edge's, so that the boundary has the same points on both sides.
      const int round =
          volume_.kind(region.patch) == PatchKind::vertex ? stepsRound(arc.turn) : steps(arc.turn);
      const auto at = [&](int k, int i) {
        return k == 0 ? centre
                      : point(region.patch, region.normal(a, static_cast<double>(i) / round,
                                                          static_cast<double>(k) / rings));
      };
      for (int k = 0; k < rings; ++k)
        for (int i = 0; i < round; ++i) {
          triangle(at(k, i), at(k + 1, i), at(k + 1, i + 1));
          triangle(at(k, i), at(k + 1, i + 1), at(k, i + 1));
        }
    }
  }

  const StpBv& volume_;
  double angle_, grid_;
  int leastRound_ = 1;
  TriangleMesh mesh_;
  std::map<std::tuple<long long, long long, long long>, int> filed_;
};

}  // namespace

TriangleMesh tessellate(const StpBv& volume, double angle) {
  requireNumber("tessellate: angle", angle, 0.02, 1);
  return Tessellator(volume, angle).run();
}

}  // namespace fcl_stpbv
