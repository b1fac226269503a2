// How deep a point is inside an STP-BV's core, from its faces alone.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "fcl_stpbv/volume/query_tables.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// A point's shortest way out of the core.
struct PointDepth {
  double depth;            ///< m
  Eigen::Vector3d normal;  ///< unit, outward: the direction of the way out
  int patch;               ///< the face through which the way out leads
};

/// The depth in closed form, from one pass over the faces' balls. Nothing for a point outside or less deep
/// than `QueryTables::capHeight`.
std::optional<PointDepth> pointDepth(const StpBv& body, const Eigen::Vector3d& p);

/// pointDepth(), but restricted to directions `n` with `n . side >= 0` for each of the `count` unit vectors,
/// and to depths below `below` (m). It is the smallest depth over the balls whose direction is allowed. With
/// a corner of another body as `p` and its edges as `side`, it is the depth of that body if the shortest way
/// out is one of the corner's normals and any point of that body is deeper than `capHeight` (docs/theory.md,
/// 5).
std::optional<PointDepth> pointDepthBetween(const StpBv& body, const Eigen::Vector3d& p,
                                            const Eigen::Vector3d* side, int count, double below);

/// For a point of the core that is deeper than this in all faces' balls, the shortest way out leads through a
/// face (docs/theory.md, 5, "A point"). Infinite if not even the centre is that deep (m).
double capHeight(const StpBv& body);

}  // namespace fcl_stpbv::detail
