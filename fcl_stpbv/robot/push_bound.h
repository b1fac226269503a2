// Bounds how far joints can move a body along a direction, for all joint values in a box (docs/proofs.md).
// This movement is called push.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "fcl_stpbv/robot/body_points.h"

namespace fcl_stpbv::detail {

/// A joint on the way from the first body to the second, as it is at the middle of the box.
struct BoxJoint {
  bool slides = false;              ///< whether it slides; otherwise it turns
  bool up = false;                  ///< whether the first body is on the child's side
  int slot = 0;                     ///< index of the box's coordinate that moves it
  double rate = 1;                  ///< its motion per unit of that coordinate: not 0, and 1 unless it mimics
  double half = 0;                  ///< largest motion from the middle (rad or m)
  Eigen::Vector3d axis{0, 0, 1};    ///< unit vector (world)
  Eigen::Vector3d origin{0, 0, 0};  ///< a point on the axis
};

/// A joint, and functions of half its range: sin, 1 - cos, 2 sin(half / 2).
struct OutwardJoint {
  BoxJoint joint;
  double sine, bulge, chord;
  double outwardRate;
};

/// A body and the joints from the plane's link out to it.
struct BodySide {
  std::vector<OutwardJoint> joints;
  const BodyPoints* body;
};

/// Handles one direction and one body at a time. Allocates nothing once it has seen its largest body and its
/// longest chain.
class PushBound {
 public:
  /// Whether one coordinate moves several of the joints.
  void setShared(bool shared) { shared_ = shared; }

  /// Sets the unit direction n, as it is at the plane's link, for the next calls of push().
  void prepare(const Eigen::Vector3d& n, const BodySide& side);

  /// Upper bound on how far the joints push the point x along n (m).
  double push(const Eigen::Vector3d& n, const BodySide& side, const Eigen::Vector3d& x);

  /// Upper bound on the support function of the body along n (m). Adds to `shares`, by coordinate, the push
  /// of each joint on the point that determines the bound.
  double support(const Eigen::Vector3d& n, const BodySide& side, Eigen::VectorXd& shares);

 private:
  double along(const BodySide& side, std::size_t l, const Eigen::Vector3d& turned, double size,
               const Eigen::Vector3d& x) const;
  double couple(const BodySide& side, std::size_t i, std::size_t l, const Eigen::Vector3d& x);
  double mostAtCorners(std::size_t i, std::size_t m, int tries);
  double together(const Eigen::Vector3d& n, const BodySide& side, const Eigen::Vector3d& x) const;
  double mostPush(const BodySide& side) const;
  double mostTurned(const BodySide& side) const;
  std::size_t foremost(const Eigen::Vector3d& n, const BodySide& side) const;

  bool shared_ = false;
  // For the present side and the normal n: n x axis for each joint; its cross products with the axes of
  // joints further out; the cross products of these with axes further out. Then n's part across each axis,
  // and its cross products with the axes further out. Then the lengths of these vectors, and the way from the
  // outermost turning joint back to each joint.
  std::vector<Eigen::Vector3d> turned_, coupled_, tripled_, flat_, bulged_;
  std::vector<double> tilt_, coupling_, tripling_, bulging_, way_;
  // For a point: its distance from each axis; the same after the joints further out have moved; how far those
  // move the point; and each joint's push.
  std::vector<double> lever_, reach_, moved_, share_, bestShare_;
  // For a point: the push in first order of each joint, and in second order of each two joints
  // (mostAtCorners()).
  std::vector<double> slope_, product_;
};

}  // namespace fcl_stpbv::detail
