// An STP-BV as an FCL geometry: a convex polyhedron to FCL, a smooth body to this library.
#pragma once

#include <fcl/geometry/shape/convex.h>

#include <memory>
#include <vector>

#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv {

namespace detail {
class HullGraph;
struct HullFeature;
}  // namespace detail

/// The convex hull of an STP-BV's vertices, as FCL knows it, together with the volume itself.
///
/// Any FCL code takes it: plain `fcl::distance` and `fcl::collide` see the polyhedron, broadphase sees a
/// bounding box that holds the smooth surface, and `fcl_stpbv::distance` finds the volume again by its type.
/// `user_data` stays the caller's. The volume may be degenerate (a point, a segment, a flat polygon): FCL
/// then holds a mesh without volume, on which its distance works and its mass properties are NaN.
class StpBvGeometry : public fcl::Convexd {
 public:
  /// Takes the hull and the correspondence of its features to the volume's patches. O(n log n).
  explicit StpBvGeometry(StpBv::Ptr volume);

  /// The same where the hull of the volume's vertices is known.
  StpBvGeometry(StpBv::Ptr volume, std::shared_ptr<const detail::HullGraph> hull);

  /// The smooth body.
  const StpBv& volume() const { return *volume_; }

  /// The polyhedron, with vertex `v` of FCL's `getVertices()` as its vertex `v`.
  const detail::HullGraph& hull() const { return *hull_; }

  /// The patch of the same name as a feature of the hull: the small sphere of a vertex, the torus part of an
  /// edge, the big sphere of a face. Where the volume has none of that name, the patch that owns the normal
  /// in the feature's middle.
  int patchOf(const detail::HullFeature& feature) const;

  /// Exact bounds of the smooth surface along the frame's axes, and a sphere that holds it.
  void computeLocalAABB() override;

 private:
  void nameEdges();
  void nameFaces();

  StpBv::Ptr volume_;
  std::shared_ptr<const detail::HullGraph> hull_;
  std::vector<int> edgePatch_, facePatch_;
};

/// The STP-BV behind an FCL geometry; null for any other one.
const StpBvGeometry* asStpBv(const fcl::CollisionGeometryd* geometry);

}  // namespace fcl_stpbv
