// Cuts triangles by a plane: clips each to the upper side and splits the result into triangles. A crossing is
// computed once per edge, from the lower index to the higher, so that neighbours and both sides share the
// same point.
#include "fcl_stpbv/parts/plane_cut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <unordered_map>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

class Cutter {
 public:
  Cutter(const TriangleSoup& soup, const CutPlane& plane, double slack) : soup_(soup), plane_(plane) {
    height_.reserve(soup.points.size());
    side_.reserve(soup.points.size());
    for (const Vector3d& p : soup.points) {
      height_.push_back(plane.height(p));
      side_.push_back(static_cast<signed char>((height_.back() > slack) - (height_.back() < -slack)));
    }
  }

  // Calls `use` with each triangle's corners on or above the plane: a ring of 3 or 4 indices. Indices of
  // crossings come after those of the soup's points.
  template <class Use>
  void run(Use use) {
    std::array<int, 4> ring{};
    for (std::size_t t = 0; t < soup_.triangles.size(); ++t) {
      const std::array<int, 3>& corners = soup_.triangles[t];
      const auto [low, high] = std::minmax({side(corners[0]), side(corners[1]), side(corners[2])});
      if (high < 0 || (high == 0 && low < 0) || (high == 0 && !bordersAbove(corners))) continue;
      std::size_t count = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = corners[k], b = corners[(k + 1) % 3];
        if (low == 0 || side(a) >= 0) ring[count++] = a;
        if (side(a) * side(b) < 0) ring[count++] = crossing(a, b);
      }
      use(t, ring, count);
    }
  }

  const std::vector<Vector3d>& crossings() const { return cut_; }

 private:
  signed char side(int point) const { return side_[at(point)]; }

  // Whether a triangle on the plane belongs to the upper side. A triangle without a normal belongs to one
  // side too, and to the other side if the plane is turned over.
  bool bordersAbove(const std::array<int, 3>& t) const {
    const Vector3d &a = soup_.points[at(t[0])], &b = soup_.points[at(t[1])], &c = soup_.points[at(t[2])];
    const Vector3d& n = plane_.normal;
    const double along = (b - a).cross(c - a).dot(n);
    if (along != 0) return along < 0;
    return n.x() != 0 ? n.x() > 0 : n.y() != 0 ? n.y() > 0 : n.z() > 0;
  }

  // The crossing of an edge, computed from the lower index to the higher, so that both triangles of an edge
  // and both sides of the plane get the same point.
  int crossing(int a, int b) {
    const auto key = std::minmax(a, b);
    const long name = static_cast<long>(key.first) * static_cast<long>(soup_.points.size()) + key.second;
    const auto [place, isNew] = found_.try_emplace(name, static_cast<int>(soup_.points.size() + cut_.size()));
    if (isNew) {
      const double first = height_[at(key.first)], second = height_[at(key.second)];
      const Vector3d& p = soup_.points[at(key.first)];
      cut_.push_back(p + first / (first - second) * (soup_.points[at(key.second)] - p));
    }
    return place->second;
  }

  const TriangleSoup& soup_;
  const CutPlane& plane_;
  std::vector<double> height_;
  std::vector<signed char> side_;
  std::vector<Vector3d> cut_;
  std::unordered_map<long, int> found_;
};

}  // namespace

TriangleSoup above(const TriangleSoup& soup, const CutPlane& plane, double slack) {
  Cutter cutter(soup, plane, slack);
  TriangleSoup out;
  cutter.run([&](std::size_t t, const std::array<int, 4>& ring, std::size_t count) {
    for (std::size_t k = 1; k + 1 < count; ++k) {
      out.triangles.push_back({ring[0], ring[k], ring[k + 1]});
      out.facet.push_back(soup.facet[t]);
    }
  });
  const int own = static_cast<int>(soup.points.size());
  std::vector<int> number(soup.points.size() + cutter.crossings().size(), -1);
  for (std::array<int, 3>& triangle : out.triangles) {
    for (int& corner : triangle) {
      int& place = number[at(corner)];
      if (place < 0) {
        place = static_cast<int>(out.points.size());
        out.points.push_back(corner < own ? soup.points[at(corner)] : cutter.crossings()[at(corner - own)]);
      }
      corner = place;
    }
  }
  return out;
}

void pointsAbove(const TriangleSoup& soup, const CutPlane& plane, double slack,
                 std::vector<Vector3d>& points) {
  Cutter cutter(soup, plane, slack);
  std::vector<char> used(soup.points.size(), 0);
  cutter.run([&](std::size_t, const std::array<int, 4>& ring, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k)
      if (at(ring[k]) < used.size()) used[at(ring[k])] = 1;
  });
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i]) points.push_back(soup.points[i]);
  points.insert(points.end(), cutter.crossings().begin(), cutter.crossings().end());
}

}  // namespace fcl_stpbv::detail
