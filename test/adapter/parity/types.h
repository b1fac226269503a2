// FCL's geometry types, each as convex pieces by code that shares nothing with the library: support points in
// long double. Where FCL and the library differ, the pieces' distances decide who is right.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "test/reference/shape_reference.h"
#include "test/reference/triangles.h"

namespace fcl_stpbv::parity {

/// A convex part of a geometry, in the world.
struct Piece {
  std::intptr_t id = -1;           ///< FCL's number of the triangle or cell; -1 for a whole shape
  test::ReferenceShape shape;      ///< for bounded pieces
  test::Vector3L centre{0, 0, 0};  ///< centre of a ball that contains the piece
  long double radius = 0;
  std::optional<test::TriangleL> triangle;  ///< set if the piece is a triangle
  bool unbounded = false, thin = false;     ///< whether it is a half space or a plane, given by:
  test::Vector3L normal{0, 0, 1};
  long double offset = 0;
};

struct Type {
  std::string name;
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
  bool elements;  ///< whether it is a mesh or a tree
  std::function<std::vector<Piece>(const Eigen::Isometry3d&)> pieces;
  bool unbounded() const { return name == "halfspace" || name == "plane"; }
};

constexpr int kShapes = 10;

/// First the kShapes shapes, then a mesh of each bounding volume and an octree, about 0.4 m in size.
std::vector<Type> allTypes();

/// The true answer for two geometries.
struct Truth {
  bool overlap = false;
  double distance = 0;                                ///< signed; 0 for overlapping cores
  std::vector<std::array<std::intptr_t, 2>> meeting;  ///< elements that meet
};
Truth truthOf(const std::vector<Piece>& a, const std::vector<Piece>& b, bool allMeeting = false);

/// Distance of a point from the pieces (m); 0 inside.
double distanceOf(const std::vector<Piece>& pieces, const Eigen::Vector3d& point);
/// Only the piece with this number, or all pieces if none has it.
std::vector<Piece> only(const std::vector<Piece>& pieces, std::intptr_t id);

/// Gap between the supporting planes of two convex bodies with the normal `n` from a to b (m).
double gapAlong(const std::vector<Piece>& a, const std::vector<Piece>& b, const Eigen::Vector3d& n);
/// The widest gap over many normals.
double widestGap(const std::vector<Piece>& a, const std::vector<Piece>& b);

}  // namespace fcl_stpbv::parity
