#include "fcl_stpbv/adapter/proximity.h"

#include "fcl_stpbv/distance/shape_distance.h"

namespace fcl_stpbv {

namespace {

/// The gap along the remembered normal, a lower bound like that along any other (docs/theory.md, 5).
bool rememberedPlaneTells(double x, const StpBvGeometry& a, const fcl::Transform3d& pose1,
                          const StpBvGeometry& b, const fcl::Transform3d& pose2, const PairCache& cache) {
  const double length = cache.normal.norm();
  if (!(length > 0.5 && length < 2.0)) return false;
  const Eigen::Vector3d n = cache.normal / length;
  const double a1 = a.volume().support(pose1.linear().transpose() * n);
  const double b1 = b.volume().support(-(pose2.linear().transpose() * n));
  return n.dot(pose2.translation() - pose1.translation()) - a1 - b1 > x;
}

}  // namespace

bool isFartherThan(double x, const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                   const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2,
                   const QueryContext& context) {
  const StpBvGeometry *a = asStpBv(&geometry1), *b = asStpBv(&geometry2);
  if (a && b) {
    const Eigen::Vector3d d = pose2 * b->volume().centre() - pose1 * a->volume().centre();
    if (d.norm() - a->volume().enclosingRadius() - b->volume().enclosingRadius() > x) return true;
    if (context.cache && rememberedPlaneTells(x, *a, pose1, *b, pose2, *context.cache)) return true;
  }
  const DistanceAnswer answer = distance(geometry1, pose1, geometry2, pose2, context);
  return answer.status != DistanceStatus::invalid && answer.lower > x;
}

Distance distance(const StpBvGeometry& geometry, const fcl::Transform3d& pose, const Eigen::Vector3d& point,
                  PairCache* cache) {
  return distance(geometry.volume(), pose, point, cache);
}

}  // namespace fcl_stpbv
