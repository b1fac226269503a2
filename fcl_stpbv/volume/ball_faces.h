// Faces of a ball hull: rings of points on one ball that holds all others;
// ordered, and listed by their definition.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "fcl_stpbv/volume/ball_side.h"

namespace fcl_stpbv::detail {

/// Indices of a face's vertices in a cloud, counter-clockwise seen from outside.
using Ring = std::vector<int>;

/// Height up to which a point counts as touching a face's ball (m): a few
/// roundings of the cloud's coordinates.
double touchTolerance(const std::vector<Eigen::Vector3d>& points);

/// Three vertices of a ring that make a large triangle, so that they fix the face's ball well.
std::array<int, 3> wideTriangle(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& ring);

/// Orders points that `ball` touches into the boundary of their spherical hull.
/// `from` -> `to` is one of its sides.
Ring ringOf(const std::vector<Eigen::Vector3d>& points, const TouchingBall& ball, int from, int to,
            std::vector<int> touched);

/// Most points for facesByDefinition(), whose time grows with the number of triples: well below a second.
constexpr std::size_t kMostByDefinition = 128;

/// All faces of the ball hull by their definition: three points whose ball holds all others.
/// Sides are decided exactly, so the faces close whatever the cloud. Points within
/// touchTolerance() of an earlier one are left out.
std::vector<Ring> facesByDefinition(const std::vector<Eigen::Vector3d>& points, double radius);

}  // namespace fcl_stpbv::detail
