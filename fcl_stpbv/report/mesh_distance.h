// Distance of the shapes that two bodies stand for, triangle meshes and
// primitives, to a tenth of a micrometre.
#pragma once

#include "fcl_stpbv/report/exact_body.h"

namespace fcl_stpbv::report {

/// The distance lies in [lower, upper], up to rounding; both are 0 where the bodies meet.
struct MeshDistance {
  double lower = 0, upper = 0;
};

/// Distance of two bodies (m). They meet where their surfaces have a common point, or where a part of one
/// lies inside the other (MeshSolid::holds; certain where the outer one is closed, a hollow in it included).
///
/// FCL's distance of two meshes is a guess that two walks down both hierarchies confirm
/// (adapter/fcl_distance.h); where they do not, and for a mesh and a primitive, for which FCL's GJK may stop
/// early (docs/fcl.md), bisection takes over. `atLeast` is a lower bound that is known already, as
/// from volumes around the bodies; it saves time.
MeshDistance meshDistance(const ExactBody& a, const Eigen::Isometry3d& poseA, const ExactBody& b,
                          const Eigen::Isometry3d& poseB, double atLeast = 0);

}  // namespace fcl_stpbv::report
