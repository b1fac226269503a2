// Motions as FCL makes them, from two poses or from FCL's own objects.
// 1. The rotation from the first pose to the second, as axis and angle, is the angular velocity.
// 2. CCDM_LINEAR: the body's origin moves on a straight line. CCDM_TRANS: the same without the rotation.
// 3. CCDM_SCREW: Chasles' theorem. Some axis moves along itself only; it lies where the translation across
//    it is the chord of the turn: point = origin + (across + axis x way / tan(angle / 2)) / 2.
// 4. FCL's objects are read by their type, and go the same way.
#include <fcl/math/motion/interp_motion.h>
#include <fcl/math/motion/screw_motion.h>
#include <fcl/math/motion/translation_motion.h>

#include <cmath>

#include "fcl_stpbv/adapter/continuous_collide.h"
#include "fcl_stpbv/convex/relative_pose.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Isometry3d;
using Eigen::Vector3d;

/// FCL keeps both ends of a motion to itself, and what it makes of them is wrong for a screw without a turn
/// (the way times its own length) and unset for an interpolation about a given point.
struct ScrewEnds : fcl::ScrewMotion<double> {
  using fcl::ScrewMotion<double>::tf1;
  using fcl::ScrewMotion<double>::tf2;
};
struct InterpolationEnds : fcl::InterpMotion<double> {
  using fcl::InterpMotion<double>::tf1;
  using fcl::InterpMotion<double>::tf2;
};

SteadyMotion about(const Isometry3d& begin, const Isometry3d& end, const Vector3d& point) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(end.linear() * begin.linear().transpose()));
  return {begin, begin * point, end * point - begin * point, turn.angle() * turn.axis()};
}

/// The axis that stays where it is but for the way along itself (Chasles).
SteadyMotion screw(const Isometry3d& begin, const Isometry3d& end) {
  SteadyMotion motion = about(begin, end, Vector3d(0, 0, 0));
  const double angle = motion.angular.norm();
  constexpr double kStraight = 1e-10;  // FCL's own; below it the axis is nowhere
  if (angle < kStraight) return motion;
  const Vector3d axis = motion.angular / angle, way = motion.linear;
  const Vector3d across = way - axis.dot(way) * axis;
  motion.point = begin.translation() + 0.5 * (across + axis.cross(way) / std::tan(0.5 * angle));
  motion.linear = axis.dot(way) * axis;
  return motion;
}

}  // namespace

Isometry3d SteadyMotion::at(double t) const {
  const double angle = angular.norm();
  Isometry3d pose = begin;
  if (angle > 0) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(t * angle, angular / angle).toRotationMatrix();
    pose.linear() = turn * begin.linear();
    pose.translation() = point + turn * (begin.translation() - point);
  }
  pose.translation() += t * linear;
  return pose;
}

bool steadyMotion(const Isometry3d& givenBegin, const Isometry3d& givenEnd, fcl::CCDMotionType type,
                  SteadyMotion& motion) {
  Isometry3d begin = givenBegin, end = givenEnd;
  if (!makeRigid(begin) || !makeRigid(end)) return false;
  switch (type) {
    case fcl::CCDM_TRANS:
      end.linear() = begin.linear();
      [[fallthrough]];
    case fcl::CCDM_LINEAR:
      motion = about(begin, end, Vector3d(0, 0, 0));
      return true;
    case fcl::CCDM_SCREW:
      motion = screw(begin, end);
      return true;
    default:
      return false;
  }
}

bool steadyMotion(const fcl::MotionBased& motion, SteadyMotion& result) {
  if (const auto* m = dynamic_cast<const fcl::TranslationMotion<double>*>(&motion)) {
    Isometry3d begin;
    m->integrate(0);
    m->getCurrentTransform(begin);
    Isometry3d end = begin;
    end.translation() += m->getVelocity();
    return steadyMotion(begin, end, fcl::CCDM_TRANS, result);
  }
  if (const auto* m = dynamic_cast<const fcl::ScrewMotion<double>*>(&motion))
    return steadyMotion(m->*&ScrewEnds::tf1, m->*&ScrewEnds::tf2, fcl::CCDM_SCREW, result);
  if (const auto* m = dynamic_cast<const fcl::InterpMotion<double>*>(&motion)) {
    Isometry3d begin = m->*&InterpolationEnds::tf1, end = m->*&InterpolationEnds::tf2;
    if (!makeRigid(begin) || !makeRigid(end)) return false;
    // Unset by FCL's constructors without one: any point does, but for numbers that are none.
    constexpr double kFar = 1e6;
    const Vector3d& given = m->getReferencePoint();
    result = about(begin, end, given.lpNorm<1>() < kFar ? given : Vector3d(0, 0, 0));
    return true;
  }
  return false;
}

}  // namespace fcl_stpbv
