#include "fcl_stpbv/distance/body_pair.h"

#include <limits>

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

double extent(const StpBv& body) { return body.centre().norm() + body.enclosingRadius(); }
}  // namespace

Sample BodyPair::sample(const Vector3d& n, const std::array<int, 2>& patch) const {
  const PosedPatch a = patchA(patch[0]), b = patchB(patch[1]);
  const Vector3d y = coreDifference(a, b, n);
  return {n, patch, coreGap(a, b, n), y - y.dot(n) * n};
}

Sample BodyPair::sampleFrom(const Vector3d& n, const std::array<int, 2>& hint, int& steps) const {
  const std::array<int, 2> patch{a_.owner(n, hint[0]), b_.owner(opposite(n), hint[1])};
  steps += (patch[0] != hint[0]) + (patch[1] != hint[1]);
  return sample(n, patch);
}

double BodyPair::gapRounding() const {
  return 8.0 * kEpsilon * (extent(a_) + extent(b_) + translation_.norm());
}

double BodyPair::acrossRounding() const {
  return gapRounding() + 8.0 * kEpsilon * (a_.radii().rho + b_.radii().rho);
}

}  // namespace fcl_stpbv
