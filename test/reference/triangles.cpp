// The distance of two triangles: 0 if an edge of one goes through the other, otherwise the least distance of
// all corners from the other triangle and of all edges from all edges.
#include "test/reference/triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fcl_stpbv::test {
namespace {

long double toSegment(const PointL& p, const PointL& a, const PointL& b) {
  const PointL d = b - a;
  const long double squared = d.squaredNorm();
  const long double t = squared > 0 ? std::clamp((p - a).dot(d) / squared, 0.0L, 1.0L) : 0.0L;
  return (a + t * d - p).norm();
}

/// Distance of two segments: between the lines' nearest points if both lie inside the segments, otherwise
/// from an end of one.
long double ofSegments(const PointL& a, const PointL& b, const PointL& c, const PointL& d) {
  long double best =
      std::min({toSegment(a, c, d), toSegment(b, c, d), toSegment(c, a, b), toSegment(d, a, b)});
  const PointL u = b - a, v = d - c, w = c - a;
  const long double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
  if (!(det > 0)) return best;
  const long double s = (w.dot(u) * vv - w.dot(v) * uv) / det, t = (w.dot(u) * uv - w.dot(v) * uu) / det;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1) best = std::min(best, (a + s * u - c - t * v).norm());
  return best;
}

/// Whether the point, in the triangle's plane, is on the inner side of all edges.
bool above(const PointL& p, const TriangleL& t, const PointL& normal) {
  for (std::size_t i = 0; i < 3; ++i)
    if (normal.dot((t[(i + 1) % 3] - t[i]).cross(p - t[i])) < 0) return false;
  return true;
}

bool pierces(const PointL& a, const PointL& b, const TriangleL& t) {
  const PointL normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const long double x = normal.dot(a - t[0]), y = normal.dot(b - t[0]);
  if (x * y > 0 || x == y) return false;
  return above(a + x / (x - y) * (b - a), t, normal);
}

}  // namespace

long double referenceDistance(const PointL& p, const TriangleL& t) {
  const PointL normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const long double length = normal.norm();
  if (length > 0 && above(p, t, normal)) return std::abs(normal.dot(p - t[0])) / length;
  return std::min({toSegment(p, t[0], t[1]), toSegment(p, t[1], t[2]), toSegment(p, t[2], t[0])});
}

long double referenceDistance(const TriangleL& a, const TriangleL& b) {
  long double best = std::numeric_limits<long double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    if (pierces(a[i], a[(i + 1) % 3], b) || pierces(b[i], b[(i + 1) % 3], a)) return 0;
    best = std::min({best, referenceDistance(a[i], b), referenceDistance(b[i], a)});
    for (std::size_t j = 0; j < 3; ++j)
      best = std::min(best, ofSegments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
  }
  return best;
}

TriangleL placed(const Eigen::Isometry3d& pose, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                 const Eigen::Vector3d& c) {
  const Eigen::Matrix<long double, 3, 3> turn = pose.linear().cast<long double>();
  const PointL shift = pose.translation().cast<long double>();
  const auto place = [&](const Eigen::Vector3d& p) -> PointL { return turn * p.cast<long double>() + shift; };
  return {place(a), place(b), place(c)};
}

std::vector<TriangleL> boxTriangles(const Eigen::Isometry3d& pose, const Eigen::Vector3d& sides) {
  std::vector<TriangleL> all;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.5, 0.5}) {
      const auto corner = [&](double u, double v) {
        Eigen::Vector3d p;
        p[axis] = side;
        p[(axis + 1) % 3] = u;
        p[(axis + 2) % 3] = v;
        return Eigen::Vector3d(p.cwiseProduct(sides));
      };
      all.push_back(placed(pose, corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5)));
      all.push_back(placed(pose, corner(-0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)));
    }
  return all;
}

}  // namespace fcl_stpbv::test
