// A convex polytope that grows over points outside it, for searches of the nearest point of its surface.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "fcl_stpbv/packed.h"

namespace fcl_stpbv::detail {

/// A convex polytope, triangles only, in arrays of fixed size.
class Polytope {
 public:
  using Index = std::uint16_t;
  static constexpr Index kNone = 0xffff;
  static constexpr int kMaxPoints =
      400;  ///< some 20 are usual, hundreds where all directions are nearly as good

  struct Face {
    Eigen::Vector3d normal;       ///< unit, outward
    double distance;              ///< its corners are at least this far along `normal` (m)
    std::array<Index, 3> corner;  ///< counter-clockwise from outside

    bool has(Index point) const { return corner[0] == point || corner[1] == point || corner[2] == point; }
  };

  /// Whether the origin must be inside from the start; rounding that puts it outside then ends the search.
  enum class Origin { inside, anywhere };

  explicit Polytope(const std::array<Eigen::Vector3d, 4>& corner, Origin origin = Origin::inside)
      : origin_(origin) {
    for (const Eigen::Vector3d& p : corner) point_[at(points_++)] = pack(p);
    const bool flip = dot(cross(point(1) - point(0), point(2) - point(0)), point(3) - point(0)) > 0.0;
    const Index i1 = flip ? 2 : 1, i2 = flip ? 1 : 2;
    while (faces_ < 4) newFace();
    sound_ = set(0, 0, i1, i2) && set(1, 0, i2, 3) && set(2, i2, i1, 3) && set(3, i1, 0, 3);
    join(0, 0, 3, 0), join(0, 1, 2, 0), join(0, 2, 1, 0);
    join(1, 1, 2, 2), join(2, 1, 3, 2), join(3, 1, 1, 2);
  }

  /// False once a face could not be made: too flat, or no room.
  bool sound() const { return sound_; }

  /// The face nearest to the origin of those not put aside; at an infinite distance if all are.
  Face nearest() {
    Packed least = rank_[0];
    PackedBits four{};  // which four each is of
    for (int i = 1; 4 * i < faces_; ++i) {
      const PackedBits less = rank_[i] < least;
      least = less ? rank_[i] : least;
      four = less ? PackedBits{} + i : four;
    }
    const bool second = least[1] < least[0], fourth = least[3] < least[2];
    const double low = second ? least[1] : least[0], high = fourth ? least[3] : least[2];
    nearest_ = static_cast<int>(high < low ? 4 * four[fourth ? 3 : 2] + (fourth ? 3 : 2)
                                           : 4 * four[second ? 1 : 0] + (second ? 1 : 0));
    const Triangle& f = face(nearest_);
    return {unpack(f.normal), std::min(low, high), f.corner};
  }

  /// Takes the face that nearest() gave out of the search.
  void putAside() { setRank(nearest_, kNowhere); }

  /// The point taken in last.
  Index lastPoint() const { return static_cast<Index>(points_ - 1); }

  /// Takes `p` into the hull. False where it is inside already, or in a face's
  /// plane to rounding, or without room.
  bool expand(const Eigen::Vector3d& outside) {
    if (!sound_ || points_ == kMaxPoints) return sound_ = false;
    const Packed p = pack(outside);
    const double size = outside.lpNorm<1>();
    const auto sees = [&](int i) { return dot(face(i).normal, p) - face(i).distance > face(i).flat * size; };
    int first = nearest_;
    if (face(first).corner[0] == kNone || !sees(first))
      for (first = 0; first < faces_ && (face(first).corner[0] == kNone || !sees(first));) ++first;
    if (first == faces_) return false;

    // From face to face that sees `p`, each side in turn: what does not see it
    // comes in the order of the horizon.
    std::array<Index, 3 * kMaxFaces> open;
    std::array<Index, kMaxFaces> horizon;
    int opened = 0, sides = 0;
    const auto enter = [&](int i, int side, int count) {
      Triangle& f = face(i);
      for (int k = count; k > 0; --k) open[at(opened++)] = f.across[at(kTurn[at(side + k)])];
      f.corner[0] = kNone;
      setRank(i, kNowhere);
      free_[at(freed_++)] = static_cast<Index>(i);
    };
    enter(first, 0, 3);
    while (opened > 0) {
      const Index link = open[at(--opened)];
      const int i = link >> 2;
      if (face(i).corner[0] == kNone) continue;
      if (sees(i))
        enter(i, link & 3, 2);
      else
        horizon[at(sides++)] = link;
    }
    return sound_ = close(p, horizon.data(), sides);
  }

 private:
  struct Triangle {
    Packed normal;                // unit, outward
    double distance;              // of its plane from the origin
    double flat;                  // height over it, as a part of a point's size, that is rounding
    std::array<Index, 3> corner;  // counter-clockwise from outside; corner[0] is kNone once the face is gone
    std::array<Index, 3> across;  // what lies across the side from corner k to the next: face * 4 + its side
  };

  static constexpr int kMaxFaces = 2 * kMaxPoints;
  static constexpr double kNarrow =
      300.0;                              // more would leave out points that a flat face of the bodies needs
  static constexpr double kFlat = 1e-15;  // of a point: this near to a face's plane is in it, to rounding

  static constexpr std::array<int, 6> kTurn{0, 1, 2, 0, 1, 2};  // sides modulo 3

  static constexpr double kNowhere = std::numeric_limits<double>::infinity();
  static_assert(kMaxFaces % 4 == 0);
  void setRank(int i, double distance) { rank_[at(i) / 4][at(i) % 4] = distance; }
  /// A place for one more face, those beside it in its four without one.
  int newFace() {
    if (faces_ % 4 == 0) rank_[faces_ / 4] = Packed{} + kNowhere;
    return faces_++;
  }

  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  Triangle& face(int i) { return face_[at(i)]; }
  const Packed& point(int i) const { return point_[at(i)]; }

  void join(int i, int side, int j, int other) {
    face(i).across[at(side)] = static_cast<Index>(4 * j + other);
    face(j).across[at(other)] = static_cast<Index>(4 * i + side);
  }

  /// Faces from the sides of a horizon to `p`. False where rounding has torn the horizon.
  bool close(const Packed& p, const Index* horizon, int sides) {
    if (sides < 3) return false;
    const Index index = static_cast<Index>(points_);
    point_[at(points_++)] = p;
    int before = -1, first = -1;
    for (int i = 0; i < sides; ++i) {
      if (freed_ == 0 && faces_ == kMaxFaces) return false;
      const int j = horizon[i] >> 2, side = horizon[i] & 3,
                made = freed_ > 0 ? free_[at(--freed_)] : newFace();
      if (!set(made, face(j).corner[at(kTurn[at(side + 1)])], face(j).corner[at(side)], index)) return false;
      join(made, 0, j, side);
      if (before < 0)
        first = made;
      else if (face(before).corner[1] != face(made).corner[0])
        return false;
      else
        join(before, 1, made, 2);
      before = made;
    }
    if (face(before).corner[1] != face(first).corner[0]) return false;
    join(before, 1, first, 2);
    return true;
  }

  bool set(int i, Index a, Index b, Index c) {
    const Packed e = point(b) - point(a), f = point(c) - point(a), normal = cross(e, f);
    const double length = std::sqrt(dot(normal, normal)), sides2 = dot(e, e) + dot(f, f);
    if (!(length > 1e-14 * sides2)) return false;
    const double inverse = 1.0 / length;
    Triangle& t = face(i);
    t.corner = {a, b, c};
    t.normal = normal * inverse;
    t.distance = dot(t.normal, point(a));
    // Rounding may tilt a sliver's normal far: along whatever unit vector, the triangle is no nearer than the
    // least of its corners.
    setRank(i, std::min({t.distance, dot(t.normal, point(b)), dot(t.normal, point(c))}));
    // A sliver's normal is as much less certain as it is narrow.
    t.flat = kFlat * std::min(sides2 * inverse, kNarrow);
    // Else the origin is on the surface, to rounding.
    return origin_ == Origin::anywhere || t.distance >= 0.0;
  }

  Packed point_[kMaxPoints];
  std::array<Triangle, kMaxFaces> face_;
  Packed rank_[kMaxFaces / 4];  // distances, infinite for faces put aside, gone or not there yet
  std::array<Index, kMaxFaces> free_;
  Origin origin_;
  int nearest_ = 0, points_ = 0, faces_ = 0, freed_ = 0;
  bool sound_;
};

}  // namespace fcl_stpbv::detail
