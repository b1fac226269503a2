// Closest features of two convex hulls by FCL's GJK, with a stopping criterion that proves convergence.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "fcl_stpbv/convex/hull_graph.h"

namespace fcl_stpbv::detail {

/// Warm start: the result of an earlier call for the same pair, or nothing.
struct WitnessStart {
  /// From A to B, world frame; zero: from centre to centre.
  Eigen::Vector3d direction{0, 0, 0};
  /// Hull vertices from which to climb; -1: take them from the table of directions.
  std::array<int, 2> vertex{-1, -1};
};

/// Closest points of two convex hulls and the features that hold them. World frame, metres.
struct PolyhedralWitness {
  enum class Verdict {
    separated,    ///< a plane between the hulls was found; everything below is filled
    overlapping,  ///< the hulls touch or overlap: distance 0; of the rest only `direction` is set, to a guess
    failed,  ///< not finite, or not decided within the limit on iterations; `lower` and `upper` still hold
  };
  Verdict verdict = Verdict::failed;
  double lower = 0;                    ///< certified lower bound: the gap between two supporting planes
  double upper = 0;                    ///< certified upper bound: the distance of two points
  Eigen::Vector3d direction{0, 0, 0};  ///< unit, from A to B
  std::array<Eigen::Vector3d, 2> point{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 0)};
  /// The feature on which each point lies.
  std::array<HullFeature, 2> feature;
  /// Vertices of each feature, the one with the largest weight first; -1 in unused places.
  std::array<std::array<int, 3>, 2> vertices;
  int supports = 0;  ///< number of support points computed, a measure of the work

  WitnessStart start() const { return {direction, {vertices[0][0], vertices[1][0]}}; }
};

/// Closest points of hull `a` at `poseA` and `b` at `poseB`. Never throws, never allocates.
///
/// The intersection test is FCL's own GJK. The support function climbs from the last vertex. Coordinates are
/// relative to A and scaled to about 1, because libccd's tolerances are absolute. FCL's distance loop is
/// replaced: FCL stops when two norms agree, which does not prove convergence (docs/fcl.md). This function
/// stops when the duality gap is at most `gap` times the distance; with 0, when it is only rounding.
PolyhedralWitness polyhedralWitness(const HullGraph& a, const Eigen::Isometry3d& poseA, const HullGraph& b,
                                    const Eigen::Isometry3d& poseB, const WitnessStart& start = {},
                                    double gap = 0.0);

}  // namespace fcl_stpbv::detail
