// GJK on the vertices of two bodies: gives a normal near the answer's.
#pragma once

#include <limits>

#include "fcl_stpbv/distance/body_pair.h"

namespace fcl_stpbv::detail {

/// What a search over the two point sets found.
struct VertexGjk {
  bool apart = false;       ///< a gap, widest along `n`
  bool surrounded = false;  ///< four points of the difference, second set minus first, with the origin inside
  Eigen::Vector3d n{0, 0, 0};
  /// Upper bound on the distance of the two hulls: the distance of two of their points (m).
  double nearest = 0;
  std::array<int, 2> vertex{0, 0};        ///< last support vertices
  std::array<Eigen::Vector3d, 4> corner;  ///< set where `surrounded`
};

/// Unit normal of the widest gap between the two point sets: the paper's first step (IV.B), by GJK
/// (convex/gjk.h). Starts from the normal `n`. It is only a hint: it may be wrong if the STP-BV's own
/// triangulation is not convex. Stops as soon as the gap is known to be above `level` (m) or not above it.
///
/// The normal of a polyhedral witness falls into the region of the smooth patch of the same name: an edge's
/// cone is centred on the plane across it, a face's region holds its plane's normal (paper IV.C, IV.D).
VertexGjk vertexGjk(const BodyPair& pair, const Eigen::Vector3d& n,
                    double level = std::numeric_limits<double>::quiet_NaN());

/// The difference of two vertices, second body's minus first body's, that is about the furthest against the
/// unit vector `n`.
Eigen::Vector3d vertexDifference(const BodyPair& pair, const Eigen::Vector3d& n);

}  // namespace fcl_stpbv::detail
