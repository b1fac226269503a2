// Compares fcl::continuousCollide with the library's function.
#include <fcl/math/motion/interp_motion.h>
#include <fcl/narrowphase/continuous_collision.h>

#include "fcl_stpbv/adapter/continuous_collide.h"
#include "test/adapter/parity/questions.h"

namespace fcl_stpbv::parity {

using namespace test;
using Eigen::Isometry3d;

namespace {

constexpr double kTolerance = 1e-4;  // of the time of contact: FCL's default
constexpr double kClear = 1e-6;      // m: at smaller distances rounding decides
constexpr double kAdvanced = 1e-3;   // m: distance at which FCL's advancement may stop

/// From one pose to another, with the frame's origin on a line. FCL's own constructor for two poses does not
/// initialise the point that moves straight.
std::shared_ptr<fcl::MotionBased> motionOf(const Isometry3d& begin, const Isometry3d& end) {
  const Eigen::Matrix3d r1 = begin.linear(), r2 = end.linear();
  return std::make_shared<fcl::InterpMotion<double>>(r1, begin.translation(), r2, end.translation(),
                                                     Eigen::Vector3d(0, 0, 0));
}

void askMotion(bool conservative, const Type& ta, const Type& tb, Random& random, Findings& found) {
  Isometry3d ends[4];
  for (Isometry3d& end : ends) end = pose(random.rotation(), 0.7 * random.direction());
  const auto a = motionOf(ends[0], ends[1]), b = motionOf(ends[2], ends[3]);
  fcl::ContinuousCollisionRequestd request(10, kTolerance, fcl::CCDM_LINEAR);
  fcl::ContinuousCollisionResultd ours, theirs;
  const double t =
      fcl_stpbv::continuousCollide(ta.geometry.get(), a.get(), tb.geometry.get(), b.get(), request, ours);
  const auto truth = [&](const fcl::ContinuousCollisionResultd& at) {
    return truthOf(ta.pieces(at.contact_tf1), tb.pieces(at.contact_tf2)).distance;
  };
  if (t < 0) {
    found.unanswered();
  } else {
    found.ours("the return value is not the time of contact", t != ours.time_of_contact);
    found.ours("no contact at the time of contact", ours.is_collide && truth(ours) > kClear);
  }
  request.ccd_solver_type = conservative ? fcl::CCDC_CONSERVATIVE_ADVANCEMENT : fcl::CCDC_NAIVE;
  const double when =
      fcl::continuousCollide(ta.geometry.get(), a.get(), tb.geometry.get(), b.get(), request, theirs);
  if (when < 0) return found.theirs('n', true);
  if (t < 0) return;
  if (theirs.is_collide) {
    const double there = truth(theirs);
    found.theirs('u', there > (conservative ? kAdvanced : kClear));
    found.ours("a contact is missed", !ours.is_collide && there <= 0);
    found.theirs('l', ours.is_collide && when > t + kTolerance);
    found.ours("late", ours.is_collide && there <= 0 && t > when + kTolerance);
  }
  found.theirs('m', ours.is_collide && !theirs.is_collide);
}

}  // namespace

Question motionQuestion(bool conservative) {
  return [conservative](const Type& a, const Type& b, int, Random& random, Findings& found) {
    askMotion(conservative, a, b, random, found);
  };
}

}  // namespace fcl_stpbv::parity
