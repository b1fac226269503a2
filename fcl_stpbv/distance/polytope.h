// A convex polytope that grows over points outside it, for searches of the nearest point of its surface.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

namespace fcl_stpbv {

/// A convex polytope, triangles only, in arrays of fixed size.
class Polytope {
 public:
  struct Face {
    std::array<std::int16_t, 3> corner;
    Eigen::Vector3d normal;  // unit, outward
    double distance;         // of its plane from the origin, negative with the origin beyond it
  };

  /// Whether the origin must be inside from the start; rounding that puts it outside then ends the search.
  enum class Origin { inside, anywhere };

  explicit Polytope(const std::array<Eigen::Vector3d, 4>& corner, Origin origin = Origin::inside)
      : origin_(origin) {
    for (const Eigen::Vector3d& p : corner) point_[static_cast<std::size_t>(points_++)] = p;
    const bool flip = (corner[1] - corner[0]).cross(corner[2] - corner[0]).dot(corner[3] - corner[0]) > 0.0;
    const std::int16_t i1 = flip ? 2 : 1, i2 = flip ? 1 : 2;
    sound_ = add(0, i1, i2) && add(0, i2, 3) && add(i2, i1, 3) && add(i1, 0, 3);
  }

  /// False once a face could not be made: too flat, or no room.
  bool sound() const { return sound_; }

  /// The face nearest to the origin of those not put aside; at an infinite distance if all are.
  Face nearest() const {
    const std::size_t i = nearestIndex();
    Face f = face_[i];
    f.distance = rank_[i];
    return f;
  }

  /// Takes the nearest face out of the search.
  void putAside() { rank_[nearestIndex()] = std::numeric_limits<double>::infinity(); }

  /// Takes `p` into the hull. False where it is inside already, or in a face's plane to rounding, or without room.
  bool expand(const Eigen::Vector3d& p) {
    if (points_ == kMaxPoints) return sound_ = false;
    const std::int16_t index = static_cast<std::int16_t>(points_);
    point_[static_cast<std::size_t>(points_++)] = p;
    // The sides of the faces that see `p`; those seen from both sides cancel and the rest is the horizon.
    std::array<std::array<std::int16_t, 2>, 3 * kMaxFaces> horizon;
    int sides = 0;
    const double size = p.lpNorm<1>();
    for (int i = 0; i < faces_;) {
      const Face& f = face(i);
      if (f.normal.dot(p) - f.distance <= flat_[static_cast<std::size_t>(i)] * size) {
        ++i;
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const std::int16_t from = f.corner[k], to = f.corner[(k + 1) % 3];
        int twin = 0;
        while (twin < sides && !(horizon[static_cast<std::size_t>(twin)][0] == to &&
                                 horizon[static_cast<std::size_t>(twin)][1] == from))
          ++twin;
        if (twin < sides)
          horizon[static_cast<std::size_t>(twin)] = horizon[static_cast<std::size_t>(--sides)];
        else
          horizon[static_cast<std::size_t>(sides++)] = {from, to};
      }
      --faces_;
      face_[static_cast<std::size_t>(i)] = face(faces_);
      rank_[static_cast<std::size_t>(i)] = rank_[static_cast<std::size_t>(faces_)];
      flat_[static_cast<std::size_t>(i)] = flat_[static_cast<std::size_t>(faces_)];
    }
    if (sides == 0) {
      --points_;
      sound_ = faces_ > 0;  // not seen from everywhere
      return false;
    }
    for (int i = 0; i < sides && sound_; ++i)
      sound_ = add(horizon[static_cast<std::size_t>(i)][0], horizon[static_cast<std::size_t>(i)][1], index);
    return sound_ = sound_ && faces_ > 0;
  }

 private:
  static constexpr int kMaxPoints = 400;  // some 20 are usual, hundreds where all directions are nearly as good
  static constexpr int kMaxFaces = 2 * kMaxPoints;
  static constexpr double kNarrow = 300.0;  // more would leave out points that a flat face of the bodies needs
  static constexpr double kFlat = 1e-15;  // of a point: this near to a face's plane is in it, to rounding

  std::size_t nearestIndex() const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < static_cast<std::size_t>(faces_); ++i)
      if (rank_[i] < rank_[best]) best = i;
    return best;
  }

  const Face& face(int i) const { return face_[static_cast<std::size_t>(i)]; }
  const Eigen::Vector3d& point(int i) const { return point_[static_cast<std::size_t>(i)]; }

  bool add(std::int16_t i, std::int16_t j, std::int16_t k) {
    if (faces_ == kMaxFaces) return false;
    const Eigen::Vector3d e = point(j) - point(i), f = point(k) - point(i);
    const Eigen::Vector3d normal = e.cross(f);
    const double length = normal.norm();
    if (!(length > 1e-14 * (e.squaredNorm() + f.squaredNorm()))) return false;
    const Eigen::Vector3d unit = normal / length;
    const double distance = unit.dot(point(i));
    if (origin_ == Origin::inside && !(distance >= 0.0))
      return false;  // the origin is on the surface, to rounding
    rank_[static_cast<std::size_t>(faces_)] = distance;
    // A sliver's normal is as much less certain as it is narrow.
    const double narrow = std::min((e.squaredNorm() + f.squaredNorm()) / length, kNarrow);
    flat_[static_cast<std::size_t>(faces_)] = kFlat * narrow;
    face_[static_cast<std::size_t>(faces_++)] = {{i, j, k}, unit, distance};
    return true;
  }

  std::array<Eigen::Vector3d, kMaxPoints> point_;
  std::array<Face, kMaxFaces> face_;
  std::array<double, kMaxFaces> flat_;  // height over it, as a part of a point's size, that is rounding
  std::array<double, kMaxFaces> rank_;  // distance, or infinity for a face put aside
  Origin origin_;
  int points_ = 0;
  int faces_ = 0;
  bool sound_;
};

}  // namespace fcl_stpbv
