// Checks two poses and computes the pose of the second body in the frame of the first one.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>

#include "fcl_stpbv/packed.h"

namespace fcl_stpbv::detail {

/// A 3x3 matrix stored by its columns and its rows. So `m v` and `m^T v` are both sums of three scaled
/// vectors. That needs no horizontal sum, which would cost more than the multiplications.
class Rotation {
 public:
  Rotation() : Rotation(Packed{1, 0, 0, 0}, Packed{0, 1, 0, 0}, Packed{0, 0, 1, 0}) {}

  /// From its columns.
  Rotation(const Packed& x, const Packed& y, const Packed& z) : columns_{x, y, z} {
    const Packed even = __builtin_shufflevector(x, y, 0, 4, 2, 6),
                 odd = __builtin_shufflevector(x, y, 1, 5, 3, 7);
    rows_[0] = __builtin_shufflevector(even, z, 0, 1, 4, 7);
    rows_[1] = __builtin_shufflevector(odd, z, 0, 1, 5, 7);
    rows_[2] = __builtin_shufflevector(even, z, 2, 3, 6, 7);
  }

  /// The rotation of a pose.
  explicit Rotation(const Eigen::Isometry3d& pose)
      : Rotation(column(pose, 0), column(pose, 1), column(pose, 2)) {}

  explicit Rotation(const Eigen::Matrix3d& m) : Rotation(pack(m.col(0)), pack(m.col(1)), pack(m.col(2))) {}

  const Packed& axis(int i) const { return columns_[i]; }

  /// This rotation's inverse times the one with these columns.
  Rotation relative(const Packed& x, const Packed& y, const Packed& z) const {
    return {inverse(x), inverse(y), inverse(z)};
  }

  /// Whether each of the three columns is the cross product of the other two, up to the rounding of a product
  /// of two rotations. False for mirrored matrices and for NaN. If true, the distance to the nearest rotation
  /// is at most `kFine` (Frobenius norm).
  static bool isFine(const Packed& x, const Packed& y, const Packed& z) {
    const Packed offX = cross(y, z) - x, offY = cross(z, x) - y, offZ = cross(x, y) - z,
                 squares = offX * offX + offY * offY + offZ * offZ;
    return squares[0] + squares[1] + squares[2] <= kFine * kFine && dot(x, x) > 0.5;  // not zero
  }
  bool isFine() const { return isFine(columns_[0], columns_[1], columns_[2]); }
  static constexpr double kFine = 2e-15;

  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d m;
    m << unpack(columns_[0]), unpack(columns_[1]), unpack(columns_[2]);
    return m;
  }

  Packed operator*(const Packed& v) const { return sum(columns_, v); }
  Packed inverse(const Packed& v) const { return sum(rows_, v); }
  Eigen::Vector3d operator*(const Eigen::Vector3d& v) const { return unpack(sum(columns_, v)); }
  Eigen::Vector3d inverse(const Eigen::Vector3d& v) const { return unpack(sum(rows_, v)); }

 private:
  using Vectors = Packed[3];

  template <typename Vector>
  static Packed sum(const Vectors& m, const Vector& v) {
    return v[0] * m[0] + v[1] * m[1] + v[2] * m[2];
  }

  Vectors columns_, rows_;
};

/// Replaces a matrix by the nearest rotation, up to rounding, if every entry is within 1e-6 of it. False for
/// any other matrix: stretched, sheared, mirrored or not finite.
bool makeRotation(Rotation& rotation);

/// Bound on the coordinates of poses and vertices (m): squares must not overflow.
constexpr double kFarthest = 1e150;

/// Corrects a pose's rotation by `makeRotation` if it is off by more than rounding. False for a pose that is
/// not a rigid motion.
bool makeRigid(Eigen::Isometry3d& pose);

/// Bound on the rounding error of a gap between two cores, computed in the first one's frame. It is relative
/// to the sum of the bodies' coordinates and of the second body's origin in that frame (docs/theory.md, 5).
constexpr double kGapRounding = 40.0 * std::numeric_limits<double>::epsilon();

/// A pair of bodies in the first one's frame. So accuracy depends only on the bodies' own coordinates and
/// their mutual distance, not on the distance from the world's origin.
struct RelativePose {
  Rotation toWorld;      ///< first body's frame to the world's
  Packed origin{};       ///< of the first body's frame, in the world (m)
  Rotation rotation;     ///< second body's frame to the first one's
  Packed translation{};  ///< the second body's origin in the first one's frame (m)
  bool valid = false;  ///< both rotations are rigid (see makeRotation), and the origins are less than 1e150 m
                       ///< from the world's and from each other

  RelativePose(const Eigen::Isometry3d& poseA, const Eigen::Isometry3d& poseB) : toWorld(poseA) {
    constexpr double kFarthest2 = kFarthest * kFarthest;
    Packed x = column(poseB, 0), y = column(poseB, 1), z = column(poseB, 2);
    if (!(toWorld.isFine() && Rotation::isFine(x, y, z))) {
      Rotation b(x, y, z);
      if (!(makeRotation(toWorld) && makeRotation(b))) return;
      x = b.axis(0), y = b.axis(1), z = b.axis(2);
    }
    origin = column(poseA, 3);
    rotation = toWorld.relative(x, y, z);
    translation = toWorld.inverse(column(poseB, 3) - origin);
    valid = dot(translation, translation) < kFarthest2 && dot(origin, origin) < kFarthest2;
  }

  /// A point of the second body in the first one's frame.
  Packed placed(const Packed& p) const { return rotation * p + translation; }
  Eigen::Vector3d placed(const Eigen::Vector3d& p) const { return unpack(rotation * pack(p) + translation); }
  /// A point of the first body's frame in the second one's.
  Eigen::Vector3d inSecond(const Eigen::Vector3d& p) const {
    return rotation.inverse(Eigen::Vector3d(p - unpack(translation)));
  }
  /// The direction opposite `n`, in the second body's frame.
  Packed opposite(const Packed& n) const { return rotation.inverse(-n); }
  Eigen::Vector3d opposite(const Eigen::Vector3d& n) const { return rotation.inverse(Eigen::Vector3d(-n)); }

  /// A direction and a point of the first body's frame in the world.
  Eigen::Vector3d inWorld(const Eigen::Vector3d& p) const { return unpack(origin + toWorld * pack(p)); }
  Eigen::Vector3d normalInWorld(const Eigen::Vector3d& n) const { return (toWorld * n).normalized(); }
};

/// The same, for functions that are not compiled for wider instructions (vectorized.h).
RelativePose relativePose(const Eigen::Isometry3d& poseA, const Eigen::Isometry3d& poseB);

}  // namespace fcl_stpbv::detail
