// Largest distance of a surface from a mesh, by branch and bound over the surface's triangles:
// 1. the upper bound of a triangle is the distance of its centre plus its radius, or the largest distance of
//    its corners from one mesh triangle (the distance from a convex set is convex);
// 2. the distance of the centre is a lower bound for the whole surface;
// 3. split the triangle with the largest bound until both bounds agree:
//    - a part over one mesh triangle and near enough to it is cut off and finished;
//    - if a few mesh triangles cross it, it is cut along one of them;
//    - if none does, it is completely inside or completely outside;
//    - otherwise it is halved across its longest edge.
//    Halving alone would need ten times as many triangles for each digit, if a hull's face ends at the border
//    of a flat part or leaves the solid.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/parts/cut_triangle.h"
#include "fcl_stpbv/parts/known_excess.h"
#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/parts/touching_triangles.h"
#include "fcl_stpbv/volume/point_check.h"
#include "fcl_stpbv/volume/rolling_ball.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

class Bound {
 public:
  // `known`, null for none, of the same mesh as a solid.
  Bound(const MeshSolid& mesh, const ExcessOptions& options, KnownExcess* known)
      : mesh_(mesh), options_(options), known_(known) {
    inside_ = options.filled && mesh.hasInside();
    slack_ = 1e-9 * (mesh.high() - mesh.low()).norm();
  }

  MeshExcess over(const std::vector<Triangle>& surface) {
    gatherRoots(surface);
    const bool isEnough = !measureRoots();
    while (!isEnough && !open_.empty() && queries_ < options_.queries && best_.lower <= options_.enough) {
      if (settled(open_.front().bound)) break;  // and no other is above it
      std::pop_heap(open_.begin(), open_.end());
      const Open worst = open_.back();
      open_.pop_back();
      split(worst);
    }
    if (!open_.empty()) best_.upper = std::max(best_.upper, open_.front().bound);
    best_.upper = isEnough ? kInfinity : std::max(best_.upper, best_.lower);
    keepOpen();
    return best_;
  }

 private:
  using Open = OpenPiece;
  struct Root {
    const Triangle* triangle;
    double bound;
    TriangleExcess* known;
  };

  // The surface's triangles, first those that may be the farthest. A point of a triangle is nowhere farther
  // from the nearest corner than 1/sqrt(3) of the longest side, as in the middle of an equilateral one. What
  // is far from the mesh is mostly under large ones.
  void gatherRoots(const std::vector<Triangle>& surface) {
    if (known_)
      known_->makeRoom();
    else
      own_.resize(surface.size());
    for (const Triangle& t : surface) {
      const double longest = std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
      Root root{&t, options_.corners + 0.5774 * longest, known_ ? &known_->of(t) : &own_[roots_.size()]};
      if (root.known->isKnown) {
        root.bound = std::min(root.bound, root.known->upper());
        if (root.known->lower > best_.lower) best_.lower = root.known->lower, best_.where = root.known->where;
      }
      roots_.push_back(root);
    }
    std::stable_sort(roots_.begin(), roots_.end(),
                     [](const Root& a, const Root& b) { return a.bound > b.bound; });
  }

  // A first measure of each triangle that may be the farthest. False where one is farther than enough.
  bool measureRoots() {
    for (std::size_t r = 0; r < roots_.size(); ++r) {
      if (best_.lower > options_.enough) return false;
      const Root& root = roots_[r];
      TriangleExcess& known = *root.known;
      if (root.bound <= best_.lower) {  // nor can those that follow be farther
        best_.upper = std::max(best_.upper, root.bound);
        break;
      }
      if (known.isKnown && settled(known.settled)) {  // on with its pieces
        best_.upper = std::max(best_.upper, known.settled);
        for (Open& piece : std::exchange(known.open, {})) {
          piece.root = r;
          if (!settle(piece)) push(piece);
        }
        continue;
      }
      known.isKnown = true;
      known.settled = 0;
      known.open.clear();
      add({root.bound, *root.triangle, -1, r});
    }
    return best_.lower <= options_.enough;
  }

  // Returns the open pieces to their triangles.
  void keepOpen() {
    if (!known_) return;
    for (Open& piece : open_) roots_[piece.root].known->open.push_back(piece);
    known_->addPieces(open_.size());
  }

  bool settled(double bound) const {
    return bound <= best_.lower * (1 + options_.relative) + options_.absolute;
  }

  // Largest distance of a polygon from the mesh's triangle `near`. It is reached at a corner.
  template <class Polygon>
  double farthest(const Polygon& polygon, int near) const {
    double most = 0;
    for (const Vector3d& p : polygon) most = std::max(most, mesh_.distance(p, near));
    return most;
  }

  void add(Open piece) {
    const Triangle& t = piece.corners;
    const Vector3d middle = (t[0] + t[1] + t[2]) / 3;
    double radius = 0;
    for (const Vector3d& p : t) radius = std::max(radius, (p - middle).norm());
    if (piece.near >= 0) {
      piece.bound = std::min(piece.bound, farthest(t, piece.near));
      if (settle(piece)) return;
    }
    const auto [distance, near] =
        mesh_.nearest(middle, piece.near >= 0 ? piece.near : last_, best_.lower - radius);
    last_ = near;
    ++queries_;
    piece.bound = std::min(piece.bound, distance + radius);
    if (near != piece.near) piece.bound = std::min(piece.bound, farthest(t, near));
    piece.near = near;
    double here = distance;
    if (inside_ && distance > best_.lower && mesh_.side(middle) == MeshSolid::Side::enclosed) {
      here = 0;  // all points around the middle that are nearer to it than the surface are inside too
      piece.bound = std::min(piece.bound, std::max(0.0, radius - distance));
    }
    if (here > best_.lower) {
      TriangleExcess& known = *roots_[piece.root].known;
      best_.lower = known.lower = here;
      best_.where = known.where = middle;
    }
    if (!settle(piece)) push(piece);
  }

  void push(const Open& piece) {
    open_.push_back(piece);
    std::push_heap(open_.begin(), open_.end());
  }

  bool settle(const Open& piece) { return settle(piece, piece.bound); }
  bool settle(const Open& piece, double bound) {
    if (!settled(bound)) return false;
    best_.upper = std::max(best_.upper, bound);
    double& most = roots_[piece.root].known->settled;
    most = std::max(most, bound);
    return true;
  }

  void add(const CutTriangle& ring, const Open& of) {
    for (std::size_t k = 1; k + 1 < ring.size(); ++k)
      add({of.bound, {ring[0], ring[k], ring[k + 1]}, of.near, of.root});
  }

  // Cuts off the part that lies over the piece's mesh triangle, if all of that part is near enough to it. The
  // distance from it is largest at a corner. False if that part is only a small share of the piece.
  bool carve(const Open& piece) {
    constexpr double kWorth = 0.1;  // share of the piece's area: cutting off less is no better than halving
    const Triangle& m = mesh_.triangles()[at(piece.near)];
    const Vector3d normal = (m[1] - m[0]).cross(m[2] - m[0]);
    if (!(normal.norm() > 0)) return false;
    const Triangle& t = piece.corners;
    const double area = CutTriangle(t).area(), worth = kWorth * area;
    if (!(area > slack_ * ((t[1] - t[0]).norm() + (t[2] - t[0]).norm())))
      return false;  // a needle is not cut
    if (0.5 * normal.norm() < worth) return false;
    std::array<CutTriangle, 3> outside;
    CutTriangle over(piece.corners);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3d away = (m[(k + 1) % 3] - m[k]).cross(normal).normalized();
      std::tie(outside[k], over) = over.cut(away, away.dot(m[k]), slack_);
    }
    if (over.area() < worth) return false;
    const double height = farthest(over, piece.near);
    if (!settle(piece, std::min(height, piece.bound))) return false;
    for (const CutTriangle& rest : outside) add(rest, piece);
    return true;
  }

  // If the mesh's surface does not cross the piece, the whole piece is inside the solid if one point is. The
  // test uses a slightly smaller piece, moved slightly away from mesh triangles that touch it from one side;
  // so the whole piece is within that length of the inside. If a mesh triangle crosses the piece, the piece
  // is cut there. False if neither helps.
  bool settleInside(const Open& piece) {
    ++queries_;
    const Triangle& t = piece.corners;
    const Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]).normalized();
    const Vector3d middle = (t[0] + t[1] + t[2]) / 3;
    double inner = kInfinity, outer = 0;  // radii of circles about the middle
    for (std::size_t k = 0; k < 3; ++k) {
      inner = std::min(inner, normal.cross(t[(k + 1) % 3] - t[k]).normalized().dot(middle - t[k]));
      outer = std::max(outer, (t[k] - middle).norm());
    }
    const double smaller = 4 * slack_;
    if (!(inner > 4 * smaller) || mesh_.side(middle) == MeshSolid::Side::outside) return false;
    const double bound = smaller / inner * outer + 4 * slack_;
    if (!settled(bound)) return false;
    const TouchingTriangles found = trianglesTouching(mesh_, {t, normal, middle, smaller, slack_});
    if (found.crossings > TouchingTriangles::kMost) return false;
    if (found.crossings > 0) return cutAlong(piece, found.crossing);
    if (found.above && found.below) return false;
    const auto encloses = [&](double shift) {
      return mesh_.side(middle + shift * slack_ * normal) == MeshSolid::Side::enclosed;
    };
    const bool aside = found.above || found.below || found.flat;
    if (!(aside ? (!found.above && encloses(2.5)) || (!found.below && encloses(-2.5)) : encloses(0)))
      return false;
    return settle(piece, std::min(piece.bound, bound));
  }

  bool cutAlong(const Open& piece, int m) {
    const Triangle& x = mesh_.triangles()[at(m)];
    const Vector3d along = (x[1] - x[0]).cross(x[2] - x[0]).normalized();
    const auto [above, below] = CutTriangle(piece.corners).cut(along, along.dot(x[0]), slack_);
    if (above.empty() || below.empty()) return false;
    add(above, piece);
    add(below, piece);
    return true;
  }

  void split(const Open& piece) {
    if (carve(piece) || (inside_ && settleInside(piece))) return;
    const Triangle& t = piece.corners;  // halve across the longest edge
    std::size_t k = 0;
    for (std::size_t e = 1; e < 3; ++e)
      if ((t[(e + 1) % 3] - t[e]).squaredNorm() > (t[(k + 1) % 3] - t[k]).squaredNorm()) k = e;
    const Vector3d &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
    const Vector3d half = 0.5 * (a + b);
    add({piece.bound, {a, half, c}, piece.near, piece.root});
    add({piece.bound, {half, b, c}, piece.near, piece.root});
  }

  const MeshSolid& mesh_;
  const ExcessOptions& options_;
  KnownExcess* known_;
  std::vector<TriangleExcess> own_;  // of the roots, where there is no `known`
  std::vector<Root> roots_;
  bool inside_;
  double slack_;  // far above rounding, far below any requested accuracy (m)
  MeshExcess best_;
  std::vector<Open> open_;
  long queries_ = 0;
  int last_ = -1;  // the mesh's triangle that was nearest in the last query
};

}  // namespace

MeshExcess excessOf(const std::vector<Triangle>& surface, const MeshSolid& mesh,
                    const ExcessOptions& options) {
  return Bound(mesh, options, nullptr).over(surface);
}

MeshExcess detail::excessOf(const std::vector<Triangle>& surface, const MeshSolid& mesh,
                            const ExcessOptions& options, KnownExcess& known) {
  return Bound(mesh, options, &known).over(surface);
}

std::vector<Triangle> hullTriangles(const std::vector<Vector3d>& points) {
  if (points.empty()) throw Error("no points have no hull: give at least one");
  requireFinite(points);
  const RolledHull hull = convexHull(points);
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
