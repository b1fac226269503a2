// The exact shape of a robot's body: the triangles of its mesh, or its primitive.
#pragma once

#include <fcl/geometry/collision_geometry.h>

#include <memory>
#include <vector>

#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv::report {

/// In the body's frame, lengths in m. For a file of points without triangles, such as a published polyhedron,
/// it is their convex hull.
class ExactBody {
 public:
  /// Reads the mesh file again. @throws Error naming it.
  explicit ExactBody(const Body& body);

  /// The triangles, as FCL's BVHModel of OBBRSS, or the primitive.
  const fcl::CollisionGeometryd& shape() const { return *shape_; }
  /// The mesh's convex hull; a primitive is its own.
  const fcl::CollisionGeometryd& hull() const { return *hull_; }
  /// Null for a primitive, and for points without triangles.
  const MeshSolid* solid() const { return solid_.get(); }

  /// Whether the mesh has an inside everywhere; true without a mesh.
  bool closed() const { return !solid_ || solid_->closed(); }
  /// Volume that a closed mesh encloses (m^3): the sum over its pieces. NaN for an open mesh and without a
  /// mesh.
  double volume() const;
  /// A point of each connected piece of the mesh, or of the primitive.
  const std::vector<Eigen::Vector3d>& partPoints() const { return partPoints_; }

 private:
  std::unique_ptr<const MeshSolid> solid_;
  std::shared_ptr<const fcl::CollisionGeometryd> shape_, hull_;
  std::vector<Eigen::Vector3d> partPoints_;
};

}  // namespace fcl_stpbv::report
