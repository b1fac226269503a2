// FCL's geometry types, each with what code that shares nothing with the library takes it for: convex pieces
// by their support points in long double. Their distances say who is right where FCL and the library differ.
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
  test::ReferenceShape shape;      ///< bounded ones
  test::Vector3L centre{0, 0, 0};  ///< of a ball that holds it
  long double radius = 0;
  std::optional<test::TriangleL> triangle;  ///< where it is one
  bool unbounded = false, thin = false;     ///< a half space or a plane, by these:
  test::Vector3L normal{0, 0, 1};
  long double offset = 0;
};

struct Type {
  std::string name;
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
  bool elements;  ///< a mesh or a tree
  std::function<std::vector<Piece>(const Eigen::Isometry3d&)> pieces;
  bool unbounded() const { return name == "halfspace" || name == "plane"; }
};

constexpr int kShapes = 10;

/// First the kShapes shapes, then a mesh of each bounding volume and an octree, some 0.4 m across.
std::vector<Type> allTypes();

/// What is true about two geometries.
struct Truth {
  bool overlap = false;
  double distance = 0;                                ///< signed; of overlapping cores 0
  std::vector<std::array<std::intptr_t, 2>> meeting;  ///< elements that do
};
Truth truthOf(const std::vector<Piece>& a, const std::vector<Piece>& b, bool allMeeting = false);

/// Distance of a point (m), 0 inside.
double distanceOf(const std::vector<Piece>& pieces, const Eigen::Vector3d& point);
/// Only the piece with this number; all of them where there is none.
std::vector<Piece> only(const std::vector<Piece>& pieces, std::intptr_t id);

/// Gap between the supporting planes of two convex bodies with the normal `n` from a to b (m).
double gapAlong(const std::vector<Piece>& a, const std::vector<Piece>& b, const Eigen::Vector3d& n);
/// The widest over many normals.
double widestGap(const std::vector<Piece>& a, const std::vector<Piece>& b);

}  // namespace fcl_stpbv::parity
