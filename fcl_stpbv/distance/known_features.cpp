// The features of a polytope during a walk: corners are added one by one.
#include "fcl_stpbv/distance/known_features.h"

#include <algorithm>

#include "fcl_stpbv/convex/simplex.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector3d;

namespace {

struct KnownCorner {
  Vector3d w{0, 0, 0};  // from the query point (m)
  Vector3d place{0, 0, 0};
};

}  // namespace

KnownFeatures::KnownFeatures(const ShapeQuery& q, const Vector3d& n)
    : q_(q), isPolytope_(q.shape.kind == ShapeKind::polytope) {
  if (!isPolytope_) return;
  constexpr int kFew = 24;       // corners: visiting all of them costs less than a step of the walk
  constexpr double kTilt = 0.1;  // rad
  if (q.shape.vertexCount > kFew) {
    add(q.facing(n));
    return;
  }
  const Vector3d e = n.unitOrthogonal(), f = n.cross(e);
  for (const Vector3d& tilt : {Vector3d(f), Vector3d(0.866 * e - 0.5 * f), Vector3d(-0.866 * e - 0.5 * f)})
    add(q.facing(n + kTilt * tilt));
}

bool KnownFeatures::add(const Vector3d& corner) {
  const auto end = corner_.begin() + count_;
  if (!isPolytope_ || count_ == 4 || std::find(corner_.begin(), end, corner) != end) return false;
  corner_[at(count_++)] = corner;
  return isNew_ = true;
}

ShapeFeature KnownFeatures::nearestOfCorners(const Packed& x) {
  const Vector3d from = unpack(x);
  Simplex<KnownCorner> all, nearest;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) all.add({corner_[i] - from, corner_[i]});
  const bool inside = reduceToNearest(all, nearest).inside;
  if (nearest.size != count_) isNew_ = true;
  count_ = nearest.size;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count_); ++i) corner_[i] = nearest.corner[i].place;
  changes_ += isNew_;
  isNew_ = false;

  ShapeFeature f;
  if (inside) return f;  // no proof of overlap: the tetrahedron may be flat up to rounding
  f.kind = ShapeFeature::Kind::corner;
  f.which = changes_;
  f.point = pack(nearest.weighted(&KnownCorner::place));
  if (count_ == 1) return f;
  const Vector3d side = corner_[1] - corner_[0];
  const Vector3d axis = count_ == 2 ? side : side.cross(corner_[2] - corner_[0]);
  const double length = axis.norm(), outward = count_ == 3 && axis.dot(from - corner_[0]) < 0.0 ? -1.0 : 1.0;
  f.kind = !(length > 0.0) ? ShapeFeature::Kind::none
           : count_ == 2   ? ShapeFeature::Kind::line
                           : ShapeFeature::Kind::face;
  f.axis = pack(outward / length * axis);
  return f;
}

}  // namespace fcl_stpbv::detail
