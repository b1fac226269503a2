// Chooses r and R for a body: r from its smallest width, which is the penetration depth of its hull and an
// identical copy, R from its smallest enclosing ball and the bulge that r allows (docs/choosing_r_and_R.md).
#include "fcl_stpbv/robot/fitted_radii.h"

#include <algorithm>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"

namespace fcl_stpbv::detail {

BodySize sizeOf(const std::vector<Eigen::Vector3d>& points) {
  BodySize size;
  size.ball = StpBv::smallestR(points, 0);
  // The smallest width is the penetration depth of the hull in itself: the shortest way out of its difference
  // with itself.
  const auto hull = hullGeometry(points);
  const DistanceAnswer self =
      fcl_stpbv::distance(*hull, fcl::Transform3d::Identity(), *hull, fcl::Transform3d::Identity());
  size.width = std::min(std::max(0.0, -self.upper), 2 * size.ball);  // 0 instead of -0 for a single point
  return size;
}

StpBvOptions fittedRadii(const BodySize& size) {
  constexpr double kWidth = 1.0 / 20, kBall = 1.0 / 250, kMost = StpBvOptions().r;
  const double r = std::min(kMost, std::max(kWidth * size.width, kBall * size.ball));
  return {r, fittedR(size.ball, r)};
}

// Where the surface is highest over the hull, a big ball of radius rho = R - r touches points within a ball
// of radius b. The big ball's centre is at least sqrt(rho^2 - b^2) from the hull of these points. So the
// surface is at most r + rho - sqrt(rho^2 - b^2) over it.
double fittedR(double ball, double r) {
  constexpr double kBall = 1.0 / 200;
  const double bulge = std::max(r, kBall * ball);
  return bulge > 0 ? r + (ball * ball + bulge * bulge) / (2 * bulge) : StpBvOptions().R;
}

StpBvOptions withFitted(const StpBvOptions& given, bool fitSmallRadius, bool fitBigRadius,
                        const std::function<BodySize()>& size) {
  if (!fitSmallRadius && !fitBigRadius) return given;
  const BodySize body = size();
  const double r = fitSmallRadius ? fittedRadii(body).r : given.r;
  return {r, fitBigRadius ? fittedR(body.ball, r) : given.R};
}

}  // namespace fcl_stpbv::detail
