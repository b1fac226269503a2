// Distance of the exact shapes of two bodies, triangle meshes or primitives, to a tenth of a micrometre.
#pragma once

#include "fcl_stpbv/report/exact_body.h"

namespace fcl_stpbv::report {

/// The distance lies in [lower, upper], up to rounding; both are 0 where the bodies meet.
struct MeshDistance {
  double lower = 0, upper = 0;
};

/// Distance of two bodies (m). They meet if their surfaces have a common point, or if a part of one lies
/// inside the other (MeshSolid::holds; this is certain if the outer mesh is closed, also if it is hollow).
///
/// For two meshes, FCL's distance is a first guess, and two threshold tests verify it (isFartherThan() in
/// adapter/fcl_distance.h). If they fail, and for a mesh and a primitive (FCL's GJK may stop early,
/// docs/fcl.md), the distance is found by bisection with such tests. `atLeast` is a lower bound that is
/// already known, for example from volumes around the bodies; it saves time.
MeshDistance meshDistance(const ExactBody& a, const Eigen::Isometry3d& poseA, const ExactBody& b,
                          const Eigen::Isometry3d& poseB, double atLeast = 0);

}  // namespace fcl_stpbv::report
