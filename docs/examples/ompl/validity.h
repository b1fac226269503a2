// Answers OMPL's queries about states and motions, by this library's proofs and as plain FCL users do.
#pragma once

#include <fcl/narrowphase/collision.h>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/objectives/StateCostIntegralObjective.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>

#include <algorithm>
#include <chrono>

#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/motion_check.h"
#include "scene.h"

namespace example {

namespace ob = ompl::base;

inline const double* valuesOf(const ob::State* state) {
  return state->as<ob::RealVectorStateSpace::StateType>()->values;
}

/// Number of queries, and the time of their answers.
struct Count {
  long asked = 0;
  double seconds = 0;

  template <class Ask>
  auto operator()(const Ask& ask) {
    const auto start = std::chrono::steady_clock::now();
    const auto answer = ask();
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    ++asked;
    return answer;
  }
};

/// A state is valid if no pair is within the margin; the check stops early. The clearance of a state is the
/// least exact distance of all pairs.
class SmoothStates : public ob::StateValidityChecker {
 public:
  SmoothStates(const ob::SpaceInformationPtr& space, const Scene& scene, fcl_stpbv::MotionCheck& check,
               fcl_stpbv::CollisionConstraints& rows)
      : ob::StateValidityChecker(space), scene_(scene), check_(check), rows_(rows), distances_(rows.rows()) {}
  bool isValid(const ob::State* state) const override {
    return count([&] { return check_.isFree(scene_.whole(valuesOf(state))); });
  }
  double clearance(const ob::State* state) const override {
    rows_.evaluate(scene_.whole(valuesOf(state)), distances_);
    return distances_.minCoeff();
  }
  mutable Count count;

 private:
  const Scene& scene_;
  fcl_stpbv::MotionCheck& check_;
  fcl_stpbv::CollisionConstraints& rows_;
  mutable Eigen::VectorXd distances_;
};

/// The optimisation objective: the integral of one over the clearance along the path.
class Clearance : public ob::StateCostIntegralObjective {
 public:
  explicit Clearance(const ob::SpaceInformationPtr& space) : ob::StateCostIntegralObjective(space, false) {}
  ob::Cost stateCost(const ob::State* state) const override {
    constexpr double kTouch = 1e-3;  // m: a smaller clearance costs no more
    return ob::Cost(1 / std::max(kTouch, si_->getStateValidityChecker()->clearance(state)));
  }
};

/// A motion is valid if it is proven free. The last valid state is the one before the first contact.
class ProvenMotions : public ob::MotionValidator {
 public:
  ProvenMotions(const ob::SpaceInformationPtr& space, const Scene& scene, fcl_stpbv::MotionCheck& check)
      : ob::MotionValidator(space), scene_(scene), check_(check) {}
  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    return count(
        [&] { return check_.isMotionFree(scene_.whole(valuesOf(from)), scene_.whole(valuesOf(to))); });
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& lastValid) const override {
    const fcl_stpbv::MotionBracket found =
        count([&] { return check_.firstContact(scene_.whole(valuesOf(from)), scene_.whole(valuesOf(to))); });
    if (found.verdict == fcl_stpbv::MotionVerdict::free) return true;
    lastValid.second = found.from;  // proven free up to here
    if (lastValid.first) si_->getStateSpace()->interpolate(from, to, lastValid.second, lastValid.first);
    return false;
  }
  mutable Count count;

 private:
  const Scene& scene_;
  fcl_stpbv::MotionCheck& check_;
};

/// `fcl::collide` of the hulls, pair by pair. Motions are checked by OMPL's own samples.
class HullStates : public ob::StateValidityChecker {
 public:
  HullStates(const ob::SpaceInformationPtr& space, const Scene& scene)
      : ob::StateValidityChecker(space), scene_(scene), state_(scene.kinematics->makeState()) {}
  bool isValid(const ob::State* state) const override {
    return count([&] { return isFree(scene_.whole(valuesOf(state))); });
  }
  mutable Count count;

 private:
  bool isFree(const Eigen::VectorXd& q) const {
    scene_.kinematics->forward(q, state_);
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    for (const fcl_stpbv::CheckedPair& pair : scene_.pairs) {
      const fcl_stpbv::Body& a = scene_.hulls->bodies[at(pair.body)];
      const Eigen::Isometry3d poseA = state_.link[at(a.link)] * a.pose;
      const fcl::CollisionGeometryd* other = nullptr;
      Eigen::Isometry3d poseB;
      if (pair.obstacle) {
        other = scene_.hullObstacles[at(pair.other)].geometry().get();
        poseB = scene_.hullObstacles[at(pair.other)].pose();
      } else {
        const fcl_stpbv::Body& b = scene_.hulls->bodies[at(pair.other)];
        other = b.geometry.get();
        poseB = state_.link[at(b.link)] * b.pose;
      }
      fcl::CollisionResultd result;
      fcl::collide(a.geometry.get(), poseA, other, poseB, fcl::CollisionRequestd(), result);
      if (result.isCollision()) return false;
    }
    return true;
  }

  const Scene& scene_;
  mutable fcl_stpbv::Kinematics::State state_;
};

}  // namespace example
