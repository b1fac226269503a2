// The projection of a contact along z: its corners, moved inwards by a margin.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::detail {

/// A flat convex patch of a link, or any points of it if the margin is 0. The margin is measured in the
/// projection, in which a tilted patch is narrower. So the distance by which edges move along the patch
/// depends on the tilt. Which edges remain depends on it too: when an edge has no length any more, its two
/// neighbours meet.
class SupportPatch {
 public:
  /// `margin` in m; the distance of the points from their plane is added to it. @throws Error if nothing is
  /// left of the patch.
  SupportPatch(const std::vector<Eigen::Vector3d>& points, double margin);

  /// Number of corners, the same for any tilt; corners coincide if the edge between them has no length.
  int corners() const { return static_cast<int>(points_.size()); }
  /// The distinct corners for the untilted patch, in the link's frame (m).
  std::vector<Eigen::Vector3d> flatCorners() const;
  /// Sets the pose of the link. `world` rotates the axes of the link's pose and of twists into the world's
  /// axes.
  void place(const Eigen::Isometry3d& link, const Eigen::Matrix3d& world);
  /// A corner in the projection (m), and its velocity while the link moves.
  Eigen::Vector2d corner(int i) const;
  Eigen::Vector2d cornerRate(int i, const Twist& twist) const;

  /// Number of inequality constraints that keep the corners valid; none if the margin is 0. The first is
  /// negative if the radius of the largest circle in the projected patch is below the margin (m), the second
  /// if the patch is nearly upright.
  int rooms() const { return edges_.empty() ? 0 : 2; }
  double room(int row) const;
  double roomRate(int row, const Twist& twist) const;

 private:
  struct Point {  // where the lines of two edges meet
    Eigen::Vector3d local;
    int first = -1, second = -1;  // the two edges, -1 without a margin
    double sine = 0;              // of the angle from the first edge to the second
    Eigen::Vector3d carried{0, 0, 0};
  };
  struct Edge {
    Eigen::Vector2d from, along;  // in the patch's plane; the edges run counter-clockwise about the normal
    Eigen::Vector3d local;        // `along` in the link's frame
    Eigen::Vector3d turned{0, 0, 0};
    Eigen::Vector2d seen{0, 0};
    double length = 1;  // length of `seen`
  };
  struct Meeting {  // where the lines of two edges meet, and how that point moves per m of margin
    Eigen::Vector2d at, way;
    double sine;
  };

  Meeting meeting(int first, int second) const;
  void choose();
  Eigen::Vector2d spread(const Point& p) const;

  double margin_ = 0;
  Eigen::Vector3d centre_{0, 0, 0}, u_{0, 0, 0}, v_{0, 0, 0};  // the patch's plane
  std::vector<Point> points_;                                  // the corner after each edge
  std::vector<Edge> edges_;
  Eigen::Matrix3d world_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d normal_{0, 0, 1};  // the patch's normal, in the axes of the link's pose
  // |cosine| of the normal with the vertical, and its derivative by the cosine.
  double upright_ = 1, uprightSlope_ = 0;
  double radius_ = 0;             // radius of the largest circle in the patch, seen from above
  std::array<int, 3> around_{};   // the edges that this circle touches
  std::array<double, 3> pull_{};  // normals of these edges with these lengths add up to 0
};

}  // namespace fcl_stpbv::detail
