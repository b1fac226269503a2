// A convex polytope that grows by adding points outside it. Used to find the point of a convex set's surface
// nearest to the origin (EPA).
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
      400;  ///< about 20 are usual, hundreds if the depth is almost the same along all directions

  struct Face {
    Eigen::Vector3d normal;       ///< unit, outward
    double distance;              ///< of its plane from the origin (m)
    double depth;                 ///< the set's surface over it is at least this far from the origin (m)
    std::array<Index, 3> corner;  ///< counter-clockwise from outside

    bool has(Index point) const { return corner[0] == point || corner[1] == point || corner[2] == point; }
  };

  /// Whether the origin must be inside from the start. If it must, the search ends when rounding puts the
  /// origin outside.
  enum class Origin { inside, anywhere };

  /// `rho`: the set is an intersection of balls of this radius (m). If `part` is given, this is true of the
  /// set of these parts of the points instead.
  explicit Polytope(const std::array<Eigen::Vector3d, 4>& corner, Origin origin = Origin::inside,
                    double rho = std::numeric_limits<double>::infinity(),
                    const std::array<Eigen::Vector3d, 4>* part = nullptr)
      : round_(part ? part_ : point_), rho_(rho), flatter_(rho / kFlatter), origin_(origin) {
    for (std::size_t i = 0; i < 4; ++i) {
      point_[i] = pack(corner[i]);
      if (part) part_[i] = pack((*part)[i]);
    }
    points_ = 4;
    const bool flip = dot(cross(point(1) - point(0), point(2) - point(0)), point(3) - point(0)) > 0.0;
    const Index i1 = flip ? 2 : 1, i2 = flip ? 1 : 2;
    while (faces_ < 4) newFace();
    sound_ = set(0, 0, i1, i2) && set(1, 0, i2, 3) && set(2, i2, i1, 3) && set(3, i1, 0, 3);
    join(0, 0, 3, 0), join(0, 1, 2, 0), join(0, 2, 1, 0);
    join(1, 1, 2, 2), join(2, 1, 3, 2), join(3, 1, 1, 2);
  }

  Polytope(const Polytope&) = delete;

  /// False after a face could not be made, because it was too flat or the arrays were full.
  bool sound() const { return sound_; }

  /// The face that may be nearest to the origin, among those that are not put aside. Infinitely far if all
  /// are put aside.
  Face nearest() {
    Packed least = rank_[0];
    PackedBits four{};  // the group of four that each number of `least` is from
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
    return {unpack(f.normal), f.distance, std::min(low, high), f.corner};
  }

  /// Removes the face that nearest() returned from the search.
  void putAside() { setRank(nearest_, kNowhere); }

  /// Lower bound on the height of the face's points along its normal (m). It allows for the tilt of a
  /// sliver's normal by rounding.
  double leastAlong(const Face& f) const {
    const Packed n = pack(f.normal);
    return std::min({dot(n, point(f.corner[0])), dot(n, point(f.corner[1])), dot(n, point(f.corner[2]))});
  }

  /// The point added last.
  Index lastPoint() const { return static_cast<Index>(points_ - 1); }

  /// Adds a point to the hull, and its part of the round set. False if it is inside already, if it is in a
  /// face's plane up to rounding, or if the arrays are full.
  bool expand(const Eigen::Vector3d& outside, const Eigen::Vector3d& part) {
    if (points_ < kMaxPoints) part_[at(points_)] = pack(part);
    return expand(outside);
  }

  bool expand(const Eigen::Vector3d& outside) {
    if (!sound_ || points_ == kMaxPoints) return sound_ = false;
    const Packed p = pack(outside);
    const double size = outside.lpNorm<1>();
    const auto sees = [&](int i) { return dot(face(i).normal, p) - face(i).distance > face(i).flat * size; };
    int first = nearest_;
    if (face(first).corner[0] == kNone || !sees(first))
      for (first = 0; first < faces_ && (face(first).corner[0] == kNone || !sees(first));) ++first;
    if (first == faces_) return false;

    // Visits the faces that see `p`, depth first, each side in turn. The sides of faces that do not see `p`
    // are found in the order of the horizon.
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
    double distance;              // of its plane from the origin (m)
    double flat;                  // a height below this fraction of a point's size is rounding
    std::array<Index, 3> corner;  // counter-clockwise from outside; corner[0] is kNone once the face is gone
    std::array<Index, 3>
        across;  // the neighbour over the side from corner k to the next: 4 * face + its side
  };

  static constexpr int kMaxFaces = 2 * kMaxPoints;
  static constexpr double kNarrow =
      300.0;  // limits `flat`: a larger one would reject points of the bodies' flat faces
  static constexpr double kFlat =
      1e-15;  // of a point's size: nearer points are in the face's plane, up to rounding

  static constexpr double kFlatter = 4.0;  // faces nearer than rho / kFlatter are treated as flat

  static constexpr std::array<int, 6> kTurn{0, 1, 2, 0, 1, 2};  // sides modulo 3

  static constexpr double kNowhere = std::numeric_limits<double>::infinity();
  static_assert(kMaxFaces % 4 == 0);
  void setRank(int i, double distance) { rank_[at(i) / 4][at(i) % 4] = distance; }
  /// Index of a new face. Fills the ranks of a new group of four.
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

  /// Adds faces from the sides of a horizon to `p`. False if rounding has torn the horizon.
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
    // Rounding may tilt a sliver's normal by much. But the height of the lowest corner along any unit vector
    // is a lower bound on the triangle's distance.
    const double least = std::min({t.distance, dot(t.normal, point(b)), dot(t.normal, point(c))});
    setRank(i, least > flatter_ ? roundDepth(t.corner, least) : least);
    // The narrower a sliver, the less accurate its normal.
    t.flat = kFlat * std::min(sides2 * inverse, kNarrow);
    // A negative distance means that the origin is on the surface, up to rounding.
    return origin_ == Origin::anywhere || t.distance >= 0.0;
  }

  /// A lower bound on |x| + q(x) over a face (docs/theory.md, 5) whose corners are at least `least` high
  /// along one unit vector. It takes |x| from the chord of the square root between `least` and the furthest
  /// corner, which leaves a quadratic function of the weights.
  [[gnu::noinline]] double roundDepth(const std::array<Index, 3>& corner, double least) const {
    std::array<double, 3> far2,
        sag;  // per corner; per side: both from the first corner, then the opposite one
    for (std::size_t i = 0; i < 3; ++i) far2[i] = squared(point(corner[i]));
    const double scale = 1.0 / (std::sqrt(std::max({far2[0], far2[1], far2[2]})) + least);
    for (std::size_t i = 0; i < 3; ++i) {
      const Index p = corner[i == 2 ? 1 : 0], q = corner[i == 2 ? 2 : i + 1];
      sag[i] = scale * squared(point(q) - point(p)) - squared(round_[q] - round_[p]) / (2.0 * rho_);
    }
    const double base = least + scale * (far2[0] - least * least);
    const double rise1 = scale * (far2[1] - far2[0]), rise2 = scale * (far2[2] - far2[0]);
    // base + g1 u + g2 v + sag0 u^2 + sag1 v^2 + h u v over the weights u, v of the second and third corners.
    const double g1 = rise1 - sag[0], g2 = rise2 - sag[1], h = sag[0] + sag[1] - sag[2];
    const double det = 4.0 * sag[0] * sag[1] - h * h;
    double u = (h * g2 - 2.0 * sag[1] * g1) / det, v = (h * g1 - 2.0 * sag[0] * g2) / det;
    if (sag[0] > 0.0 && det > 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0) {
      // For a narrow face rounding moves (u, v) along the valley, which is level, and away from it. Correct
      // the latter.
      if (sag[0] > sag[1])
        u = -(g1 + h * v) / (2.0 * sag[0]);
      else
        v = -(g2 + h * u) / (2.0 * sag[1]);
      return std::max(least, base + u * (g1 + sag[0] * u + h * v) + v * (g2 + sag[1] * v));
    }
    const auto side = [](double from, double rise, double sagging) {
      const double t = sagging > 0.0 ? std::min(std::max(0.5 - 0.5 * rise / sagging, 0.0), 1.0) : rise < 0.0;
      return from + t * (rise - (1.0 - t) * sagging);
    };
    return std::max(least, std::min({side(base, rise1, sag[0]), side(base, rise2, sag[1]),
                                     side(base + rise1, rise2 - rise1, sag[2])}));
  }
  static double squared(const Packed& p) { return dot(p, p); }

  Packed point_[kMaxPoints], part_[kMaxPoints];
  const Packed* round_;  // of these two, what is of the round set
  std::array<Triangle, kMaxFaces> face_;
  Packed rank_[kMaxFaces / 4];  // depths, infinite for faces put aside, gone or not there yet
  std::array<Index, kMaxFaces> free_;
  double rho_, flatter_;
  Origin origin_;
  int nearest_ = 0, points_ = 0, faces_ = 0, freed_ = 0;
  bool sound_;
};

/// The same for searches that are not compiled for wider instructions themselves (vectorized.h).
class WidePolytope : public Polytope {
 public:
  using Polytope::Polytope;
  Face nearest();
  bool expand(const Eigen::Vector3d& outside, const Eigen::Vector3d& part);
};

}  // namespace fcl_stpbv::detail
