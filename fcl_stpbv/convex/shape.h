// Simple convex shapes for distance queries, against an STP-BV or each other. Each is a core (box, cylinder,
// ...) plus a margin, that is, its Minkowski sum with a ball.
#pragma once

#include <Eigen/Core>
#include <array>

namespace fcl_stpbv {

namespace detail {
class VertexCap;
}

/// The kind of a simple shape.
enum class ShapeKind {
  point,      ///< a point; with a margin a ball
  segment,    ///< a segment along z; with a margin a capsule
  box,        ///< axis-aligned in its own frame
  triangle,   ///< flat, two-sided
  polytope,   ///< convex hull of the caller's vertices
  cylinder,   ///< axis z, flat ends
  cone,       ///< axis z, apex up, flat base
  ellipsoid,  ///< axes x, y, z
  halfspace,  ///< the side that `normal` points away from
  plane,      ///< thin, two-sided
};

/// A convex body in its own frame, centred in the same way as FCL's shapes. Lengths in m. One struct serves
/// all kinds, so that a query can make one on the stack. The data that its pointers refer to must outlive it.
struct Shape {
  ShapeKind kind = ShapeKind::point;  ///< the kind, which decides which of the fields below are used
  double margin = 0;                  ///< radius of the ball that is added to the core
  double radius = 0;                  ///< radius of a cylinder or of a cone's base
  double half = 0;                    ///< half length along z, of a segment, cylinder or cone
  Eigen::Vector3d size{0, 0, 0};      ///< box: half sides; ellipsoid: semi-axes
  Eigen::Vector3d normal{0, 0, 1};    ///< half space, plane: unit
  double offset = 0;                  ///< half space, plane: normal.x = offset on its surface
  std::array<Eigen::Vector3d, 3> corner{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 0),
                                        Eigen::Vector3d(0, 0, 0)};  ///< triangle
  const Eigen::Vector3d* vertices = nullptr;                        ///< polytope, at least one
  int vertexCount = 0;                                              ///< how many `vertices` points to
  detail::VertexCap* cap = nullptr;                                 ///< polytope: internal, set by a query
  Eigen::Vector3d centre{0, 0, 0};                                  ///< some point of the core
  double reach = 0;  ///< every point of the core is within this distance of `centre`

  /// A ball about the origin.
  static Shape sphere(double radius);
  /// A capsule: the ball swept along z from -length/2 to length/2.
  static Shape capsule(double radius, double length);
  /// A box about the origin; `sides` are its full side lengths.
  static Shape boxOf(const Eigen::Vector3d& sides);
  /// A triangle by its corners.
  static Shape triangleOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
  /// The convex hull of `count` points, at least one. They are not copied: the caller keeps them alive.
  /// `middle`: their mean, if it is known; this saves a second pass over all points.
  static Shape polytopeOf(const Eigen::Vector3d* vertices, int count,
                          const Eigen::Vector3d& middle = Eigen::Vector3d::Zero());
  /// A cylinder about the z axis, from -length/2 to length/2.
  static Shape cylinderOf(double radius, double length);
  /// A cone about the z axis: base at -length/2, apex at length/2.
  static Shape coneOf(double radius, double length);
  /// An ellipsoid about the origin.
  static Shape ellipsoidOf(const Eigen::Vector3d& semiAxes);
  /// All x with normal.x <= offset; `normal` is unit.
  static Shape halfspaceOf(const Eigen::Vector3d& normal, double offset);
  /// All x with normal.x = offset; `normal` is unit.
  static Shape planeOf(const Eigen::Vector3d& normal, double offset);

  /// Whether all lengths are finite and not negative, a polytope has a vertex, and a half space or plane has
  /// a unit normal.
  bool valid() const;

  /// The point of the core furthest along `d` (any length), or one of them if there are several. Only for
  /// bounded kinds.
  Eigen::Vector3d support(const Eigen::Vector3d& d) const;

  /// Whether it is a half space or a plane.
  bool unbounded() const { return kind == ShapeKind::halfspace || kind == ShapeKind::plane; }
};

}  // namespace fcl_stpbv
