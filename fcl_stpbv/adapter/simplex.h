// The point of a small simplex nearest to the origin, and which of its corners hold it.
#pragma once

#include <Eigen/Core>
#include <array>

namespace fcl_stpbv {

/// A corner of GJK's simplex: a point of the Minkowski difference A - B and the vertices it is made of.
struct SimplexCorner {
  Eigen::Vector3d point;
  int vertexA, vertexB;
};

/// Up to four corners with the barycentric weights of the point nearest to the origin.
struct Simplex {
  std::array<SimplexCorner, 4> corner;
  std::array<double, 4> weight;
  int size = 0;

  void add(const SimplexCorner& c) { corner[static_cast<std::size_t>(size++)] = c; }
};

/// What `reduceToNearest` found.
struct NearestPoint {
  Eigen::Vector3d point;  ///< the simplex's point nearest to the origin
  bool inside;            ///< the origin is inside a tetrahedron, or on the simplex to rounding
};

/// Finds the point of `simplex` nearest to the origin and puts the corners that hold it into `reduced`, whose
/// weights are positive and sum to 1.
///
/// Each case is decided by comparing distances, never by the sign of a small determinant alone: flat and
/// needle shaped simplices are the rule near parallel faces.
NearestPoint reduceToNearest(const Simplex& simplex, Simplex& reduced);

}  // namespace fcl_stpbv
