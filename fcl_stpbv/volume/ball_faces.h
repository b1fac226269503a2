// Faces of a ball hull. A face is a ring of points on a ball that contains all other points. Functions to
// order a ring, and to list all faces directly from this definition. And the polygon around points in one
// plane.
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

/// Largest number of points for facesByDefinition(). Its time grows with the number of triples of points; for
/// this number it is well below a second.
constexpr std::size_t kMostByDefinition = 128;

/// All faces of the ball hull, directly from the definition: three points whose ball contains all others. The
/// sides of points are decided exactly, so the faces form a closed surface for any cloud. Points within
/// touchTolerance() of an earlier point are left out.
std::vector<Ring> facesByDefinition(const std::vector<Eigen::Vector3d>& points, double radius);

/// Corners of the convex polygon around the points, in order round it, as indices into the cloud. Every point
/// lies on the polygon or inside, to touchTolerance(). Empty if the points are not in one plane to this
/// tolerance, or if they lie on one line.
Ring flatOutline(const std::vector<Eigen::Vector3d>& points);

}  // namespace fcl_stpbv::detail
