// An STP-BV as an FCL geometry. FCL sees a convex polyhedron, this library a smooth body.
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

/// An FCL Convex, the convex hull of an STP-BV's vertices, together with the STP-BV itself.
///
/// Any FCL code accepts it. `fcl::distance` and `fcl::collide` use the polyhedron. The broadphase uses a
/// bounding box that contains the smooth surface. `fcl_stpbv::distance` recognises the type and uses the
/// STP-BV. `user_data` is free for the caller. The STP-BV may be degenerate (a point, a segment, a flat
/// polygon). FCL's mesh then encloses no volume: FCL's distance works on it, but its mass properties are NaN.
class StpBvGeometry : public fcl::Convexd {
 public:
  /// Computes the hull, and which patch of the volume belongs to which feature of the hull. O(n log n).
  explicit StpBvGeometry(StpBv::Ptr volume);

  /// Like the constructor above, with a hull of the volume's vertices that is already known.
  StpBvGeometry(StpBv::Ptr volume, std::shared_ptr<const detail::HullGraph> hull);

  /// The smooth body.
  const StpBv& volume() const { return *volume_; }

  /// The polyhedron. Its vertex numbers are those of FCL's `getVertices()`.
  const detail::HullGraph& hull() const { return *hull_; }

  /// The patch that corresponds to a feature of the hull: the small sphere of a vertex, the torus patch of an
  /// edge, the big sphere of a face. If no patch of the volume has the same vertices, it is the patch whose
  /// region contains the normal at the middle of the feature.
  int patchOf(const detail::HullFeature& feature) const;

  /// Sets the exact axis-aligned bounding box of the smooth surface, and a sphere that contains it.
  void computeLocalAABB() override;

 private:
  void nameEdges();
  void nameFaces();

  StpBv::Ptr volume_;
  std::shared_ptr<const detail::HullGraph> hull_;
  std::vector<int> edgePatch_, facePatch_;
};

/// The geometry as a StpBvGeometry, or null if it is another type.
const StpBvGeometry* asStpBv(const fcl::CollisionGeometryd* geometry);

}  // namespace fcl_stpbv
