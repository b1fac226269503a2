// A lower bound on the gap of two bodies over a box of joint values: a plane fixed to one link between them,
// and how far the joints on either side of that link can push the bodies towards it (docs/proofs.md).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "fcl_stpbv/robot/body_points.h"

namespace fcl_stpbv::detail {

/// A joint on the way from the first body to the second, as it is at the middle of the box.
struct BoxJoint {
  bool slides = false;              ///< else it turns
  bool up = false;                  ///< the first body is on the child's side
  int slot = 0;                     ///< which of the box's coordinates moves it
  double rate = 1;                  ///< its motion per unit of that coordinate, 1 but for mimic joints
  double half = 0;                  ///< most that it moves from the middle (rad or m)
  Eigen::Vector3d axis{0, 0, 1};    ///< unit, world
  Eigen::Vector3d origin{0, 0, 0};  ///< a point of the axis
};

/// One box at a time. Allocates nothing once it has seen its largest bodies and longest way.
class PlaneBound {
 public:
  /// The joints in order, and the bodies in the world at the middle of the box; these are kept by reference.
  void set(const std::vector<BoxJoint>& joints, const BodyPoints& first, const BodyPoints& second);

  /// Lower bound on the gap (m) wherever the joints are in the box. Starts from the unit normal from the
  /// first body to the second and their nearest points at the middle, improves it, and stops at the first
  /// bound above `enough`. `shares`, of the size of the box, gets what each coordinate takes from the gap.
  double gap(const Eigen::Vector3d& normal, const std::array<Eigen::Vector3d, 2>& nearest, double enough,
             Eigen::VectorXd& shares);

  /// The bound for one plane: fixed to the link after the first `reference` joints, of unit normal n in the
  /// middle.
  double gapAlong(const Eigen::Vector3d& n, std::size_t reference, Eigen::VectorXd& shares);

 private:
  struct Outward {  // a joint with what half its range makes of it: sin, 1 - cos, 2 sin(half / 2)
    BoxJoint joint;
    double sine, bulge, chord;
    double outwardRate;
  };
  struct Side {  // a body and the joints from the plane's link out to it
    std::vector<Outward> joints;
    const BodyPoints* body;
  };

  void fixTo(std::size_t reference);
  void prepare(const Eigen::Vector3d& n, const Side& side);
  double mostPush(const Side& side) const;
  double mostTurned(const Side& side) const;
  std::size_t foremost(const Eigen::Vector3d& n, const Side& side) const;
  double push(const Eigen::Vector3d& n, const Side& side, const Eigen::Vector3d& x);
  double along(const Side& side, std::size_t l, const Eigen::Vector3d& turned, double size,
               const Eigen::Vector3d& x) const;
  double couple(const Side& side, std::size_t i, std::size_t l, const Eigen::Vector3d& x);
  double mostAtCorners(std::size_t i, std::size_t m, int tries);
  double together(const Eigen::Vector3d& n, const Side& side, const Eigen::Vector3d& x) const;
  double support(const Eigen::Vector3d& n, const Side& side, Eigen::VectorXd& shares);
  Eigen::Vector3d farthest(const Eigen::Vector3d& n, const Side& side) const;
  void rank(const Eigen::Vector3d& n, const std::array<Eigen::Vector3d, 2>& nearest);

  std::vector<Outward> joints_;
  bool shared_ = false;  // whether a coordinate moves several joints
  Side first_, second_;
  // Of the side at hand, for the normal n: n x axis of each joint, that crossed with the axis of each joint
  // further out, and again; n across each axis, and that crossed with the axes further out; their lengths;
  // the way from the outermost turning joint back to each one.
  std::vector<Eigen::Vector3d> turned_, coupled_, tripled_, flat_, bulged_;
  std::vector<double> tilt_, coupling_, tripling_, bulging_, way_;
  // Of a point: its distance from each axis, the same once the joints further out have moved, how far those
  // move it, and what each joint pushes.
  std::vector<double> lever_, reach_, moved_, share_, bestShare_;
  // What it is pushed in first order by each joint, and in second order by each two (mostAtCorners()).
  std::vector<double> slope_, product_;
  std::vector<std::pair<double, std::size_t>> order_;
  Eigen::VectorXd trial_;
};

}  // namespace fcl_stpbv::detail
