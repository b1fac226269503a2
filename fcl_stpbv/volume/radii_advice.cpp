// Chooses r and R:
// 1. An allowed acceleration gives the smallest r and the largest R. Together they give the smallest volume
//    within that acceleration.
// 2. The over-cover of this volume falls as the allowed acceleration grows. So if it exceeds the clearance,
//    bisection finds the lowest acceleration within the clearance, and a fifth more is allowed.
// 3. The clearance that is left is used for a smaller R.
// 4. A long period also asks for a smaller R, because the error of linear constraints is proportional to R.
#include "fcl_stpbv/volume/radii_advice.h"

#include <cmath>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/covered_hull.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Points = std::vector<Eigen::Vector3d>;

// Range of the task's numbers (m, s, m/s, rad/s, m/s^2). Nothing on a robot is outside it, and the products
// of a few such numbers are finite.
constexpr double kLeast = 1e-9, kGreatest = 1e9;

void check(const RadiiTask& task) {
  requireNumber("adviseRadii: clearance", task.clearance, kLeast, kGreatest);
  requireNumber("adviseRadii: acceleration", task.acceleration, kLeast, kGreatest);
  requireNumber("adviseRadii: speed", task.speed, 0, kGreatest);
  requireNumber("adviseRadii: turning", task.turning, 0, kGreatest);
  requireNumber("adviseRadii: period", task.period, 0, kGreatest);
  requireNumber("adviseRadii: distance", task.distance, 0, kGreatest);
}

/// The last good number between `good` and `bad`, up to rounding, by bisection.
template <class IsGood>
double lastGood(double good, double bad, const IsGood& isGood) {
  if (isGood(bad)) return bad;
  for (int round = 0; round < 100; ++round) {  // more rounds than a double has bits
    const double middle = 0.5 * (good + bad);
    (isGood(middle) ? good : bad) = middle;
  }
  return good;
}

ContactAcceleration accelerationOf(const RadiiTask& task, double r, double R) {
  const Radii own{r, R, R - r};
  return contactAcceleration(task.bothRound ? own : kFlatRadii, own, task.distance, task.speed, task.turning);
}

/// The radii of the smallest volume with at most this acceleration; r is infinite if no r is large enough.
StpBvOptions radiiFor(const RadiiTask& task, double acceleration) {
  const auto most = [&](double r) { return accelerationOf(task, r, kLargestR).most <= acceleration; };
  const auto least = [&](double R) { return -accelerationOf(task, 0, R).least <= acceleration; };
  return {most(kLargestR) ? lastGood(kLargestR, 0, most) : kInfinity, lastGood(0, kLargestR, least)};
}

class Adviser {
 public:
  Adviser(const Points& points, const RadiiTask& task)
      : points_(points),
        task_(task),
        missed_(0.5 * std::pow(task.turning * task.period, 2)),
        smallestR_(StpBv::smallestR(points, 0)),  // throws an Error for points without a volume

        hull_(points) {}

  RadiiAdvice advise() const {
    RadiiAdvice asked = with(task_.acceleration);
    asked.leastClearance = lost(asked);
    asked.meetsBoth = keeps(asked);
    if (asked.meetsBoth) return rounder(asked);
    const double least = leastKept();
    RadiiAdvice best = with(kSpare * least);
    best = rounder(keeps(best) ? best : with(least));
    best.leastClearance = asked.leastClearance;
    return best;
  }

 private:
  /// Factor on the lowest acceleration. The last bit of clearance changes the acceleration only a little, but
  /// R a lot: if all clearance is used for r, R is tens of metres, and a controlled robot's joints have to
  /// follow every tilt.
  static constexpr double kSpare = 1.2;
  // leastKept() raises the acceleration by the factor kStep until the clearance is kept. Then it bisects the
  // last step in kRounds rounds, to a thousandth. kWithin is the relative accuracy of R.
  static constexpr double kStep = 2;
  static constexpr int kRounds = 10;
  static constexpr double kWithin = 1e-3;
  static constexpr double kOfAPoint = 1e-9;  // m; the least R of a single point, whose smallest R is 0

  /// The least acceleration whose radii keep the clearance, if the task's own acceleration is too low for
  /// that.
  double leastKept() const {
    double low = task_.acceleration, high = low * kStep;
    for (; !keeps(with(high)); high *= kStep) {
      if (high > kGreatest) refuse();
      low = high;
    }
    for (int round = 0; round < kRounds; ++round) {
      const double middle = std::sqrt(low * high);
      (keeps(with(middle)) ? high : low) = middle;
    }
    return high;
  }

  /// The part of the clearance that is used, including the error of linear constraints within a period (m).
  static double lost(const RadiiAdvice& advice) { return advice.overCover + advice.perPeriod; }
  bool keeps(const RadiiAdvice& advice) const { return lost(advice) <= task_.clearance; }

  /// Every R above this one has a volume, and no R of a robot is smaller.
  double leastR(double r, double largest) const {
    return std::max(smallestR_ + r, std::min(kOfAPoint, largest));
  }

  /// Uses the rest of the clearance for a smaller R, because the witness points then slide less.
  RadiiAdvice rounder(const RadiiAdvice& asked) const {
    const double r = asked.radii.r;
    double low = leastR(r, asked.radii.R), high = asked.radii.R;
    RadiiAdvice best = asked;
    while (high > (1 + kWithin) * low) {
      const double middle = std::sqrt(low * high);
      const RadiiAdvice tried = withRadii({r, middle});
      const bool good = keeps(tried);
      (good ? high : low) = middle;
      if (good) best = tried;
    }
    best.meetsBoth = asked.meetsBoth;
    best.leastClearance = asked.leastClearance;
    return best;
  }

  /// The radii with at most this acceleration that use the least clearance. The body bulges beyond r by about
  /// b^2 / (2 R), where b is derived from the volume. The linear constraints are off by `missed_` times R.
  /// The sum is smallest if both are equal.
  RadiiAdvice with(double acceleration) const {
    RadiiAdvice best = withRadii(radiiFor(task_, acceleration));
    const double r = best.radii.r, widest = best.radii.R;
    const double least = (1 + kWithin) * leastR(r, widest);
    for (int round = 0; round < 3 && std::isfinite(best.overCover); ++round) {
      const double bulge = 2 * best.radii.R * (best.overCover - r);  // b^2
      const double R = std::max(least, std::sqrt(std::max(0.0, bulge) / (2 * missed_)));
      if (!(R < widest)) break;
      const RadiiAdvice tried = withRadii({r, R});
      if (!(lost(tried) < lost(best))) break;
      best = tried;
    }
    return best;
  }

  RadiiAdvice withRadii(const StpBvOptions& radii) const {
    RadiiAdvice advice{radii, false, 0, kInfinity, 0, kInfinity};
    const double r = advice.radii.r, R = advice.radii.R;
    if (!(R > smallestR_ + r)) return advice;
    const ContactAcceleration reached = accelerationOf(task_, r, R);
    advice.acceleration = reached.size();
    advice.overCover = hull_.max(*StpBv::build(points_, {r, R}));
    advice.perPeriod = missed_ * R;
    return advice;
  }

  [[noreturn]] void refuse() const {
    throw Error(formatted(
        "adviseRadii: found no r and R that keep a clearance of %.9g m with a period of %.9g s; state "
        "a larger clearance, a shorter period or a slower motion",
        task_.clearance, task_.period));
  }

  const Points& points_;
  const RadiiTask& task_;
  double missed_;     // share of R: how far d may fall below a constraint that is linear for a period
  double smallestR_;  // the smallest R without a margin (m)
  CoveredHull hull_;
};

}  // namespace

RadiiAdvice adviseRadii(const Points& points, const RadiiTask& task) {
  check(task);
  return Adviser(points, task).advise();
}

// The bounds on c of docs/choosing_r_and_R.md. c falls as any radius of curvature grows. So it is largest for
// two balls with the radii r, and smallest for a body 2 of radius R against a plane.
ContactAcceleration contactAcceleration(const Radii& body1, const Radii& body2, double distance, double speed,
                                        double turning) {
  const double least = turning > 0 ? -body2.R * turning * turning : 0;
  const double sum = distance + body1.r + body2.r, rest = distance + body1.r;
  if (!(sum > 0)) {
    // At sum = 0 this is the limit of the formula below; from deeper overlaps nothing follows.
    const bool bounded = !(speed > 0) && (!(turning > 0) || (sum == 0 && body2.r == 0));
    return {least, bounded ? 0 : kInfinity};
  }
  // The largest value of (speed + r y)^2 / sum - r y^2 over all y up to `turning`. The formulas below avoid
  // this difference, because with a large r it would consist of rounding only.
  if (speed < turning * rest) return {least, speed * speed / rest};
  return {least, (speed * speed + body2.r * turning * (2 * speed - turning * rest)) / sum};
}

}  // namespace fcl_stpbv
