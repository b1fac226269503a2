// A triangle's distance is its plane's if the foot lies inside, otherwise its nearest side's. The winding
// number is the sum of solid angles (Van Oosterom and Strackee, The solid angle of a plane triangle, 1983).
#include "test/reference/mesh_reference.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace fcl_stpbv::test {
namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;

Real fromSegment(const Vector& p, const Vector& a, const Vector& b) {
  const Vector d = b - a;
  const Real length2 = d.squaredNorm();
  const Real t = length2 > 0 ? (p - a).dot(d) / length2 : 0;
  return t <= 0 ? (p - a).norm() : t >= 1 ? (p - b).norm() : (p - a - t * d).norm();
}

// The plane's distance if the foot is to the left of all three sides, otherwise that of the nearest side.
Real fromTriangle(const Vector& p, const Vector& a, const Vector& b, const Vector& c) {
  const Vector n = (b - a).cross(c - a);
  const bool over = n.squaredNorm() > 0 && n.dot((b - a).cross(p - a)) >= 0 &&
                    n.dot((c - b).cross(p - b)) >= 0 && n.dot((a - c).cross(p - c)) >= 0;
  if (over) return std::abs(n.normalized().dot(p - a));
  return std::min({fromSegment(p, a, b), fromSegment(p, b, c), fromSegment(p, c, a)});
}

template <class Visit>
void eachTriangle(const TriangleMesh& mesh, Visit visit) {
  const auto corner = [&](int i) { return mesh.vertices[static_cast<std::size_t>(i)].cast<Real>(); };
  for (const auto& t : mesh.triangles) visit(corner(t[0]), corner(t[1]), corner(t[2]));
}

}  // namespace

double referenceDistance(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  Real best = std::numeric_limits<Real>::infinity();
  eachTriangle(mesh, [&](const Vector& a, const Vector& b, const Vector& c) {
    best = std::min(best, fromTriangle(p.cast<Real>(), a, b, c));
  });
  return static_cast<double>(best);
}

double referenceWinding(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  Real sum = 0;  // Van Oosterom and Strackee, The solid angle of a plane triangle, 1983
  eachTriangle(mesh, [&](const Vector& first, const Vector& second, const Vector& third) {
    const Vector x = p.cast<Real>(), a = first - x, b = second - x, c = third - x;
    const Real la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  });
  return static_cast<double>(sum / (4 * std::acos(Real(-1))));
}

double referenceSolidDistance(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  return std::abs(referenceWinding(mesh, p)) > 0.5 ? 0 : referenceDistance(mesh, p);
}

}  // namespace fcl_stpbv::test
