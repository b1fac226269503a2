#include "fcl_stpbv/distance/body_pair.h"
#include "fcl_stpbv/vectorized.h"

#include <limits>

namespace fcl_stpbv {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Bound on a body's coordinates; the sum of absolute values spares the root.
double extent(const StpBv& body) { return body.centre().lpNorm<1>() + body.enclosingRadius(); }
}  // namespace

BodyPair::BodyPair(const StpBv& a, const StpBv& b, const Matrix3d& rotation, const Vector3d& translation)
    : a_(a), b_(b), rotation_(rotation), translation_(translation) {
  gapRounding_ = 8.0 * kEpsilon * (extent(a) + extent(b) + translation.lpNorm<1>());
  acrossRounding_ = gapRounding_ + 8.0 * kEpsilon * (a.radii().rho + b.radii().rho);
}

FCL_STPBV_VECTORIZED
Sample BodyPair::sampleFrom(const Vector3d& n, const std::array<int, 2>& hint, int& steps) const {
  const std::array<int, 2> patch{a_.owner(n, hint[0]), b_.owner(opposite(n), hint[1])};
  steps += (hint[0] >= 0 && patch[0] != hint[0]) + (hint[1] >= 0 && patch[1] != hint[1]);
  return sample(n, patch);
}

}  // namespace fcl_stpbv
