// The jump test: a box rocks past parallel faces over a plate in n steps. How much does the gradient change
// between neighbouring steps? The change of a continuous gradient falls as 1/n, a jump stays.
#include <algorithm>
#include <cmath>

#include "tools/bench/method.h"
#include "tools/bench/speed_accuracy.h"

namespace fcl_stpbv::benchmark {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// A pose of the rocking motion from -2 to 2 degrees, turned and tipped a little so that only one corner at a
/// time is nearest.
Isometry3d rocked(double t) {
  const double degree = std::acos(-1.0) / 180;
  const Matrix3d r =
      Matrix3d(AngleAxisd((4 * t - 2) * degree, Vector3d::UnitY()) *
               AngleAxisd(0.3 * degree, Vector3d::UnitX()) * AngleAxisd(20 * degree, Vector3d::UnitZ()));
  return test::pose(r, {0.01, 0.02, 0.2});
}

/// The derivative with respect to the upper body's twist about its origin.
Eigen::Matrix<double, 6, 1> gradientOf(const Answer& answer, const Isometry3d& pose) {
  const Vector3d n = answer.direction();
  Eigen::Matrix<double, 6, 1> g;
  g << n, (answer.point[1] - pose.translation()).cross(n);
  return g;
}

struct Jump {
  double largest = 0;
  int failed = 0;
};

Jump largestJump(Method& method, int steps) {
  Jump jump;
  Eigen::Matrix<double, 6, 1> last;
  bool known = false;
  for (int k = 0; k <= steps; ++k) {
    const Isometry3d pose = rocked(static_cast<double>(k) / steps);
    Answer answer;
    method.query(Isometry3d::Identity(), pose, answer);
    const Eigen::Matrix<double, 6, 1> g = gradientOf(answer, pose);
    if (answer.outcome != Outcome::apart || !g.allFinite()) {
      ++jump.failed;
      known = false;
      continue;
    }
    if (known) jump.largest = std::max(jump.largest, (g - last).norm());
    last = g;
    known = true;
  }
  return jump;
}

Bodies plateAndBox(double r, double R) {
  return {std::make_shared<StpBvGeometry>(StpBv::build(test::box(0.3, 0.3, 0.1), {r, R})),
          std::make_shared<StpBvGeometry>(StpBv::build(test::box(0.2, 0.2, 0.2), {r, R}))};
}

}  // namespace

Measurement jumpTest(const SpeedOptions&) {
  Measurement result;
  result.name = "jump_test";
  result.about = {{"r", 0.01}, {"R", 10}, {"rocks_by_degrees", 4}};
  const Bodies bodies = plateAndBox(0.01, 10);
  for (const MethodPtr& method : peers(bodies))
    for (const int steps : {30, 100, 300, 1000, 3000, 10000, 30000, 100000}) {
      const Jump jump = largestJump(*method, steps);
      result.rows.push_back({{"method", method->name},
                             {"setting", method->setting},
                             {"path_steps", steps},
                             {"largest_change", significant(jump.largest, 4)},
                             {"failed", jump.failed}});
    }
  return result;
}

}  // namespace fcl_stpbv::benchmark
