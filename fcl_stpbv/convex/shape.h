// The simple convex bodies that an STP-BV may meet: a flat or round core and a ball around it.
#pragma once

#include <Eigen/Core>
#include <array>

namespace fcl_stpbv {

namespace detail {
class VertexCap;
}

/// What a simple shape is.
enum class ShapeKind {
  point,      ///< a ball, by its margin
  segment,    ///< a capsule, by its margin
  box,        ///< axis-aligned in its own frame
  triangle,   ///< flat, two-sided
  polytope,   ///< convex hull of the caller's vertices
  cylinder,   ///< axis z, flat ends
  cone,       ///< axis z, apex up, flat base
  ellipsoid,  ///< axes x, y, z
  halfspace,  ///< the side that `normal` points away from
  plane,      ///< thin, two-sided
};

/// A convex body in its own frame, centred as FCL's shapes are. Lengths in m. One struct for all kinds: a
/// query makes one on its stack. What it points to must outlive it.
struct Shape {
  ShapeKind kind = ShapeKind::point;  ///< which of the fields below count
  double margin = 0;                  ///< radius of the ball around the core
  double radius = 0;                  ///< of a cylinder's or cone's rim
  double half = 0;                    ///< half length along z
  Eigen::Vector3d size{0, 0, 0};      ///< box: half sides; ellipsoid: semi-axes
  Eigen::Vector3d normal{0, 0, 1};    ///< half space, plane: unit
  double offset = 0;                  ///< half space, plane: normal.x = offset on its surface
  std::array<Eigen::Vector3d, 3> corner{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 0),
                                        Eigen::Vector3d(0, 0, 0)};  ///< triangle
  const Eigen::Vector3d* vertices = nullptr;                        ///< polytope, at least one
  int vertexCount = 0;                                              ///< how many `vertices` points to
  detail::VertexCap* cap = nullptr;                                 ///< polytope: set by a query, for itself
  Eigen::Vector3d centre{0, 0, 0};                                  ///< some point of the core
  double reach = 0;  ///< every point of the core is within this of `centre`

  /// A ball about the origin.
  static Shape sphere(double radius);
  /// A ball moved along z from -length/2 to length/2.
  static Shape capsule(double radius, double length);
  /// A box about the origin, of these whole sides.
  static Shape boxOf(const Eigen::Vector3d& sides);
  /// A triangle by its corners.
  static Shape triangleOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
  /// The convex hull of `count` points, at least one, which stay the caller's. `middle`: their mean, where it
  /// is known; that saves a second look at all of them.
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

  /// Whether all lengths are finite and none is negative, and there is a vertex
  /// and a unit normal where one is needed.
  bool valid() const;

  /// The core's point furthest along `d` (any length), one of them where
  /// there are several. Bounded kinds only.
  Eigen::Vector3d support(const Eigen::Vector3d& d) const;

  /// A half space or a plane.
  bool unbounded() const { return kind == ShapeKind::halfspace || kind == ShapeKind::plane; }
};

}  // namespace fcl_stpbv
