// The box around a body's vertices: two edges give its axes, the vertices its extents.
#include <Eigen/Geometry>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/query_tables.h"

namespace fcl_stpbv::detail {

using Eigen::Matrix3d;
using Eigen::Vector3d;

BodyBox boxAround(const std::vector<Vector3d>& vertices, const std::vector<std::array<int, 2>>& edges) {
  constexpr double kThin = 1e-3;       // share of the longest side: a thinner box has a less certain normal
  constexpr double kRounding = 4e-15;  // share of the size: the rounding of a corner in the box's axes
  constexpr double kTelling = 1.5;     // ratio of the longest to the shortest side
  constexpr double kLine = 1e-9;       // share of the longest edge: a smaller part across it may be rounding
  // The longest of the edges' parts perpendicular to `u`; a zero vector if there is none.
  const auto longestAcross = [&](const Vector3d& u) {
    Vector3d longest(0, 0, 0);
    for (const auto& [from, to] : edges) {
      const Vector3d e = vertices[at(to)] - vertices[at(from)], across = e - e.dot(u) * u;
      if (across.squaredNorm() > longest.squaredNorm()) longest = across;
    }
    return longest;
  };
  Matrix3d axes = Matrix3d::Identity();
  const Vector3d longest = longestAcross(Vector3d::Zero()), u = longest.normalized(),
                 across = longestAcross(u);
  if (longest.norm() > 0) {
    const bool isLine = !(across.norm() > kLine * longest.norm());
    const Vector3d third = u.cross(isLine ? u.unitOrthogonal() : across).normalized();
    axes << u, third.cross(u), third;
  }

  Vector3d least = Vector3d::Constant(kInfinity), most = -least;
  for (const Vector3d& p : vertices) {
    least = least.cwiseMin(axes.transpose() * p);
    most = most.cwiseMax(axes.transpose() * p);
  }
  const Vector3d middle = 0.5 * (most + least), half = 0.5 * (most - least);
  BodyBox box;
  for (int i = 0; i < 3; ++i) box.axis[i] = pack(axes.col(i));
  box.centre = pack(axes * middle);
  box.half = pack(half);
  box.isTelling = half.maxCoeff() > kTelling * half.minCoeff();
  const double rounding = kRounding * (middle.lpNorm<1>() + half.sum());
  unsigned corners = 0;  // one bit for each corner
  for (const Vector3d& p : vertices) {
    const Vector3d q = axes.transpose() * p - middle;
    if (((q.cwiseAbs() - half).cwiseAbs().array() <= rounding).all())
      corners |= 1u << ((q.x() > 0 ? 1 : 0) + (q.y() > 0 ? 2 : 0) + (q.z() > 0 ? 4 : 0));
  }
  box.isHull = vertices.size() == 8 && corners == 0xff && half.minCoeff() > kThin * half.maxCoeff();
  return box;
}

}  // namespace fcl_stpbv::detail
