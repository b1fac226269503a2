// Point clouds and poses from which all tests build their bodies. In metres, centred on the origin.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <random>
#include <vector>

namespace fcl_stpbv::test {

using Cloud = std::vector<Eigen::Vector3d>;

/// The eight corners of a box with these side lengths.
Cloud box(double x, double y, double z);

/// A box 1 mm thick: two opposite faces, and side faces a thousand times narrower.
Cloud plate(double x, double y, double thickness = 1e-3);

/// A long thin box along z.
Cloud needle(double length, double width = 2e-3);

/// The corners of a prism with a regular polygon as its base, axis along z.
Cloud cylinder(double radius, double length, int sides = 32);

/// An icosahedron whose faces were split in four `subdivisions` times, vertices pushed onto the sphere:
/// 12, 42, 162, 642, 2562, ... points.
Cloud geodesicSphere(double radius, int subdivisions);

/// `count` points, uniform in a box with these half sides. The inner ones are dropped when a volume is built.
Cloud randomHull(int count, const Eigen::Vector3d& half, std::uint64_t seed);

/// Random numbers that are the same on every platform, unlike those of the standard library's distributions.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high);
  double normal();
  int below(int count) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(count)); }
  Eigen::Vector3d direction();
  Eigen::Matrix3d rotation();
  /// A rotation by `angle` about a random axis.
  Eigen::Matrix3d rotation(double angle);

 private:
  std::mt19937_64 engine_;
};

/// The rotation by the smallest angle that takes one direction to another, which must not be opposite. It is
/// compiled once, because Eigen's `Quaterniond::FromTwoVectors` includes a singular value decomposition,
/// which takes ten seconds of compiling in each file that uses it.
Eigen::Matrix3d rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// A pose from its rotation and translation.
Eigen::Isometry3d pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation);

/// A pose without a rotation.
Eigen::Isometry3d at(double x, double y, double z);

/// A body's pose after a small step: a translation along axis 0, 1 or 2 of the world, or with 3, 4 or 5 a
/// rotation about that axis through the body's origin.
Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, int component, double step);

}  // namespace fcl_stpbv::test
