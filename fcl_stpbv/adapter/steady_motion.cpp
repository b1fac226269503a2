// Computes FCL's motions, from two poses or from FCL's own objects.
// 1. The rotation from the first pose to the second, as axis times angle, is the angular velocity. Near half
//    a turn its direction is the one that FCL takes, which depends on the last digits of the given matrices.
// 2. CCDM_LINEAR: the body's origin moves on a straight line. CCDM_TRANS: the same without the rotation.
// 3. CCDM_SCREW: Chasles' theorem: there is an axis that moves only along itself. Perpendicular to it the
//    origin moves on an arc, whose chord is the perpendicular part of the translation. Its initial velocity
//    is turning = angle / 2 (across / tan(angle / 2) - axis x across).
// 4. The axis itself is never computed. As the angle goes to 0, the axis moves to infinity, but this velocity
//    converges to that of the straight line.
// 5. FCL's motion objects are identified by their type and converted in the same way.
#include <fcl/math/motion/interp_motion.h>
#include <fcl/math/motion/screw_motion.h>
#include <fcl/math/motion/translation_motion.h>

#include <cmath>
#include <typeinfo>

#include "fcl_stpbv/adapter/continuous_collide.h"
#include "fcl_stpbv/convex/relative_pose.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Gives access to FCL's protected members that contain both ends of a motion. FCL's own derived data cannot
/// be used: they are wrong for a screw without rotation (the translation is scaled by its own length), and
/// unset for an interpolation made by InterpMotion(tf1, tf2, O).
struct ScrewEnds : fcl::ScrewMotion<double> {
  using fcl::ScrewMotion<double>::tf1;
  using fcl::ScrewMotion<double>::tf2;
};
struct InterpolationEnds : fcl::InterpMotion<double> {
  using fcl::InterpMotion<double>::tf1;
  using fcl::InterpMotion<double>::tf2;
};

/// The motion as this type; null if it is of any other type. A derived type counts as another one, because it
/// may move differently.
template <typename Motion>
const Motion* exactly(const fcl::MotionBased& motion) {
  return typeid(motion) == typeid(Motion) ? static_cast<const Motion*>(&motion) : nullptr;
}

/// Both ends of a motion, as given and made rigid.
struct Ends {
  Isometry3d givenBegin, givenEnd, begin = givenBegin, end = givenEnd;
  bool valid = makeRigid(begin) && makeRigid(end);

  Ends(const Isometry3d& first, const Isometry3d& last) : givenBegin(first), givenEnd(last) {}

  /// The rotation vector (rad) from the first pose to the last, in the sense of rotation that FCL chooses.
  Vector3d turn() const {
    const auto between = [](const Isometry3d& from, const Isometry3d& to) {
      return Eigen::AngleAxisd(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
    };
    const Eigen::AngleAxisd exact = between(begin, end);
    if (exact.angle() > 3 && exact.axis().dot(between(givenBegin, givenEnd).axis()) < 0)
      return (exact.angle() - 2 * EIGEN_PI) * exact.axis();
    return exact.angle() * exact.axis();
  }
};

/// The motion in which this point of the body's frame moves on a straight line.
SteadyMotion about(const Ends& ends, const Vector3d& point) {
  const Vector3d angular = ends.turn();
  return {ends.begin, ends.end * point - ends.begin * point, (ends.begin.linear() * point).cross(angular),
          angular};
}

/// The motion about an axis that moves only along itself (Chasles).
SteadyMotion screw(const Ends& ends) {
  SteadyMotion motion = about(ends, Vector3d(0, 0, 0));
  const double angle = motion.angular.norm(), half = 0.5 * angle;
  if (!(angle > 0)) return motion;
  const Vector3d axis = motion.angular / angle, along = axis.dot(motion.linear) * axis;
  const Vector3d across = motion.linear - along;
  motion.turning = half / std::tan(half) * across - 0.5 * motion.angular.cross(across);
  motion.linear = along;
  return motion;
}

}  // namespace

// With the sine of the half angle nothing cancels for small angles. The factor of `turning` is sin(angle t) /
// angle = chord cos(half). The factor of the inward part is (1 - cos(angle t)) / angle^2 = chord^2 / 2.
Isometry3d SteadyMotion::at(double t, Vector3d* velocity) const {
  const double angle = angular.norm(), half = 0.5 * t * angle, s = std::sin(half), c = std::cos(half);
  const double chord = half == 0 ? t : t * (s / half);
  const Vector3d inward = angular.cross(turning);
  Isometry3d pose = begin;
  if (angle > 0) {
    const Vector3d axis = angular / angle;
    pose.linear() = Eigen::Quaterniond(c, s * axis.x(), s * axis.y(), s * axis.z()) * begin.linear();
  }
  pose.translation() += t * linear + chord * c * turning + 0.5 * chord * chord * inward;
  if (velocity) *velocity = linear + (1 - 2 * s * s) * turning + chord * c * inward;
  return pose;
}

bool steadyMotion(const Isometry3d& begin, const Isometry3d& end, fcl::CCDMotionType type,
                  SteadyMotion& motion) {
  const Ends ends(begin, end);
  if (!ends.valid) return false;
  switch (type) {
    case fcl::CCDM_TRANS:
      motion = {ends.begin, ends.end.translation() - ends.begin.translation(), Vector3d(0, 0, 0),
                Vector3d(0, 0, 0)};
      return true;
    case fcl::CCDM_LINEAR:
      motion = about(ends, Vector3d(0, 0, 0));
      return true;
    case fcl::CCDM_SCREW:
      motion = screw(ends);
      return true;
    default:
      return false;
  }
}

bool steadyMotion(const fcl::MotionBased& motion, SteadyMotion& result) {
  if (const auto* m = exactly<fcl::TranslationMotion<double>>(motion)) {
    fcl::TranslationMotion<double> own = *m;  // because integrate() moves the object that it is called on
    Isometry3d begin;
    own.integrate(0);
    own.getCurrentTransform(begin);
    Isometry3d end = begin;
    end.translation() += m->getVelocity();
    return steadyMotion(begin, end, fcl::CCDM_TRANS, result);
  }
  if (const auto* m = exactly<fcl::ScrewMotion<double>>(motion))
    return steadyMotion(m->*&ScrewEnds::tf1, m->*&ScrewEnds::tf2, fcl::CCDM_SCREW, result);
  if (const auto* m = exactly<fcl::InterpMotion<double>>(motion)) {
    const Ends ends(m->*&InterpolationEnds::tf1, m->*&InterpolationEnds::tf2);
    if (!ends.valid) return false;
    // FCL's constructors without a reference point leave the point uninitialised, and FCL's object then moves
    // about it. This does not matter if nothing rotates. If the point is too far away for a body, nothing is
    // known.
    constexpr double kFar = 1e6;  // m
    const Vector3d& given = m->getReferencePoint();
    result = about(ends, Vector3d(0, 0, 0));
    if (result.angular.isZero(0)) return true;
    if (!(given.lpNorm<1>() < kFar)) return false;
    result = about(ends, given);
    return true;
  }
  return false;
}

}  // namespace fcl_stpbv
