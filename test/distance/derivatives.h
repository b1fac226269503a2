// A pair of bodies for the derivative tests, which query it at poses that move along twists.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fcl_stpbv/distance/hessian.h"
#include "test/reference/shape_reference.h"

namespace fcl_stpbv::test {

using Twist = Eigen::Matrix<double, 6, 1>;
using Twists = Eigen::Matrix<double, 12, 1>;
using Poses = std::array<Eigen::Isometry3d, 2>;

/// The poses after a time `t` on constant twists [linear; angular] about the bodies' origins.
Poses after(const Poses& at, const Twists& twists, double t);

/// An STP-BV (body 1) and another STP-BV or a simple shape.
struct DerivativePair {
  StpBv::Ptr volume;
  StpBv::Ptr other;  ///< null: `shape` is used
  TestShape shape;

  Distance ask(const Poses& at) const;
  bool second(const Poses& at, const Distance& d, DistanceHessian& h) const;
  /// Names the features that face each other. As long as the signature is the same, the distance is smooth.
  std::vector<int> signature(const Poses& at, const Distance& d) const;
  double margins() const { return volume->radii().r + (other ? other->radii().r : shape.shape.margin); }
  double rho() const { return std::max(volume->radii().rho, other ? other->radii().rho : 0.0); }
};

Twists gradientOf(const Distance& d, const Poses& at);

}  // namespace fcl_stpbv::test
