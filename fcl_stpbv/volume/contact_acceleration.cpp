// The bounds on c of docs/choosing_r_and_R.md. c falls as any radius of curvature grows. So it is largest for
// two balls with the radii r, and smallest for a body 2 of radius R against a plane.
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/radii_advice.h"

namespace fcl_stpbv {

ContactAcceleration contactAcceleration(const Radii& body1, const Radii& body2, double distance, double speed,
                                        double turning) {
  const double least = turning > 0 ? -body2.R * turning * turning : 0;
  const double sum = distance + body1.r + body2.r, rest = distance + body1.r;
  if (!(sum > 0)) {
    // At sum = 0 this is the limit of the formula below; from deeper overlaps nothing follows.
    const bool bounded = !(speed > 0) && (!(turning > 0) || (sum == 0 && body2.r == 0));
    return {least, bounded ? 0 : detail::kInfinity};
  }
  // The largest value of (speed + r y)^2 / sum - r y^2 over all y up to `turning`. The formulas below avoid
  // this difference, because with a large r it would consist of rounding only.
  if (speed < turning * rest) return {least, speed * speed / rest};
  return {least, (speed * speed + body2.r * turning * (2 * speed - turning * rest)) / sum};
}

}  // namespace fcl_stpbv
