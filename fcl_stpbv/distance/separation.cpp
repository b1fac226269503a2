#include "fcl_stpbv/distance/separation.h"

#include "fcl_stpbv/convex/direction_cone.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

namespace {

DirectionTrial asTrial(const Sample& s) { return {s.n, s.core, s.core * s.n + s.across}; }

}  // namespace

CoreContact separateCores(const BodyPair& pair, Sample& x, Work& work) {
  const double touch = pair.gapRounding();
  Sample trial = x;
  const auto touches = [&] { return asTrial(trial).difference.norm() <= touch; };
  if (trial.core > touch) return CoreContact::apart;
  if (touches()) return CoreContact::touching;

  bisectDirections(
      asTrial(trial), 0.0,
      [&](const Vector3d& n) {
        trial = pair.sampleFrom(n, trial.patch, work.steps);
        if (trial.core > x.core) x = trial;
        return asTrial(trial);
      },
      [&](const DirectionTrial&) { return x.core > touch || touches(); });
  if (x.core > touch) return CoreContact::apart;
  if (!touches()) return CoreContact::overlap;
  x = trial;
  return CoreContact::touching;
}

bool bisectToWidest(const BodyPair& pair, Sample& x, Work& work) {
  Sample flattest = x, trial = x;
  bool settled = false;
  bisectDirections(
      asTrial(x), 0.0,
      [&](const Vector3d& n) {
        trial = pair.sampleFrom(n, x.patch, work.steps);
        if (trial.core > x.core) x = trial;
        if (trial.core > 0.0 && trial.across.squaredNorm() < flattest.across.squaredNorm()) flattest = trial;
        return asTrial(trial);
      },
      [&](const DirectionTrial&) {
        if (pair.isStationary(flattest)) return true;
        Vector3d next;
        settled = trial.core > 0.0 && settle(pair, trial, next, work);
        return settled;
      });
  if (settled) {
    x = trial;
    return true;
  }
  // The gap is flat at its top, so its gradient tells the better normal where the values are equal to
  // rounding.
  if (flattest.core >= x.core - pair.gapRounding()) x = flattest;
  return pair.isStationary(x);
}

}  // namespace fcl_stpbv
