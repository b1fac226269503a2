// Many rows for one pair of boxes, or of a body and a box. They keep flat sides apart without jumps.
#pragma once

#include <vector>

#include "tools/bench/control/scene.h"

namespace fcl_stpbv::benchmark {

/// A distance, its direction and its two points, in the world frame. `key` distinguishes it from the pair's
/// other feature pairs.
struct FeaturePair {
  double d;
  Eigen::Vector3d normal, first, second;  ///< from `first` to `second`
  int key;
};

/// All pairs, up to `reach` (m), of a vertex of one body and the other body, and of two edges whose nearest
/// points are inside both. These are the closest pairs of features of F. Kanehiro, F. Lamiraux, O. Kanoun, E.
/// Yoshida and J.-P. Laumond, A Local Collision Avoidance Method for Non-strictly Convex Polyhedra (RSS
/// 2008). Each of them moves without a jump. The second body is a box. Edges count only if the first body is
/// a box too.
void featurePairs(const Solid& a, const Eigen::Isometry3d& poseA, const Solid& b,
                  const Eigen::Isometry3d& poseB, double reach, std::vector<FeaturePair>& found);

}  // namespace fcl_stpbv::benchmark
