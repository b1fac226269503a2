// How far a surface is from a mesh at most, by branch and bound over the surface's triangles:
// 1. a triangle's bound: the distance of its middle plus its radius, or that of its corners to one mesh
//    triangle (the distance to a convex set is convex);
// 2. the middle's own distance is a lower bound of the whole;
// 3. split the triangle with the largest bound across its longest edge, until both bounds agree.
#include "fcl_stpbv/parts/mesh_excess.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/rolling_ball.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

class Bound {
 public:
  Bound(const MeshSolid& mesh, const ExcessOptions& options) : mesh_(mesh), options_(options) {
    inside_ = options.filled && mesh.pieces().closedPieces() > 0;
  }

  MeshExcess over(const std::vector<Triangle>& surface) {
    for (const Triangle& t : surface) {
      add({std::numeric_limits<double>::infinity(), t, -1});
      if (best_.lower > options_.enough)
        return {std::numeric_limits<double>::infinity(), best_.lower, best_.where};
    }
    while (!open_.empty() && queries_ < options_.queries && best_.lower <= options_.enough) {
      std::pop_heap(open_.begin(), open_.end());
      const Open worst = open_.back();
      open_.pop_back();
      if (settled(worst.bound)) {
        best_.upper = std::max(best_.upper, worst.bound);  // and no other is above it
        open_.clear();
        break;
      }
      split(worst);
    }
    if (!open_.empty()) best_.upper = std::max(best_.upper, open_.front().bound);
    best_.upper = std::max(best_.upper, best_.lower);
    return best_;
  }

 private:
  struct Open {
    double bound;
    Triangle corners;
    int near;  // a triangle of the mesh that is probably near
    bool operator<(const Open& other) const { return bound < other.bound; }
  };

  bool settled(double bound) const {
    return bound <= best_.lower * (1 + options_.relative) + options_.absolute;
  }

  void add(Open piece) {
    const Triangle& t = piece.corners;
    const Vector3d middle = (t[0] + t[1] + t[2]) / 3;
    const auto [distance, near] = mesh_.nearest(middle, piece.near);
    ++queries_;
    double radius = 0, corner = 0;
    for (const Vector3d& p : t) {
      radius = std::max(radius, (p - middle).norm());
      corner = std::max(corner, (nearestOf(mesh_.triangles()[at(near)], p) - p).norm());
    }
    piece.near = near;
    piece.bound = std::min({piece.bound, distance + radius, corner});
    double here = distance;
    if (inside_ && distance > best_.lower && mesh_.side(middle) == MeshSolid::Side::enclosed) {
      here = 0;  // and so all around that is nearer than the surface
      piece.bound = std::min(piece.bound, std::max(0.0, radius - distance));
    }
    if (here > best_.lower) {
      best_.lower = here;
      best_.where = middle;
    }
    if (settled(piece.bound)) {
      best_.upper = std::max(best_.upper, piece.bound);
      return;
    }
    open_.push_back(piece);
    std::push_heap(open_.begin(), open_.end());
  }

  void split(const Open& piece) {  // across the longest edge
    const Triangle& t = piece.corners;
    std::size_t k = 0;
    for (std::size_t e = 1; e < 3; ++e)
      if ((t[(e + 1) % 3] - t[e]).squaredNorm() > (t[(k + 1) % 3] - t[k]).squaredNorm()) k = e;
    const Vector3d &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
    const Vector3d half = 0.5 * (a + b);
    add({piece.bound, {a, half, c}, piece.near});
    add({piece.bound, {half, b, c}, piece.near});
  }

  const MeshSolid& mesh_;
  const ExcessOptions& options_;
  bool inside_;
  MeshExcess best_;
  std::vector<Open> open_;
  long queries_ = 0;
};

}  // namespace

MeshExcess excessOf(const std::vector<Triangle>& surface, const MeshSolid& mesh,
                    const ExcessOptions& options) {
  return Bound(mesh, options).over(surface);
}

std::vector<Triangle> hullTriangles(const std::vector<Vector3d>& points) {
  const RolledHull hull = rollBall(points);
  std::vector<Triangle> triangles;
  if (hull.faces.empty())
    return {{points[at(hull.vertices.front())], points[at(hull.vertices.back())],
             points[at(hull.vertices.back())]}};
  for (const std::vector<int>& ring : hull.faces)
    for (std::size_t k = 1; k + 1 < ring.size(); ++k)
      triangles.push_back({points[at(ring[0])], points[at(ring[k])], points[at(ring[k + 1])]});
  return triangles;
}

MeshExcess hullExcess(const std::vector<Vector3d>& points, const MeshSolid& mesh,
                      const ExcessOptions& options) {
  return excessOf(hullTriangles(points), mesh, options);
}

}  // namespace fcl_stpbv
