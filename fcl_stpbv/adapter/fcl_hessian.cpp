// Second derivatives for FCL geometries: finds the body of an answer (a simple shape, or one element of a
// mesh or octree), and calls distance/hessian.h for it.
#include "fcl_stpbv/adapter/fcl_hessian.h"

#include <array>
#include <optional>

#include "fcl_stpbv/adapter/element_tree.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

/// The body that an answer is about, in the frame of its geometry: a simple shape, or an element of a mesh or
/// a tree.
class OtherBody {
 public:
  /// `point`: the answer's witness point on this body (world, m).
  OtherBody(const fcl::CollisionGeometryd& geometry, fcl::Transform3d pose, std::intptr_t element,
            const Vector3d& point) {
    Vector3d place;
    known_ = shapeOf(geometry, shape_);
    if (known_ || !makeRigid(pose)) return;
    const Vector3d x = pose.linear().transpose() * (point - pose.translation());
    // This tolerance is larger than rounding. That does no harm, because each cell has its own id: no other
    // cell is found.
    const double off = placeRounding(pose, x) + 1e-12 * point.lpNorm<1>();
    if (!ElementTree(geometry, /*known=*/true).find(element, x, off, shape_, place)) return;
    known_ = true;
    if (shape_.kind != ShapeKind::box) return;
    // A cell is away from its tree's origin. Its corners take its place, so that the shape rotates about the
    // same point as the tree.
    for (int i = 0; i < 8; ++i)
      corner_[at(i)] =
          place + Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1).cwiseProduct(shape_.size);
    shape_ = Shape::polytopeOf(corner_.data(), 8);
  }
  OtherBody(const OtherBody&) = delete;
  OtherBody& operator=(const OtherBody&) = delete;

  bool known() const { return known_; }
  const Shape& shape() const { return shape_; }

 private:
  bool known_ = false;
  Shape shape_;
  std::array<Vector3d, 8> corner_;
};

/// Calls `ask` with both bodies as types of the core library, in their order. False if a body has no such
/// type.
template <class Ask>
bool askBoth(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
             const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2, const DistanceAnswer& d,
             const Ask& ask) {
  if (d.status == DistanceStatus::invalid || d.normal.isZero(0)) return false;
  const StpBvGeometry* a = asStpBv(&geometry1);
  const StpBvGeometry* b = asStpBv(&geometry2);
  const Distance found = inCoreTerms(d);
  if (a && b) return ask(a->volume(), b->volume(), found);
  std::optional<OtherBody> first, second;
  if (!a) first.emplace(geometry1, pose1, d.element[0], d.points[0]);
  if (!b) second.emplace(geometry2, pose2, d.element[1], d.points[1]);
  if ((first && !first->known()) || (second && !second->known())) return false;
  if (a) return ask(a->volume(), second->shape(), found);
  return b ? ask(first->shape(), b->volume(), found) : ask(first->shape(), second->shape(), found);
}

}  // namespace

bool hessian(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
             const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2, const DistanceAnswer& d,
             DistanceHessian& result) {
  return askBoth(geometry1, pose1, geometry2, pose2, d,
                 [&](const auto& a, const auto& b, const Distance& found) {
                   return hessian(a, pose1, b, pose2, found, result);
                 });
}

bool rate(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
          const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2, const DistanceAnswer& d,
          const BodyTwists& twists, DistanceRate& result) {
  return askBoth(geometry1, pose1, geometry2, pose2, d,
                 [&](const auto& a, const auto& b, const Distance& found) {
                   return rate(a, pose1, b, pose2, found, twists, result);
                 });
}

bool hessian(const fcl::CollisionObjectd& object1, const fcl::CollisionObjectd& object2,
             const DistanceAnswer& d, DistanceHessian& result) {
  return hessian(*object1.collisionGeometry(), object1.getTransform(), *object2.collisionGeometry(),
                 object2.getTransform(), d, result);
}

bool rate(const fcl::CollisionObjectd& object1, const fcl::CollisionObjectd& object2, const DistanceAnswer& d,
          const BodyTwists& twists, DistanceRate& result) {
  return rate(*object1.collisionGeometry(), object1.getTransform(), *object2.collisionGeometry(),
              object2.getTransform(), d, twists, result);
}

}  // namespace fcl_stpbv
