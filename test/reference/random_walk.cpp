// A step that would leave a joint's range ends at its limit.
#include "test/reference/random_walk.h"

#include <algorithm>
#include <cmath>

#include "test/reference/shapes.h"

namespace fcl_stpbv::test {

Eigen::MatrixXd randomWalk(const Kinematics& kinematics, double step, int count) {
  Random random(1);
  Eigen::MatrixXd all(kinematics.size(), count);
  Eigen::VectorXd q = kinematics.neutral();
  for (int i = 0; i < count; ++i) {
    for (Eigen::Index k = 0; k < q.size(); ++k) {
      const double low = std::max(kinematics.lower()[k], -M_PI), high = std::min(kinematics.upper()[k], M_PI);
      q[k] = std::min(std::max(q[k] + step * (high - low) * random.uniform(-1, 1), low), high);
    }
    all.col(i) = q;
  }
  return all;
}

}  // namespace fcl_stpbv::test
