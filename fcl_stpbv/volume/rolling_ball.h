// Rolls a ball over a cloud and names the vertices and faces it touches (paper IV.A, Algorithm 1).
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <vector>

namespace fcl_stpbv::detail {

/// What a ball rolled all the way round a cloud has touched. Indices are into the cloud.
struct RolledHull {
  std::vector<int> vertices;            ///< touched points, ascending
  std::vector<std::vector<int>> faces;  ///< rings of touched points, counter-clockwise seen from outside
};

/// Hull of the cloud under a ball of `radius` that touches it from the inner side: the ball hull, or for the
/// infinite radius the convex hull. Points of one ball to rounding share one k-gon face, points closer
/// together than rounding count as one. A flat cloud gives two faces back to back; two points, or collinear
/// ones, no face.
///
/// Works on any cloud that is not empty, finite, and has a minimum enclosing ball smaller than `radius`.
/// @throws Error where rounding defeats it.
RolledHull rollBall(const std::vector<Eigen::Vector3d>& points,
                    double radius = std::numeric_limits<double>::infinity());

/// Radius of a ball that bulges over the cloud by less than its coordinates' rounding: what rollBall() rolls
/// in place of a plane. Unlike a plane it has no point on a side of one of its triangles but the two ends, so
/// no vertex of the convex hull lies inside a side or a flat face.
double flatRadius(const std::vector<Eigen::Vector3d>& points);

/// The half-edges of a closed surface of rings: which one lies on the other side of each.
struct HalfEdge {
  int face, corner;  ///< runs from ring[corner] to the next vertex of faces[face]
  int twin = -1;     ///< index of the half-edge on the other side
  double turn = 0;   ///< angle by which the ball rolls from this face to the twin's, [0, 2 pi)
};

/// Half-edges of `faces` in order, paired with their twins. Two vertices may be joined by several edges; the
/// ball rolls from each half-edge to the nearest twin ahead. `normals[f]` is the unit outward normal at the
/// face's first vertex.
/// @throws Error where the faces do not form a closed surface.
std::vector<HalfEdge> pairHalfEdges(const std::vector<Eigen::Vector3d>& points,
                                    const std::vector<std::vector<int>>& faces,
                                    const std::vector<Eigen::Vector3d>& normals, double radius);

/// Three vertices of a ring that make a large triangle, so that they fix the face's ball well.
std::array<int, 3> wideTriangle(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& ring);

/// Angle by which the normals of a face of more than three corners may be off (rad), a few thousand
/// roundings: where more is needed the face stays in triangles, which are exact. Its boundaries then part by
/// at most this times the ball's radius.
constexpr double kJoinTilt = 1e-12;

/// Height up to which a point counts as touching a face's ball (m): a few roundings of the cloud's
/// coordinates.
double touchTolerance(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv::detail
