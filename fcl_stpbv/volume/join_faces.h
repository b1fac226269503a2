// Joins neighbouring faces that lie on one ball to rounding into k-gons.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

/// Angle by which the normals of a face of more than three corners may be off (rad), a few thousand
/// roundings: where more is needed the face stays in triangles, which are exact. Its boundaries then part by
/// at most this times the ball's radius, and by a ten thousandth of the cloud's extent.
constexpr double kJoinTilt = 1e-12;

/// Faces of a rolled hull with those on one ball joined. Points on one ball (each face of every
/// box) give triangles with edges of no width between them where rounding has put them off it; a
/// join grows from the face with the largest triangle and takes in a neighbour whose vertices
/// all lie on that ball within touchTolerance().
std::vector<std::vector<int>> joinFaces(const std::vector<Eigen::Vector3d>& points,
                                        std::vector<std::vector<int>> faces, double radius);

}  // namespace fcl_stpbv::detail
