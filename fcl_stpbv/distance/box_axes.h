// Separating axes of two boxes (Gottschalk, Lin, Manocha 1996), for their penetration depth.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "fcl_stpbv/distance/body_pair.h"
#include "fcl_stpbv/four_vectors.h"

namespace fcl_stpbv::detail {

/// The overlaps of two boxes along the normals of their sides and the cross products of their edges. The
/// Minkowski difference of two boxes has no other sides. Frame of the first body; the boxes must outlive this
/// object.
class BoxAxes {
 public:
  /// One axis: the normal of a side of the first box, that of a side of the second box, or the cross product
  /// of two edges. Then `kind - firstCross` is the first box's edge, and `which` the second box's.
  struct Axis {
    enum Kind : std::size_t { firstSides, secondSides, firstCross, kinds = 5 };
    std::size_t kind;
    int which;
  };

  BoxAxes(const BodyBox& a, const BodyBox& b, const RelativePose& pose);
  explicit BoxAxes(const BodyPair& pair) : BoxAxes(pair.tablesA().box, pair.tablesB().box, pair.pose()) {}

  /// The axis of the least overlap.
  Axis least() const;
  /// The unit vector along an axis, from the first body to the second.
  Eigen::Vector3d normal(const Axis& axis) const;

  /// Overlap along an axis; negative if the boxes are apart along it (m).
  double overlap(const Axis& axis) const {
    return overlap_[axis.kind][axis.which] / std::sqrt(length2_[axis.kind][axis.which]);
  }

  /// Length of the translation against the axis' normal that separates the boxes (m).
  double opposite(const Axis& axis) const {
    return overlap(axis) + 2.0 * std::abs(dot(pack(normal(axis)), between_));
  }

  /// Whether the overlap is at least `depth` (m, positive) along all other axes. False if two edges are so
  /// nearly parallel that their cross product is uncertain.
  bool othersBeyond(const Axis& axis, double depth) const;

  /// Whether the overlap is at least `depth` - 2 `rounding` along all axes, if no projection onto one is off
  /// by more than `rounding` (m). False where edges are so nearly parallel that this leaves it open.
  bool noneNearer(double depth, double rounding) const;

  /// The directions of the two edges whose cross product is the axis.
  const Packed& firstEdge(const Axis& axis) const { return first_[axis.kind - Axis::firstCross]; }
  const Packed& secondEdge(const Axis& axis) const { return second_[axis.which]; }

  /// The axis that belongs to the patches of the maximum `top` between two STP-BVs: that of a box's side, or
  /// of two edges. Its kind is `kinds` if there is none.
  Axis of(const BodyPair& pair, const Sample& top) const;

 private:
  /// Squared sine of the angle between two edges below which their cross product is not used.
  static constexpr double kParallel2 = 1e-6;

  static Packed magnitude(const Packed& v) { return v < 0.0 ? -v : v; }

  static Packed turned(const Packed& v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); }

  /// The first of three axes whose cosine with `n` is above `least`, either way round; -1: none.
  static int along(const Packed (&axis)[3], const Packed& n, double least) {
    for (int i = 0; i < 3; ++i)
      if (std::abs(dot(axis[i], n)) > least) return i;
    return -1;
  }

  const Packed (&first_)[3];  // the boxes' axes
  Packed second_[3];
  Packed between_;                                      // from centre to centre
  Packed overlap_[Axis::kinds], length2_[Axis::kinds];  // of three axes each; overlaps times the axis' length
};

inline BoxAxes::BoxAxes(const BodyBox& a, const BodyBox& b, const RelativePose& pose) : first_(a.axis) {
  for (int j = 0; j < 3; ++j) second_[j] = pose.rotation * b.axis[j];
  between_ = pose.placed(b.centre) - a.centre;
  const Rotation first(a.axis[0], a.axis[1], a.axis[2]), second(second_[0], second_[1], second_[2]);
  const Packed row[] = {second.inverse(a.axis[0]), second.inverse(a.axis[1]), second.inverse(a.axis[2])},
               t = first.inverse(between_), s = second.inverse(between_);
  const Packed inRow[] = {magnitude(row[0]), magnitude(row[1]), magnitude(row[2])};
  const Rotation cosines(inRow[0], inRow[1], inRow[2]);

  constexpr Packed kUnit{1, 1, 1, 1};
  overlap_[Axis::firstSides] = a.half + cosines.inverse(b.half) - magnitude(t);
  overlap_[Axis::secondSides] = b.half + cosines * a.half - magnitude(s);
  length2_[Axis::firstSides] = length2_[Axis::secondSides] = kUnit;
  const Packed half1 = turned(b.half), half2 = turned(half1);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const Packed cosines1 = turned(inRow[i]), cosines2 = turned(cosines1);
    overlap_[Axis::firstCross + static_cast<std::size_t>(i)] = a.half[j] * inRow[k] + a.half[k] * inRow[j] +
                                                               half1 * cosines2 + half2 * cosines1 -
                                                               magnitude(t[k] * row[j] - t[j] * row[k]);
    length2_[Axis::firstCross + static_cast<std::size_t>(i)] = row[j] * row[j] + row[k] * row[k];
  }
}

inline BoxAxes::Axis BoxAxes::least() const {
  constexpr Packed kNone = Packed{} + std::numeric_limits<double>::infinity();
  Axis least{0, 0};
  double overlap = std::numeric_limits<double>::infinity();
  for (std::size_t kind = 0; kind < Axis::kinds; ++kind) {
    const Packed &length2 = length2_[kind], &here = overlap_[kind],
                 scaled = kind < Axis::firstCross ? here
                          : length2 > kParallel2  ? here / roots(length2)
                                                  : kNone;
    for (int i = 0; i < 3; ++i)
      if (scaled[i] < overlap) overlap = scaled[i], least = {kind, i};
  }
  return least;
}

inline Eigen::Vector3d BoxAxes::normal(const Axis& axis) const {
  Packed n = axis.kind == Axis::firstSides ? first_[axis.which] : second_[axis.which];
  if (axis.kind >= Axis::firstCross) n = cross(firstEdge(axis), n);
  return unpack(n * ((dot(n, between_) < 0.0 ? -1.0 : 1.0) / std::sqrt(dot(n, n))));
}

inline bool BoxAxes::othersBeyond(const Axis& axis, double depth) const {
  Packed nearer{};
  for (std::size_t kind = 0; kind < Axis::kinds; ++kind) {
    const Packed over = overlap_[kind], length2 = length2_[kind];
    const PackedBits beyond =
        (over > 0.0) & (over * over >= depth * depth * length2) & (length2 > kParallel2);
    Packed open = beyond ? Packed{} : Packed{} + 1.0;
    if (kind == axis.kind) open[axis.which] = 0.0;
    nearer = larger(nearer, open);
  }
  return !(std::max(std::max(nearer[0], nearer[1]), nearer[2]) > 0.0);
}

inline bool BoxAxes::noneNearer(double depth, double rounding) const {
  constexpr double kSame2 = 4e-30;  // squared sine of two edges that are parallel up to rounding
  const double least = depth - 2.0 * rounding;
  Packed nearer{};
  for (std::size_t kind = 0; kind < Axis::kinds; ++kind) {
    const Packed over = overlap_[kind] - rounding, &length2 = length2_[kind];
    const PackedBits beyond = (length2 <= kSame2) | ((over > 0.0) & (over * over >= least * least * length2));
    nearer = larger(nearer, beyond ? Packed{} : Packed{} + 1.0);
  }
  return !(std::max({nearer[0], nearer[1], nearer[2]}) > 0.0);
}

inline BoxAxes::Axis BoxAxes::of(const BodyPair& pair, const Sample& top) const {
  constexpr double kSide =
      0.9;  // cosine: a side bulges, so the normal of a maximum on it is only near its own
  constexpr double kEdge =
      1.0 - 1e-9;  // cosine: an edge is parallel to the box's, unless it is a side's diagonal
  constexpr Axis kNone{Axis::kinds, 0};
  const PatchKind kindA = pair.a().kind(top.patch[0]), kindB = pair.b().kind(top.patch[1]);
  const Packed n = pack(top.n);
  int which = -1;
  std::size_t kind = Axis::kinds;
  if (kindA == PatchKind::face && kindB == PatchKind::vertex) {
    kind = Axis::firstSides;
    which = along(first_, n, kSide);
  } else if (kindA == PatchKind::vertex && kindB == PatchKind::face) {
    kind = Axis::secondSides;
    which = along(second_, n, kSide);
  } else if (kindA == PatchKind::edge && kindB == PatchKind::edge) {
    const int i = along(first_, pair.patchA(top.patch[0]).axis, kEdge);
    which = along(second_, pair.patchB(top.patch[1]).axis, kEdge);
    if (i < 0) return kNone;
    kind = Axis::firstCross + static_cast<std::size_t>(i);
  }
  return which < 0 ? kNone : Axis{kind, which};
}

}  // namespace fcl_stpbv::detail
