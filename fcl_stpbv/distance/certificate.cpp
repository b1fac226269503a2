// The optimality certificate of a maximum between overlapping cores (docs/theory.md, 5, "Deeper").
//
// 1. Make triangles from the maximum's own point to the corners of its feature. Their distance from the
//    origin equals the depth of the maximum, except for a small part that leaves no space for a wider gap.
// 2. From the sides of that feature, close the surface over a ball inside both cores, or, if the ball is too
//    small, over the other sides of the difference of two boxes.
// 3. The surface lies in the difference of the cores, which is convex. So if every plane of it is at least as
//    far from the origin as the maximum is deep, no direction has a smaller depth.
#include "fcl_stpbv/distance/certificate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fcl_stpbv/distance/box_axes.h"
#include "fcl_stpbv/distance/vertex_gjk.h"
#include "fcl_stpbv/four_vectors.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"

namespace fcl_stpbv::detail {

namespace {

/// Three points of the difference, counter-clockwise from outside.
struct Triangle {
  Packed p, q, r;

  /// Its plane's distance from the origin.
  double distance() const {
    const Packed m = cross(q - p, r - p);
    return std::abs(dot(m, p)) / std::sqrt(dot(m, m));
  }
};

/// The sides of a feature, from corner to corner, one in each lane. If there are three, the first one is also
/// the fourth.
struct FeatureSides {
  explicit FeatureSides(const FeatureCorners& c)
      : three(c.count == 3),
        from(four(c.point[0], c.point[1], c.point[2], c.point[three ? 0 : 3])),
        to(next(from)) {}

  /// For each side, the number of the next side.
  Packed next(const Packed& v) const {
    return three ? __builtin_shufflevector(v, v, 1, 2, 0, 1) : __builtin_shufflevector(v, v, 1, 2, 3, 0);
  }
  FourVectors next(const FourVectors& v) const { return {next(v.x), next(v.y), next(v.z)}; }

  bool three;
  FourVectors from, to;
};

/// A patch's vertices, up to four of a face's.
struct Vertices {
  std::array<int, FeatureCorners::kMost> index{};
  std::size_t count = 0;
};

Vertices verticesOf(const StpBv& body, int patch) {
  const PatchTable& patches = body.tables().patches;
  if (patches.kind(patch) == PatchKind::vertex) return {{patch}, 1};
  if (patches.kind(patch) == PatchKind::edge) {
    const EdgeRecord& edge = patches.edge(patch);
    return {{edge.past(1), edge.past(0)}, 2};
  }
  Vertices v;
  const FaceRecord& face = patches.face(patch);
  if (face.further() < 0) {  // all of them are in the record, which has been loaded
    v.count = face.count();
    for (std::size_t i = 0; i < v.count; ++i) v.index[i] = patches.startOf(face.side[i]);
  } else {
    const StpBv::Ring& ring = body.faces()[at(patch - body.facePatch(0))];
    v.count = FeatureCorners::kMost;
    for (std::size_t i = 0; i < v.count; ++i) v.index[i] = ring[i * ring.size() / v.count];
  }
  return v;
}

/// The one of `count` points that is nearest to `target`.
template <typename Point>
Packed nearestOf(std::size_t count, const Point& point, const Packed& target) {
  Packed nearest = point(0);
  double least = kInfinity;
  for (std::size_t i = 0; i < count; ++i) {
    const Packed p = point(i), d = p - target;
    if (dot(d, d) < least) least = dot(d, d), nearest = p;
  }
  return nearest;
}

/// For two boxes: whether the feature is one side of their difference, and all other sides are at least
/// `depth` from the origin. The difference has a side along each of fifteen axes and its opposite, and no
/// others. The feature lies in its side's plane up to rounding. If it were only a part of that side, another
/// side would be in or next to that plane. So the other sides must be farther away by `kApart`.
bool closesOverBoxes(const BodyPair& pair, const Sample& top, const FeatureCorners& corners, double depth) {
  constexpr double kSame = 2e-14;  // of the size: rounding, and the distance of the corners from a box's
  constexpr double kApart = 1e-9;  // of the size: more than `kSame` can tilt a side of the thinnest box, 1e-3
  if (!pair.tablesA().box.isHull || !pair.tablesB().box.isHull || corners.count != 4) return false;
  const double size = pair.a().extent() + pair.b().extent();
  const BoxAxes axes(pair);
  const BoxAxes::Axis axis = axes.of(pair, top);
  const double beyond = depth + kApart * size;
  if (axis.kind == BoxAxes::Axis::kinds || !axes.othersBeyond(axis, beyond) || axes.opposite(axis) < beyond)
    return false;
  const Triangle half{corners.point[0], corners.point[1], corners.point[2]};
  return std::abs(half.distance() - axes.overlap(axis)) <= kSame * size;
}

bool closesOver(const Packed& centre, double radius, const FeatureSides& sides, const Packed& n,
                double depth) {
  const FourVectors &p = sides.from, &q = sides.to, side = q - p, c = four(centre), toCentre = c - p;
  const Packed side2 = dot(side, side);
  const FourVectors in = toCentre - dot(toCentre, side) / side2 * side;
  const Packed in2 = dot(in, in), tangent2 = in2 - radius * radius;
  // Unit outward normals of the planes over the sides that touch the ball.
  const FourVectors wall = 1.0 / in2 * (roots(tangent2 / side2) * cross(in, side) - (Packed{} + radius) * in);
  if (!all((tangent2 > 0.0) & (dot(wall, p) >= depth))) return false;
  // From wall to wall the cone's normals follow a circle, on which the distance of their planes from the
  // origin is a sine. So it is least at an end, unless the sine has its own minimum between the ends.
  const FourVectors next = sides.next(wall), turn = cross(wall, next), across = cross(q, c);
  const PackedBits rises = dot(wall, across) <= 0.0, falls = dot(next, across) >= 0.0,
                   shortTurn = dot(turn, q - c) > 0.0;
  return all((dot(turn, four(n)) < 0.0) & ((rises & falls) | (shortTurn & (rises | falls))));
}

}  // namespace

FeatureCorners cornersAround(const BodyPair& pair, const Sample& top) {
  const Vertices a = verticesOf(pair.a(), top.patch[0]), b = verticesOf(pair.b(), top.patch[1]);
  const auto onA = [&](std::size_t i) { return pair.vertexA(a.index[i]); };
  const auto onB = [&](std::size_t i) { return pair.vertexB(b.index[i]); };
  FeatureCorners c;
  if (a.count == 2 && b.count == 2) {
    for (const std::size_t i : {0u, 1u, 3u, 2u}) c.point[c.count++] = onB(i / 2) - onA(i % 2);
  } else if (a.count > 2 && b.count > 0) {
    const Packed pointB = pack(top.point) + pack(top.across) + top.core * pack(top.n);
    const Packed nearest = nearestOf(b.count, onB, pointB);
    for (c.count = 0; c.count < a.count; ++c.count) c.point[c.count] = nearest - onA(c.count);
  } else if (b.count > 2 && a.count > 0) {
    const Packed nearest = nearestOf(a.count, onA, pack(top.point));
    for (c.count = 0; c.count < b.count; ++c.count) c.point[c.count] = onB(c.count) - nearest;
  }
  if (c.count > 0 && dot(cross(c.point[1] - c.point[0], c.point[2] - c.point[1]), pack(top.n)) > 0.0)
    std::reverse(c.point, c.point + c.count);
  return c;
}

LocalMaximum localMaximum(const BodyPair& pair, const Sample& top) {
  LocalMaximum local(top.n, -top.core);
  const auto insideA = [&] { return -pair.a().outside(top.patch[0], top.n); };
  const auto insideB = [&] { return -pair.b().outside(top.patch[1], pair.opposite(top.n)); };
  addPatch(pair.patchA(top.patch[0]), top.n, insideA, local);
  addPatch(pair.patchB(top.patch[1]), top.n, insideB, local);
  return local;
}

FCL_STPBV_VECTORIZED
bool closesOverBall(const Packed& centre, double radius, const FeatureCorners& corners, const Packed& n,
                    double depth) {
  return closesOver(centre, radius, FeatureSides(corners), n, depth);
}

FCL_STPBV_VECTORIZED
WidestProof proveWidest(const BodyPair& pair, const Sample& top) {
  WidestProof proof{cornersAround(pair, top), localMaximum(pair, top)};
  const double depth = -top.core - pair.gapRounding();
  if (proof.corners.count == 0 || !(depth > 0.0)) return proof;
  const Packed n = pack(top.n), summit = top.core * n + pack(top.across);
  const FeatureSides sides(proof.corners);
  const FourVectors normal = cross(sides.to - sides.from, four(summit) - sides.from);
  const Packed height = dot(normal, sides.from), far2 = height * height / dot(normal, normal);
  if (!all(height > 0.0)) return proof;
  constexpr double kLevel = 1.0 - 1e-14;  // rounding of the quotient
  // The cosine of the tilt of a plane through the maximum's point is the plane's distance divided by the
  // depth. The normals of points beyond the plane are tilted by at most twice that angle.
  const double nearest2 = std::min(std::min(far2[0], far2[1]), std::min(far2[2], far2[3])),
               c2 = std::min(nearest2 / (top.core * top.core), kLevel);
  if (!proof.around.holdsWithin(2.0 * std::sqrt(c2 * (1.0 - c2)), 2.0 * c2 - 1.0)) return proof;
  const double innerRadius = pair.a().innerRadius() + pair.b().innerRadius();
  if (!closesOver(pair.centreDifference(), innerRadius, sides, n, depth) &&
      !closesOverBoxes(pair, top, proof.corners, depth))
    return proof;
  proof.proven = true;
  proof.bound = -depth;
  return proof;
}

}  // namespace fcl_stpbv::detail
