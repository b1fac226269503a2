#include "fcl_stpbv/distance/expanding_polytope.h"

#include "fcl_stpbv/distance/polytope.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

bool expandPolytope(const BodyPair& pair, const std::array<Vector3d, 4>& corner, Sample& x, double& bound,
                    Work& work) {
  // The ascent that follows finds the maximum next to the best normal exactly; this only has to tell which of
  // them is the best, to this much of the depth.
  constexpr double kRelative = 1e-3;
  bound = 0.0;
  Polytope polytope(corner);
  while (polytope.sound()) {
    const Polytope::Face nearest = polytope.nearest();
    bound = -nearest.distance;  // the polytope lies inside the difference, so no direction leads out sooner
    const Sample trial = pair.sampleFrom(-nearest.normal, {-1, -1}, work.steps);
    if (trial.core > x.core) x = trial;
    // Its own overlap, or the least one seen, is no more than the polytope's: nothing better is left.
    if (-x.core - nearest.distance <= kRelative * nearest.distance + pair.gapRounding()) return true;
    const Vector3d difference = trial.core * trial.n + trial.across;
    polytope.expand(difference);
  }
  return false;
}

}  // namespace fcl_stpbv
