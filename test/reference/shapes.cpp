// Boxes, prisms, geodesic spheres by splitting an icosahedron, and random clouds. Random numbers come only
// from the bits of a Mersenne twister. Also rotations and poses for moving bodies.
#include "test/reference/shapes.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace fcl_stpbv::test {

using Eigen::Vector3d;

Cloud box(double x, double y, double z) {
  Cloud points;
  for (int i = 0; i < 8; ++i)
    points.emplace_back((i & 1 ? 0.5 : -0.5) * x, (i & 2 ? 0.5 : -0.5) * y, (i & 4 ? 0.5 : -0.5) * z);
  return points;
}

Cloud plate(double x, double y, double thickness) { return box(x, y, thickness); }

Cloud needle(double length, double width) { return box(width, width, length); }

Cloud cylinder(double radius, double length, int sides) {
  Cloud points;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2.0 * M_PI * i / sides;
    for (const double z : {-0.5 * length, 0.5 * length})
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return points;
}

Cloud geodesicSphere(double radius, int subdivisions) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  Cloud points;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-g, g}) {
      points.emplace_back(0, a, b);
      points.emplace_back(a, b, 0);
      points.emplace_back(b, 0, a);
    }
  std::vector<std::array<int, 3>> faces;
  const auto adjacent = [&](int i, int j) {
    return (points[static_cast<std::size_t>(i)] - points[static_cast<std::size_t>(j)]).norm() < 2.1;
  };
  for (int i = 0; i < 12; ++i)
    for (int j = i + 1; j < 12; ++j)
      for (int k = j + 1; k < 12; ++k)
        if (adjacent(i, j) && adjacent(j, k) && adjacent(i, k)) faces.push_back({i, j, k});

  for (int level = 0; level < subdivisions; ++level) {
    for (auto& p : points) p.normalize();
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int i, int j) {
      const auto [entry, isNew] =
          middles.try_emplace({std::min(i, j), std::max(i, j)}, static_cast<int>(points.size()));
      if (isNew) {
        const Vector3d sum = points[static_cast<std::size_t>(i)] + points[static_cast<std::size_t>(j)];
        points.push_back(sum.normalized());
      }
      return entry->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& f : faces) {
      const int a = middle(f[0], f[1]), b = middle(f[1], f[2]), c = middle(f[2], f[0]);
      finer.push_back({f[0], a, c});
      finer.push_back({f[1], b, a});
      finer.push_back({f[2], c, b});
      finer.push_back({a, b, c});
    }
    faces = std::move(finer);
  }
  for (auto& p : points) p = p.normalized() * radius;
  return points;
}

Cloud randomHull(int count, const Vector3d& half, std::uint64_t seed) {
  Random random(seed);
  Cloud points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-half.x(), half.x());
    const double y = random.uniform(-half.y(), half.y());
    const double z = random.uniform(-half.z(), half.z());
    points.emplace_back(x, y, z);
  }
  return points;
}

double Random::uniform(double low, double high) {
  return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
}

double Random::normal() {
  const double u = uniform(0.0, 1.0), v = uniform(0.0, 1.0);
  return std::sqrt(-2.0 * std::log(1.0 - u)) * std::cos(2.0 * M_PI * v);
}

Vector3d Random::direction() {
  for (;;) {
    const double x = normal(), y = normal(), z = normal();
    const Vector3d n(x, y, z);
    if (n.norm() > 1e-3) return n.normalized();
  }
}

Eigen::Matrix3d Random::rotation() {
  const Vector3d axis = direction();
  return Eigen::AngleAxisd(uniform(0.0, 2.0 * M_PI), axis).toRotationMatrix();
}

Eigen::Matrix3d Random::rotation(double angle) {
  return Eigen::AngleAxisd(angle, direction()).toRotationMatrix();
}

Eigen::Matrix3d rotationBetween(const Vector3d& from, const Vector3d& to) {
  const Vector3d across = from.cross(to);
  const double angle = std::atan2(across.norm(), from.dot(to));
  return Eigen::AngleAxisd(angle, across.stableNormalized()).toRotationMatrix();
}

Eigen::Isometry3d pose(const Eigen::Matrix3d& rotation, const Vector3d& translation) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = rotation;
  result.translation() = translation;
  return result;
}

Eigen::Isometry3d at(double x, double y, double z) { return pose(Eigen::Matrix3d::Identity(), {x, y, z}); }

Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, int component, double step) {
  Eigen::Isometry3d result = pose;
  if (component < 3)
    result.translation()[component] += step;
  else
    result.linear() =
        Eigen::AngleAxisd(step, Vector3d::Unit(component - 3)).toRotationMatrix() * pose.linear();
  return result;
}

}  // namespace fcl_stpbv::test
