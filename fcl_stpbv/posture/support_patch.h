// A contact seen from above: the corners of its projection, moved inwards by a margin.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::detail {

/// A flat convex patch of a link, or any points of it where the margin is 0. A patch that is tilted is
/// narrower seen from above: its edges move inwards there, and how far they do along the patch depends on the
/// tilt. Which two edges make a corner is decided once, for the patch lying flat.
class SupportPatch {
 public:
  /// `margin` in m; what the points are off their plane is added to it. @throws Error where nothing is left.
  SupportPatch(const std::vector<Eigen::Vector3d>& points, double margin);

  int corners() const { return corners_; }
  /// As the patch lies flat, in the link's frame.
  std::vector<Eigen::Vector3d> flatCorners() const;
  /// Where the link is. `world` turns the axes of the link's pose and of twists into those of the world.
  void place(const Eigen::Isometry3d& link, const Eigen::Matrix3d& world);
  /// A corner seen from above, and its change as the link moves.
  Eigen::Vector2d corner(int i) const { return corner(points_[static_cast<std::size_t>(i)]); }
  Eigen::Vector2d cornerRate(int i, const Twist& twist) const {
    return cornerRate(points_[static_cast<std::size_t>(i)], twist);
  }

  /// Rows that are negative where the corners do not keep the margin: the patch is too narrow seen from above
  /// (m), or nearly upright (the last row). None without a margin.
  int rooms() const { return edges_.empty() ? 0 : static_cast<int>(edges_.size()) + 1; }
  double room(int row) const;
  double roomRate(int row, const Twist& twist) const;

 private:
  struct Point {  // where the lines of two edges meet
    Eigen::Vector3d local;
    int first, second;  // edges, -1 without a margin
    double sine;        // of the angle from one to the other
    Eigen::Vector3d carried{0, 0, 0};
  };
  struct Edge {
    Eigen::Vector3d local;  // direction, counter-clockwise about the normal
    int from, to;           // points on it
    double sign;            // -1 for an edge that the others leave out: they must meet inside of it
    Eigen::Vector3d turned{0, 0, 0};
    Eigen::Vector2d seen{0, 0};
    double length = 0;  // of `seen`
  };

  int addPoint(const std::vector<Eigen::Vector2d>& hull, int first, int second);
  Eigen::Vector2d corner(const Point& p) const;
  Eigen::Vector2d cornerRate(const Point& p, const Twist& twist) const;
  Eigen::Vector2d spread(const Point& p) const;

  double margin_ = 0;
  int corners_ = 0;
  Eigen::Vector3d centre_{0, 0, 0}, u_{0, 0, 0}, v_{0, 0, 0};  // the patch's plane
  std::vector<Point> points_;                                  // the corners first
  std::vector<Edge> edges_;
  Eigen::Matrix3d world_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d normal_{0, 0, 1};        // axes of the link's pose
  double upright_ = 1, uprightSlope_ = 0;  // of the normal: |cosine| with the vertical, and its slope
};

}  // namespace fcl_stpbv::detail
