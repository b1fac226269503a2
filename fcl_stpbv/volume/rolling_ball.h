// The hull of a cloud under a ball: the vertices and faces that a ball rolled over it touches (paper IV.A,
// Algorithm 1), and the convex hull, by a ball that is flat to rounding.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

/// Everything that a ball touches while it is rolled all the way round a cloud. Indices are into the cloud.
struct RolledHull {
  std::vector<int> vertices;            ///< touched points, ascending
  std::vector<std::vector<int>> faces;  ///< rings of touched points, counter-clockwise seen from outside
};

/// Hull of the cloud under a ball of finite `radius` that touches it from the inner side: the ball hull.
/// Points that lie on one ball up to rounding share one k-gon face. Points closer together than rounding
/// count as one. Two points, or collinear points, give no face.
///
/// Works on any cloud that is not empty, is finite, and has a minimum enclosing ball smaller than `radius`.
/// @throws Error if rounding errors prevent it.
RolledHull rollBall(const std::vector<Eigen::Vector3d>& points, double radius);

/// The convex hull, by quickhull (ball_quickhull.h) if that suits the cloud. A flat cloud gives two faces
/// back to back.
/// @throws Error as rollBall() does.
RolledHull convexHull(const std::vector<Eigen::Vector3d>& points);

/// convexHull(), but it makes faces even if the points are off a common line only by rounding.
/// @throws Error as rollBall() does.
RolledHull flatHull(const std::vector<Eigen::Vector3d>& points);

/// The same hull as rollBall(), but directly from the definition of faces: slow and reliable. For at most
/// kMostByDefinition points (ball_faces.h) and a finite radius. If there is no face, the result is
/// spindleOf().
RolledHull hullByDefinition(const std::vector<Eigen::Vector3d>& points, double radius);

/// The hull without faces: two points far apart, which are the ends if the points are in a spindle, or one
/// point if all are equal. The caller has to check that the points are in it.
RolledHull spindleOf(const std::vector<Eigen::Vector3d>& points);

/// The hull of rollBall() by quickhull (ball_quickhull.h), which is much faster. It has no faces if quickhull
/// does not suit the cloud. The caller has to check the result (surface_check.h).
RolledHull quickBallHull(const std::vector<Eigen::Vector3d>& points, double radius);

/// Radius of a ball so large that its bulge over the cloud is below the rounding of the coordinates.
/// flatHull() uses it in place of a plane. Unlike a plane, such a ball touches a side of a triangle only at
/// the two ends. So no vertex of the resulting convex hull lies inside a side or a flat face.
double flatRadius(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv::detail
