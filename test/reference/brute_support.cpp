// 1. Candidates for the lowest centre: below one point; the lowest point on the circle of two points'
// spheres; both points where three points' spheres meet.
// 2. The result is the lowest candidate that lies in the balls around all points.
#include "test/reference/brute_support.h"

#include <Eigen/Geometry>
#include <cmath>

namespace fcl_stpbv::test {

long double bruteSupport(const std::vector<Eigen::Vector3d>& points, double r, double R,
                         const Eigen::Vector3d& normal) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  std::vector<Vector> p;
  for (const Eigen::Vector3d& x : points) p.push_back(x.cast<long double>() - points[0].cast<long double>());
  const Vector n = normal.cast<long double>().normalized();
  const long double rho = static_cast<long double>(R) - static_cast<long double>(r);
  long double scale = 0;
  for (const Vector& x : p) scale = std::max(scale, (x - p[0]).norm());
  // For |C - p|^2 <= rho^2, with the rounding of this evaluation.
  const long double slack = 1e-17L * (rho * rho + scale * scale);

  long double best = 1e30L;
  const auto take = [&](const Vector& c) {
    if (!(n.dot(c) < best)) return;
    for (const Vector& x : p)
      if ((c - x).squaredNorm() > rho * rho + slack) return;
    best = n.dot(c);
  };
  const std::size_t count = p.size();
  for (std::size_t i = 0; i < count; ++i) {
    take(p[i] - rho * n);
    for (std::size_t j = i + 1; j < count; ++j) {
      const Vector edge = p[j] - p[i], u = edge.normalized();
      const long double kappa2 = rho * rho - edge.squaredNorm() / 4;
      const Vector across = n - n.dot(u) * u;
      if (across.norm() > 0) take(p[i] + edge / 2 - std::sqrt(std::max(0.0L, kappa2)) * across.normalized());
      for (std::size_t k = j + 1; k < count; ++k) {
        const Vector v = p[k] - p[i], normalOfPlane = edge.cross(v);
        const long double n2 = normalOfPlane.squaredNorm();
        if (!(n2 > 1e-24L * edge.squaredNorm() * v.squaredNorm())) continue;
        const Vector o =
            (edge.squaredNorm() * v.cross(normalOfPlane) + v.squaredNorm() * normalOfPlane.cross(edge)) /
            (2 * n2);
        const long double height2 = rho * rho - o.squaredNorm();
        if (height2 < 0) continue;
        const Vector up = std::sqrt(height2 / n2) * normalOfPlane;
        take(p[i] + o + up);
        take(p[i] + o - up);
      }
    }
  }
  return static_cast<long double>(R) + best + n.dot(points[0].cast<long double>());
}

}  // namespace fcl_stpbv::test
