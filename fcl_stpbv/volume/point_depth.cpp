// How deep a point is inside an STP-BV's core (docs/theory.md, 5, "A point").
//
// The core lies in the ball of each face, so the shortest way out of the core is at most the way out of one
// of these balls. For a point that is deep enough, the shortest way out leads through a face, because the
// surface at an edge or a vertex is curved too strongly. So the depth is the smallest of the depths in the
// balls.
// 1. For each ball compute the power of the point, |p - c|^2 - rho^2. With a point a on the ball and the
//    normal u there, it is (p - a) . (p - a + 2 rho u), which has no cancellation if the centre c is far
//    away. If the centre is near, |p - c|^2 itself is more accurate.
// 2. The ball with the largest power gives the shortest way out.
#include "fcl_stpbv/volume/point_depth.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "fcl_stpbv/four_vectors.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/vectorized.h"
#include "fcl_stpbv/volume/patch_view.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

struct Power {
  /// Power of the point with respect to the face's ball, or to a smaller ball about the same centre (m^2)
  double value;
  int face;  ///< index among the faces, -1: none
};

/// Allows all ways out.
struct AllWays {};

/// Allows only ways out whose product with none of the given sides is negative.
struct WaysBetween {
  const Vector3d* side;  ///< unit
  int count;
  double rounding;  ///< rounding of the product of a side and a way as long as a ball's radius (m)

  PackedBits allow(const FourVectors& way) const {
    PackedBits allowed = PackedBits{} - 1;
    for (int i = 0; i < count; ++i) allowed &= dot(way, four(pack(side[i]))) >= Packed{} - rounding;
    return allowed;
  }
};

/// The largest power that is greater than `above`, over the faces whose way out is one of the `ways`. Four
/// faces are handled at a time. The power is that of balls of the radius `about` around the centres of the
/// faces' balls, |p - c|^2 - about^2.
template <typename Ways>
inline Power largestPower(const FaceRecord* faces, int count, double rho, double about, const Packed& p,
                          double above, const Ways& ways) {
  const auto read = [](const Vector3d& v) {  // the fourth number is the next one in the record
    Packed four;
    std::memcpy(&four, v.data(), sizeof four);
    return four;
  };
  const FourVectors point = four(p);
  Packed most = Packed{} + above;
  PackedBits first = PackedBits{} - 1;  // for each place of `most`, the first of the four faces that gave it
  for (int f = 0; f < count; f += 4) {
    const FaceRecord& s = faces[f];
    const FaceRecord& t = faces[std::min(f + 1, count - 1)];
    const FaceRecord& u = faces[std::min(f + 2, count - 1)];
    const FaceRecord& v = faces[std::min(f + 3, count - 1)];
    const FourVectors from = point - four(read(s.anchor), read(t.anchor), read(u.anchor), read(v.anchor)),
                      normal = four(read(s.normal), read(t.normal), read(u.normal), read(v.normal));
    const Packed power =
        dot(from + (Packed{} + (rho - about)) * normal, from + (Packed{} + (rho + about)) * normal);
    PackedBits more = power > most;
    if constexpr (std::is_same_v<Ways, WaysBetween>) {
      if (!any(more)) continue;
      more &= ways.allow(from + (Packed{} + rho) * normal);
    }
    most = more ? power : most;
    first = more ? PackedBits{} + f : first;
  }
  int lane = 0;
  for (int i = 1; i < 4; ++i)
    if (most[i] > most[lane]) lane = i;
  if (first[lane] < 0) return {above, -1};
  return {most[lane], std::min(static_cast<int>(first[lane]) + lane, count - 1)};
}

/// The least depth in a face's ball that is less than `below` and whose way out is one of `ways`.
template <typename Ways>
inline PointDepth depthInBalls(const StpBv& body, const Vector3d& p, double below, const Ways& ways) {
  constexpr double kFar = 4.0;  // times the coordinates: with a larger rho no way is much shorter than rho
  const PatchTable& patches = body.tables().patches;
  const double rho = body.radii().rho;
  const bool far = rho > kFar * ((p - body.centre()).norm() + body.enclosingRadius());
  // `least` is the least length of a way.
  const double about = far ? rho : 0.0, least = std::max(0.0, rho - below);
  const Power power = largestPower(&patches.face(patches.firstFace()), patches.count() - patches.firstFace(),
                                   rho, about, pack(p), far ? -below * (rho + least) : least * least, ways);
  if (power.face < 0) return {kInfinity, Vector3d(0, 0, 0), -1};
  const FaceRecord& face = patches.face(patches.firstFace() + power.face);
  const Vector3d way = p - face.anchor + rho * face.normal;  // from the ball's centre to p
  const double length = way.norm();
  return {far ? -power.value / (rho + length) : rho - length, way / length, patches.firstFace() + power.face};
}

FCL_STPBV_VECTORIZED
PointDepth leastDepth(const StpBv& body, const Vector3d& p) {
  return depthInBalls(body, p, kInfinity, AllWays{});
}

FCL_STPBV_VECTORIZED
PointDepth leastDepth(const StpBv& body, const Vector3d& p, double below, const WaysBetween& ways) {
  return depthInBalls(body, p, below, ways);
}

}  // namespace

std::optional<PointDepth> pointDepth(const StpBv& body, const Vector3d& p) {
  const double least = body.tables().capHeight;
  if (std::isinf(least)) return {};
  // Share of the ball's radius: at the centre of a ball the way out has no direction.
  constexpr double kCentred = 0.999;
  const PointDepth found = leastDepth(body, p);
  if (!(found.depth > least && found.depth < kCentred * body.radii().rho)) return {};
  return found;
}

std::optional<PointDepth> pointDepthBetween(const StpBv& body, const Vector3d& p, const Vector3d* side,
                                            int count, double below) {
  const PointDepth found = leastDepth(body, p, below, WaysBetween{side, count, 1e-12 * body.radii().rho});
  if (found.patch < 0) return {};
  return found;
}

double capHeight(const StpBv& body) {
  constexpr double kNone = kInfinity, kSafe = 1.0 + 1e-9;  // more than rounding
  const double rho = body.radii().rho;
  if (!(body.innerRadius() > 0.0)) return kNone;
  double edge = 0.0, face = 0.0;
  for (int e = 0; e < body.edgeCount(); ++e)
    edge = std::max(edge, sag(body.patch(body.edgePatch(e)), body.radii()));
  for (int f = 0; f < body.faceCount(); ++f) {
    // Take the heights over the ball's centre along any unit vector, here the mean of the corners' normals.
    // Every point of the polygon is at least as far from the centre as the lowest corner is high. A corner's
    // height is rho times the cosine of the angle between its normal and the mean.
    const StpBv::Ring& ring = body.faces()[at(f)];
    Vector3d mean(0, 0, 0);
    for (const int vertex : ring) mean += body.corner(f, vertex);
    const double length = mean.norm();
    if (!(length > 0.0)) return kNone;
    mean /= length;
    for (const int vertex : ring)
      face = std::max(face, 0.5 * rho * (body.corner(f, vertex) - mean).squaredNorm());
  }
  const double height = kSafe * (edge + face) + 1e-12 * body.extent();
  return leastDepth(body, body.centre()).depth > height ? height : kNone;
}

}  // namespace fcl_stpbv::detail
