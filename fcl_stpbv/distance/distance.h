// Exact signed distance between two STP-BVs with its derivative and a certificate on both sides.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

/// How good an answer is.
enum class DistanceStatus {
  exact,    ///< the signed distance to rounding: separated, touching, or penetrating by at most r1 + r2;
            ///< beside half spaces and planes, and of two simple shapes, often deeper too
  local,    ///< deeper: a locally best separating translation; the true value lies in [lower, upper]
  bounded,  ///< not solved to rounding; the true value lies in [lower, upper]
  invalid,  ///< a pose is no rigid motion, each entry of its rotation to 1e-6, or is 1e150 m away; bounds
            ///< are infinite, everything else is zero
};

/// [linear; angular] derivative with respect to a body's twist about the body's origin, world axes.
/// Unaligned, so that its layout does not depend on the caller's compiler flags.
using TwistGradient = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;

/// Answer to one query. World frame, metres.
struct Distance {
  DistanceStatus status = DistanceStatus::invalid;  ///< how good the answer is
  double distance = 0;                              ///< signed: negative where the bodies overlap
  /// Certified: the gap between the two supporting planes of `normal`, rounded down.
  double lower = -std::numeric_limits<double>::infinity();
  /// Certified, rounded up: from the distance of two points of the cores; where these overlap, minus the
  /// depth that is proven at least. Both bounds are rounded by more than arithmetic can be off, so `lower <=
  /// truth <= upper` holds as it stands (docs/theory.md, 5). They are apart by roundings of the size, or of R
  /// where the cores all but touch.
  double upper = std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal{0, 0, 0};  ///< unit, from body 1 to body 2
  std::array<Eigen::Vector3d, 2> point{Eigen::Vector3d(0, 0, 0),
                                       Eigen::Vector3d(0, 0, 0)};  ///< witness points, on the smooth surfaces
  std::array<int, 2> patch{-1, -1};                                ///< patches the witness points lie on
  int patchPairs = 0;                                              ///< patch pairs solved, the work done
  int patchSteps = 0;  ///< region boundaries crossed on the two Gauss maps

  /// The same answer for the pair in its other order.
  Distance mirrored() const {
    Distance other = *this;
    other.normal = -normal;
    other.point = {point[1], point[0]};
    other.patch = {patch[1], patch[0]};
    return other;
  }
  /// Derivative of the distance with respect to the twist of body `which` (0 or 1) about `origin`, the
  /// position of that body's frame (paper eq. 2; docs/theory.md, 6).
  TwistGradient gradient(int which, const Eigen::Vector3d& origin) const {
    const Eigen::Vector3d n = (which == 0 ? -1.0 : 1.0) * normal;
    TwistGradient g;
    g.head<3>() = n;
    g.tail<3>() = (point[static_cast<std::size_t>(which)] - origin).cross(n);
    return g;
  }
};

/// What a pair remembers between queries to start the next one near its answer; the
/// adapter fills one from FCL's polyhedral witness. Owned by the caller; optional; never
/// changes an answer, only how soon it is found.
struct PairCache {
  Eigen::Vector3d normal{0, 0, 0};   ///< last normal, world frame; zero: none
  std::array<int, 2> patch{-1, -1};  ///< last patches; -1: none
  /// The last normal seen by each body, its own frame, outward; zero: not known.
  std::array<Eigen::Vector3f, 2> seen{Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0, 0, 0)};

  /// The same for the pair in its other order.
  PairCache mirrored() const { return {-normal, {patch[1], patch[0]}, {seen[1], seen[0]}}; }
  /// The last normal, unit; zero where there is none, or what the caller has put there is not near unit
  /// length.
  Eigen::Vector3d direction() const {
    const double squared = normal.squaredNorm();
    return isDirection(squared) ? Eigen::Vector3d(normal / std::sqrt(squared)) : Eigen::Vector3d(0, 0, 0);
  }
  /// Whether a vector of this squared length is near enough to unit length to be a direction.
  static constexpr bool isDirection(double squared) { return squared > 0.25 && squared < 4.0; }
};

/// Signed distance between `a` placed at `poseA` and `b` placed at `poseB`.
/// Never throws, allocates or returns NaN.
Distance distance(const StpBv& a, const Eigen::Isometry3d& poseA, const StpBv& b,
                  const Eigen::Isometry3d& poseB, PairCache* cache = nullptr);

}  // namespace fcl_stpbv
