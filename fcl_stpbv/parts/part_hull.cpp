// Convex hulls during the search, by qhull (Barber, Dobkin, Huhdanpaa 1996), which is faster than the exact
// rolling ball. Where qhull gives up, as on flat clouds, the rolling ball takes over.
#include "fcl_stpbv/parts/part_hull.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/volume/rolling_ball.h"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// Discards qhull's messages: it prints one for every flat cloud.
std::FILE* nowhere() {
  static const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen("/dev/null", "w"),
                                                                    std::fclose);
  return file.get();
}

bool byQhull(const std::vector<Vector3d>& points, PartHull& hull) {
  static_assert(sizeof(Vector3d) == 3 * sizeof(coordT), "qhull reads the points as they are");
  qhT memory;
  qhT* qh = &memory;
  qh_zero(qh, nowhere());
  char command[] = "qhull Qt";
  std::vector<Vector3d> copy(
      points);  // qhull promises not to change them, but does not say so to the compiler
  const int failed = qh_new_qhull(qh, 3, static_cast<int>(copy.size()), copy.data()->data(), False, command,
                                  nowhere(), nowhere());
  if (!failed) {
    vertexT *vertex, **vertexp;
    facetT* facet;
    Vector3d middle = Vector3d::Zero();
    FORALLvertices {
      hull.vertices.push_back(points[at(qh_pointid(qh, vertex->point))]);
      middle += hull.vertices.back();
    }
    middle /= static_cast<double>(hull.vertices.size());
    FORALLfacets {
      Triangle corners;
      std::size_t k = 0;
      FOREACHvertex_(facet->vertices) {
        if (k < 3) corners[k++] = points[at(qh_pointid(qh, vertex->point))];
      }
      hull.surface.push_back(corners);
      hull.volume +=
          std::abs((corners[0] - middle).dot((corners[1] - middle).cross(corners[2] - middle))) / 6;
    }
  }
  qh_freeqhull(qh, !qh_ALL);
  int left, blocks;
  qh_memfreeshort(qh, &left, &blocks);
  return !failed;
}

// Whether the points are within a millionth of their extent of one plane:
// qhull may then merge facets without end.
bool isNearlyFlat(const std::vector<Vector3d>& points) {
  const Vector3d& first = points.front();
  const auto farthest = [&](const auto& distance) {
    std::pair<double, Vector3d> most{0, first};
    for (const Vector3d& p : points)
      if (const double d = distance(p); d > most.first) most = {d, p};
    return most;
  };
  const auto [extent, second] = farthest([&](const Vector3d& p) { return (p - first).norm(); });
  if (!(extent > 0)) return true;
  const Vector3d along = (second - first) / extent;
  const auto [width, third] = farthest([&](const Vector3d& p) { return along.cross(p - first).norm(); });
  if (!(width > 0)) return true;
  const Vector3d normal = along.cross(third - first) / width;
  const auto [height, fourth] = farthest([&](const Vector3d& p) { return std::abs(normal.dot(p - first)); });
  return height < 1e-6 * extent;
}

}  // namespace

double PartHull::diagonal() const {
  Vector3d low = vertices.front(), high = low;
  for (const Vector3d& v : vertices) low = low.cwiseMin(v), high = high.cwiseMax(v);
  return (high - low).norm();
}

PartHull partHull(const std::vector<Vector3d>& points) {
  PartHull hull;
  if (points.size() >= 4 && !isNearlyFlat(points) && byQhull(points, hull)) return hull;
  hull = {};
  for (const int v : rollBall(points).vertices) hull.vertices.push_back(points[at(v)]);
  hull.surface = hullTriangles(hull.vertices);
  return hull;
}

}  // namespace fcl_stpbv::detail
