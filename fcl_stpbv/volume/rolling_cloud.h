// A point cloud during the roll: its points, its size, and which points have become vertices.
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

}  // namespace fcl_stpbv::detail
