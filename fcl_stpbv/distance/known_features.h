// The features of a shape, for a feature walk.
#pragma once

#include <array>

#include "fcl_stpbv/convex/shape_feature.h"
#include "fcl_stpbv/distance/shape_query.h"

namespace fcl_stpbv::detail {

/// The features that the walk uses, in the volume's frame. For a polytope they are those of the hull of up to
/// four of its corners, as in GJK: corners are added during the walk, and dropped if the nearest point does
/// not depend on them.
class KnownFeatures {
 public:
  /// Starts a polytope with the corner that faces the volume along the unit vector `n`, or, if it has few
  /// corners, with those along three normals around `n`.
  KnownFeatures(const ShapeQuery& q, const Eigen::Vector3d& n);

  /// The feature nearest to `x`. Of a polytope's corners only those of this feature are kept. The kind is
  /// `none` if `x` is in the hull of the corners.
  ShapeFeature near(const Packed& x) {
    if (isPolytope_) return nearestOfCorners(x);
    const Rotation& rotation = q_.pose.rotation;
    ShapeFeature f = nearestFeature(q_.shape, rotation.inverse(x - q_.pose.translation));
    f.point = q_.pose.placed(f.point);
    if (f.kind == ShapeFeature::Kind::side) f.apex = q_.pose.placed(f.apex);
    f.axis = rotation * f.axis;
    return f;
  }

  /// Adds a corner of a polytope for the next near(). False if it is known already, and for other shapes.
  bool add(const Eigen::Vector3d& corner);

 private:
  ShapeFeature nearestOfCorners(const Packed& x);

  const ShapeQuery& q_;
  bool isPolytope_, isNew_ = true;  // isNew_: corners were added or dropped since the last feature
  std::array<Eigen::Vector3d, 4> corner_;
  int count_ = 0, changes_ = 0;
};

}  // namespace fcl_stpbv::detail
