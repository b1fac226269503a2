// The shape that a body of a robot stands for: the triangles of its mesh, or its primitive, as it is.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <memory>
#include <vector>

#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/volume/tessellate.h"

namespace fcl_stpbv::report {

/// In the body's frame, lengths in m. A file of points without triangles, as a published polyhedron, stands
/// for its convex hull.
class ExactBody {
 public:
  /// Reads the mesh file again. @throws Error naming it.
  explicit ExactBody(const Body& body);

  /// The triangles, as FCL's BVHModel of OBBRSS, or the primitive.
  const fcl::CollisionGeometryd& shape() const { return *shape_; }
  /// The mesh's convex hull; a primitive is its own.
  const fcl::CollisionGeometryd& hull() const { return *hull_; }
  /// Null for a primitive and for points without triangles.
  const TriangleMesh* mesh() const { return mesh_.triangles.empty() ? nullptr : &mesh_; }

  /// Whether each edge of the mesh has as many triangles on one side as on the other; true without a mesh.
  bool closed() const { return closed_; }
  /// Volume that a closed mesh encloses (m^3): the sum over its parts. NaN for an open one and without a
  /// mesh.
  double volume() const;

  /// Whether a point lies inside the mesh: its triangles go round it at least half a time (generalized
  /// winding number, Jacobson et al. 2013), once where the mesh is closed. False without a mesh.
  bool holds(const Eigen::Vector3d& point) const;
  /// A point of each connected part of the mesh, or of the primitive.
  const std::vector<Eigen::Vector3d>& partPoints() const { return partPoints_; }

 private:
  void connect();

  TriangleMesh mesh_;
  std::shared_ptr<const fcl::CollisionGeometryd> shape_, hull_;
  std::vector<Eigen::Vector3d> partPoints_;
  bool closed_ = true;
};

}  // namespace fcl_stpbv::report
