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
  Eigen::Vector3d normal;  ///< unit, outward: the way
  int patch;               ///< the face that it leads through
};

/// The depth in closed form, from one pass over the faces' balls. Nothing for a point outside or less deep
/// than `QueryTables::capHeight`.
std::optional<PointDepth> pointDepth(const StpBv& body, const Eigen::Vector3d& p);

/// The same, but only of ways `n` with `n . side >= 0` for each of `count` unit vectors, and only one shorter
/// than `below` (m): the least of the depths in the balls whose way is one of these. For a corner of another
/// body and its edges, how deep that body is there, if anywhere it is deeper than `capHeight`
/// (docs/theory.md, 5).
std::optional<PointDepth> pointDepthBetween(const StpBv& body, const Eigen::Vector3d& p,
                                            const Eigen::Vector3d* side, int count, double below);

/// A point of the core that is deeper than this in all faces' balls leaves the core soonest through a face
/// (docs/theory.md, 5, "A point"). Infinite where the centre is not as deep.
double capHeight(const StpBv& body);

}  // namespace fcl_stpbv::detail
