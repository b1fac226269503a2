// A point cloud during the roll: its points, its size, and which points have become vertices. And the two
// steps of the roll: a first face, and the ball rolling over one edge.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_faces.h"
#include "fcl_stpbv/volume/point_tree.h"

namespace fcl_stpbv::detail {

/// Diagonal of the bounding box of a cloud that is not empty (m).
double extentOf(const std::vector<Eigen::Vector3d>& points);

/// Points that are closer to a vertex than rounding are merged into it: the tree no longer contains them.
class RollingCloud {
 public:
  RollingCloud(const std::vector<Eigen::Vector3d>& points, double radius);

  const Eigen::Vector3d& at(int i) const { return points[detail::at(i)]; }
  int count() const { return static_cast<int>(points.size()); }

  /// Merges the points that are closer to i than rounding into it.
  void removeTwins(int i);

  /// Makes the ring's points vertices. False if one of them was merged into another point.
  bool claim(const Ring& ring);

  const std::vector<Eigen::Vector3d>& points;
  double radius, curvature;  ///< of the ball
  double extent;             ///< diagonal of the bounding box (m)
  PointTree tree;

 private:
  double same_;  // points closer together than this count as one (m)
  std::vector<char> isVertex_;
};

/// A first face. A cloud without a face (one point, two points, or collinear points) gives one or two points
/// instead.
struct FirstFace {
  Ring ring;
  std::vector<int> lone;
};

/// Lets the ball touch a first, a second and a third point.
/// @throws Error if it fails because of rounding from all starting directions.
FirstFace firstFace(RollingCloud& cloud);

/// Whether the ball that has the edge as its diameter contains no other point. Only a point in this ball can
/// leave the rolling ball and enter it again within half a turn, and only then can two vertices be joined by
/// two edges.
bool isLone(const RollingCloud& cloud, int a, int b);

/// The ball rests on a and b, with its normal turned towards `across`. Returns the angle by which it rolls
/// until p is outside (rad); negative if p never is.
double leavingAngle(const RollingCloud& cloud, int a, int b, const Eigen::Vector3d& across, int p);

/// Rolls the ball over the edge a -> b, away from the face on its left, and returns the face on which it
/// comes to rest. `across` is the part of the ball's normal perpendicular to the edge, of unit length.
/// `candidate` is any point on which the ball may come to rest. `lone` is isLone(a, b).
/// @throws Error if rounding errors prevent it from coming to rest.
Ring pivot(RollingCloud& cloud, int a, int b, const Eigen::Vector3d& across, int candidate, bool lone);

}  // namespace fcl_stpbv::detail
