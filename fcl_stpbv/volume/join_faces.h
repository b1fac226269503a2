// Joins neighbouring faces that lie on one ball to rounding into k-gons.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fcl_stpbv::detail {

/// Largest error of the normals of a face with more than three corners (rad); it is a few thousand roundings.
/// A face that would need more stays a set of triangles, which are exact. So the patches at its boundaries
/// have gaps of at most this angle times the ball's radius, and at most a ten thousandth of the cloud's
/// extent.
constexpr double kJoinTilt = 1e-12;

/// Joins the faces of a hull that lie on one ball. Points on one ball, such as the corners of a box's side,
/// are off the ball by rounding. So they give several triangles, whose common edges have no width. A group
/// grows from the face with the largest triangle, and takes in each neighbour whose vertices all lie on that
/// ball within touchTolerance().
std::vector<std::vector<int>> joinFaces(const std::vector<Eigen::Vector3d>& points,
                                        std::vector<std::vector<int>> faces, double radius);

}  // namespace fcl_stpbv::detail
