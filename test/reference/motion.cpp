// The n-th poses in closed form. Each body turns by n steps about three axes, in ratios that avoid an early
// repetition. The distance of the centres goes to and fro.
#include "test/reference/motion.h"

#include <cmath>

#include "test/reference/shapes.h"

namespace fcl_stpbv::benchmark {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

const double kDegree = std::acos(-1.0) / 180;

/// Angles k, 0.77 k, 1.31 k about the three axes. These ratios avoid an early repetition of the motion.
Matrix3d turned(double angle) {
  return Matrix3d(AngleAxisd(angle, Vector3d::UnitX()) * AngleAxisd(0.77 * angle, Vector3d::UnitY()) *
                  AngleAxisd(1.31 * angle, Vector3d::UnitZ()));
}

/// A triangle wave of period 1 between 0 and 1.
double seesaw(double t) {
  const double phase = t - std::floor(t);
  return phase < 0.5 ? 2 * phase : 2 - 2 * phase;
}

}  // namespace

Step largeStep() { return {"large", 20 * kDegree, 0.02}; }
Step smallStep() { return {"small", 1 * kDegree, 0.001}; }

GeodesicMotion::GeodesicMotion(const Step& step, std::uint64_t seed, double nearest)
    : step_(step), nearest_(nearest) {
  test::Random random(seed);
  firstA_ = random.rotation();
  firstB_ = random.rotation();
}

void GeodesicMotion::next(Poses& poses, int count) {
  poses.a.clear();
  poses.b.clear();
  for (int i = 0; i < count; ++i, ++query_) {
    const double k = static_cast<double>(query_), angle = k * step_.turn;
    const double apart = nearest_ + kRange * seesaw(k * step_.shift / (2 * kRange));
    poses.a.push_back(test::pose(turned(angle) * firstA_, {0, 0, 0}));
    poses.b.push_back(test::pose(turned(-0.83 * angle) * firstB_, {apart, 0, 0}));
  }
}

}  // namespace fcl_stpbv::benchmark
