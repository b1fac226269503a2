// A convex cell of space between cutting planes, as a polyhedron of corners and faces.
// 1. Start: the mesh's box, a little larger.
// 2. above(): clip each face by the plane and join the new corners to a face. If a mesh is given, test
//    whether each corner on the cut is inside it.
#include "fcl_stpbv/parts/cell.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// Sorts points of one plane around their middle.
template <class Place>
void sortAround(std::vector<int>& ring, const Vector3d& normal, Place place) {
  Vector3d middle = Vector3d::Zero();
  for (const int i : ring) middle += place(i);
  middle /= static_cast<double>(ring.size());
  const Vector3d u = normal.unitOrthogonal(), v = normal.cross(u);
  const auto angle = [&](int i) { return std::atan2(v.dot(place(i) - middle), u.dot(place(i) - middle)); };
  std::sort(ring.begin(), ring.end(), [&](int a, int b) { return angle(a) < angle(b); });
}

}  // namespace

Cell::Cell(const MeshSolid& mesh) {
  const Vector3d size = mesh.high() - mesh.low();
  const Vector3d margin = Vector3d::Constant(0.01 * size.norm());
  const Vector3d low = mesh.low() - margin, high = mesh.high() + margin;
  for (int k = 0; k < 8; ++k)
    corners_.push_back(
        {{k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z()}, false});
  faces_ = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
}

Cell Cell::above(const CutPlane& plane, double slack, const MeshSolid* mesh) const {
  Cell out;
  std::vector<double> height;
  for (const Corner& c : corners_) {
    const double h = plane.height(c.point);
    height.push_back(std::abs(h) <= slack ? 0 : h);
  }
  std::vector<int> number(corners_.size(), -1), cap;
  const auto keep = [&](int i) {
    if (number[at(i)] < 0) {
      number[at(i)] = static_cast<int>(out.corners_.size());
      out.corners_.push_back(corners_[at(i)]);
      if (height[at(i)] == 0) cap.push_back(number[at(i)]);
    }
    return number[at(i)];
  };
  std::map<std::pair<int, int>, int> crossings;
  const auto cross = [&](int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [place, isNew] = crossings.try_emplace({low, high}, static_cast<int>(out.corners_.size()));
    if (isNew) {
      const double first = height[at(low)], second = height[at(high)];
      const Vector3d& from = corners_[at(low)].point;
      const Vector3d p = from + first / (first - second) * (corners_[at(high)].point - from);
      out.corners_.push_back({p, mesh && mesh->side(p) != MeshSolid::Side::outside});
      cap.push_back(place->second);
    }
    return place->second;
  };
  for (const std::vector<int>& face : faces_) {
    std::vector<int> ring;
    for (std::size_t k = 0; k < face.size(); ++k) {
      const int a = face[k], b = face[(k + 1) % face.size()];
      if (height[at(a)] >= 0) ring.push_back(keep(a));
      if (height[at(a)] * height[at(b)] < 0) ring.push_back(cross(a, b));
    }
    if (ring.size() >= 3) out.faces_.push_back(std::move(ring));
  }
  if (cap.size() >= 3) {
    sortAround(cap, plane.normal, [&](int i) { return out.corners_[at(i)].point; });
    out.faces_.push_back(std::move(cap));
  }
  return out;
}

std::pair<double, double> Cell::reach(const CutPlane& plane) const {
  double low = kInfinity, high = -low;
  for (const Corner& c : corners_) {
    low = std::min(low, plane.height(c.point));
    high = std::max(high, plane.height(c.point));
  }
  return {low, high};
}

Vector3d Cell::middle() const {
  Vector3d sum = Vector3d::Zero();
  for (const Corner& c : corners_) sum += c.point;
  return sum / static_cast<double>(corners_.size());
}

std::vector<Vector3d> Cell::corners() const {
  std::vector<Vector3d> out;
  for (const Corner& corner : corners_) out.push_back(corner.point);
  return out;
}

std::vector<Vector3d> Cell::enclosedCorners() const {
  std::vector<Vector3d> points;
  for (const Corner& c : corners_)
    if (c.enclosed) points.push_back(c.point);
  return points;
}

}  // namespace fcl_stpbv::detail
