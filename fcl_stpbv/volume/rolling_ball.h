// The hull of a cloud under a ball: the vertices and faces that a ball rolled over it touches (paper IV.A,
// Algorithm 1), and the convex hull, by a ball that is flat to rounding.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

/// What a ball rolled all the way round a cloud has touched. Indices are into the cloud.
struct RolledHull {
  std::vector<int> vertices;            ///< touched points, ascending
  std::vector<std::vector<int>> faces;  ///< rings of touched points, counter-clockwise seen from outside
};

/// Hull of the cloud under a ball of finite `radius` that touches it from the inner side: the ball hull.
/// Points of one ball to rounding share one k-gon face, points closer together than rounding count as one.
/// Two points, or collinear ones, give no face.
///
/// Works on any cloud that is not empty, finite, and has a minimum enclosing ball smaller than `radius`.
/// @throws Error where rounding defeats it.
RolledHull rollBall(const std::vector<Eigen::Vector3d>& points, double radius);

/// The convex hull, by quickhull (ball_quickhull.h) where that suits the cloud. A flat cloud gives two faces
/// back to back.
/// @throws Error likewise.
RolledHull convexHull(const std::vector<Eigen::Vector3d>& points);

/// The same, but with faces also where rounding alone keeps the points off one line.
/// @throws Error likewise.
RolledHull flatHull(const std::vector<Eigen::Vector3d>& points);

/// What rollBall() finds, by the definition of its faces, slow and sure: for at most kMostByDefinition points
/// (ball_faces.h) and a finite radius. Empty for a sphere or a spindle, which
/// have no face.
RolledHull hullByDefinition(const std::vector<Eigen::Vector3d>& points, double radius);

/// The same by quickhull (ball_quickhull.h), much faster; without faces where that does not suit the
/// cloud. The caller has to check what comes back (surface_check.h).
RolledHull quickBallHull(const std::vector<Eigen::Vector3d>& points, double radius);

/// Radius of a ball that bulges over the cloud by less than its coordinates' rounding: what flatHull() takes
/// in place of a plane. Unlike a plane it has no point on a side of one of its triangles but the two ends, so
/// no vertex of the convex hull lies inside a side or a flat face.
double flatRadius(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv::detail
