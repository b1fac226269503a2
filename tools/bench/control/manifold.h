// Many rows for one pair of boxes, or of a body and a box: what keeps flat sides apart without a jump.
#pragma once

#include <vector>

#include "tools/bench/control/scene.h"

namespace fcl_stpbv::benchmark {

/// A distance, its direction and the points it is between, world frame;
/// `key` tells it from the pair's others.
struct FeaturePair {
  double d;
  Eigen::Vector3d normal, first, second;  ///< from `first` to `second`
  int key;
};

/// All pairs of a vertex of one body and the other body, and of two edges whose nearest points are inside
/// both, up to `reach` (m): the closest pairs of features of F. Kanehiro, F. Lamiraux, O. Kanoun, E. Yoshida
/// and J.-P. Laumond, A Local Collision Avoidance Method for Non-strictly Convex Polyhedra (RSS 2008), each
/// of which moves without a jump. The second body is a box, and edges count only where the first is one too.
void featurePairs(const Solid& a, const Eigen::Isometry3d& poseA, const Solid& b,
                  const Eigen::Isometry3d& poseB, double reach, std::vector<FeaturePair>& found);

}  // namespace fcl_stpbv::benchmark
