// The data of a CollisionChecker: the poses of the bodies and their spheres, and the separating plane of each
// pair.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/packed.h"
#include "fcl_stpbv/robot/collision_checker.h"
#include "fcl_stpbv/robot/kept_plane.h"
#include "fcl_stpbv/robot/pose_rounding.h"
#include "fcl_stpbv/robot/sphere_pairs.h"

namespace fcl_stpbv {
namespace detail {

/// `v`, with 0 as the fourth number, so that sums over all four numbers are right.
inline Packed pack3(const Eigen::Vector3d& v) { return Packed{v.x(), v.y(), v.z(), 0.0}; }

/// A body of the robot or an obstacle. The world is an additional frame after those of the links.
struct PlacedBody {
  std::size_t frame;
  const fcl::CollisionGeometryd* geometry;
  Eigen::Isometry3d inFrame;
  Eigen::Vector3d centre;  ///< centre of a sphere that contains the body, in the body's frame (m)
  double radius;           ///< of that sphere (m)
  /// Radius of a ball about the same centre inside the body (m); -inf if the centre may be outside.
  double inner;
  bool finite;  ///< whether all corners are finite, if the body is a mesh
  bool convex;
  ConvexBody body;  ///< set if the body is convex; its pose is that of the last query
};

/// A pair of bodies and its separating plane.
struct KeptPair {
  std::size_t a, b;     ///< indices of the bodies
  double halfR;         ///< half the second body's R; infinite if it is no STP-BV (m)
  double rounding;      ///< rounding of the gap along a kept plane, without the rounding of the poses (m)
  long lastHit = 0;     ///< number of the last configuration in which the pair collided
  bool kept = false;    ///< whether the plane's directions are known
  bool lifted = false;  ///< whether the plane's height is known; it is computed when it is first needed
  KeptPlane plane{};
  PairCache cache;
};

}  // namespace detail

class CollisionChecker::Impl {
 public:
  Impl(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
       std::vector<CheckedPair> pairs, std::vector<Obstacle> obstacles, double margin);

  const std::vector<CheckedPair>& pairs() const { return pairs_; }
  const Kinematics& kinematics() const { return *kinematics_; }
  std::string name(int pair) const;
  double margin() const { return margin_; }
  void setMargin(double margin);
  std::optional<Hit> firstHit(const ConstVector& q);
  const std::vector<Hit>& allHits(const ConstVector& q);
  double minDistance(const ConstVector& q);
  const CheckerWork& work() const { return work_; }
  void forget();

 private:
  void addBody(std::size_t frame, const fcl::CollisionGeometryd& geometry, const Eigen::Isometry3d& pose,
               const Eigen::Vector3d& centre, double radius);
  void addPair(const CheckedPair& pair);
  bool place(const ConstVector& q);
  void placeSpheres();
  bool isClear(const detail::NearPair& near);
  bool isRecent(const detail::KeptPair& pair) const;
  double planeGap(detail::KeptPair& pair) const;
  bool searchSaysClear(detail::KeptPair& pair);
  double measured(detail::KeptPair& pair);
  void keepPlane(detail::KeptPair& pair) const;
  void lift(detail::KeptPair& pair) const;
  Hit hitOf(int pair) const { return {pair, pairs_[static_cast<std::size_t>(pair)]}; }
  const detail::ConvexBody& posed(detail::PlacedBody& placed) const {
    placed.body.pose = state_.link[placed.frame] * placed.inFrame;
    return placed.body;
  }

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  std::vector<CheckedPair> pairs_;
  std::vector<Obstacle> obstacles_;
  detail::PoseRounding rounding_;
  double margin_ = 0, slack_ = 0;  // the margin, and a bound on the rounding of both bodies' poses (m)
  Kinematics::State state_;        // with the world's frame as one more link
  std::vector<detail::PlacedBody> bodies_;
  std::vector<std::size_t> placed_;            // indices of the bodies that occur in pairs
  Kinematics::Subtree placing_;                // the links of these bodies
  std::vector<detail::SphereCentre> centres_;  // centres of the bodies' spheres
  std::vector<detail::KeptPair> checked_;
  detail::SpherePairs near_;
  std::vector<Hit> hits_;
  CheckerWork work_;
  std::size_t closest_ = 0;  // the pair of the last least distance
};

}  // namespace fcl_stpbv
