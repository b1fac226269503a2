#include "fcl_stpbv/distance/separation.h"

#include "fcl_stpbv/distance/normal_cone.h"

namespace fcl_stpbv {

using Eigen::Vector3d;

CoreContact separateCores(const BodyPair& pair, Sample& x, Work& work) {
  const double touch = pair.gapRounding();
  Sample trial = x;
  Vector3d difference = trial.core * trial.n + trial.across;
  if (trial.core > touch) return CoreContact::apart;
  if (difference.norm() <= touch) return CoreContact::touching;

  NormalCone cone(difference);
  for (int i = 0; i < NormalCone::kMaxCuts; ++i) {
    trial = pair.sampleFrom(cone.middle(), trial.patch, work.steps);
    if (trial.core > x.core) x = trial;
    if (x.core > touch) return CoreContact::apart;
    difference = trial.core * trial.n + trial.across;
    if (difference.norm() <= touch) {
      x = trial;
      return CoreContact::touching;
    }
    if (!cone.cut(difference)) break;
  }
  return CoreContact::overlap;
}

bool bisectToWidest(const BodyPair& pair, Sample& x, Work& work) {
  NormalCone cone(x.core * x.n + x.across);
  if (!cone.cut(x.across)) return pair.isStationary(x);
  Sample flattest = x;
  for (int i = 0; i < NormalCone::kMaxCuts - 1; ++i) {
    Sample trial = pair.sampleFrom(cone.middle(), x.patch, work.steps);
    if (trial.core > x.core) x = trial;
    if (trial.core > 0.0 && trial.across.squaredNorm() < flattest.across.squaredNorm()) flattest = trial;
    if (pair.isStationary(flattest)) break;
    const Vector3d gradient = trial.core > 0.0 ? trial.across : Vector3d(trial.core * trial.n + trial.across);
    Vector3d next;
    if (trial.core > 0.0 && settle(pair, trial, next, work)) {
      x = trial;
      return true;
    }
    if (!cone.cut(gradient)) break;
  }
  // The gap is flat at its top, so its gradient tells the better normal where the values are equal to
  // rounding.
  if (flattest.core >= x.core - pair.gapRounding()) x = flattest;
  return pair.isStationary(x);
}

}  // namespace fcl_stpbv
