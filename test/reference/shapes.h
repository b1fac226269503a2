// Point clouds and poses that every test room builds its bodies from. Metres, centred on the origin.
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

/// `count` points, uniform in a box with these half sides; the inner ones drop out when a volume is built.
Cloud randomHull(int count, const Eigen::Vector3d& half, std::uint64_t seed);

/// Random numbers that are the same on every platform: the standard leaves its distributions to the library.
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

/// The rotation by the smallest angle that takes one direction to another, which is not its opposite.
/// Compiled once: Eigen's `Quaterniond::FromTwoVectors` brings a singular value decomposition, ten seconds of
/// compiling, into each file that names it.
Eigen::Matrix3d rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// A pose from its rotation and translation.
Eigen::Isometry3d pose(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation);

/// A pose without a turn.
Eigen::Isometry3d at(double x, double y, double z);

/// A body's pose after a small step: a shift along axis 0, 1 or 2 of the world, or with 3, 4 or 5 a turn
/// about it through the body's origin.
Eigen::Isometry3d moved(const Eigen::Isometry3d& pose, int component, double step);

}  // namespace fcl_stpbv::test
