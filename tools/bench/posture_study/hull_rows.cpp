// Computes the rows of hulls:
// 1. Pairs whose bounding spheres are farther apart than the influence are not queried.
// 2. For the others: fcl::distance, or FCL's GJK with a stopping criterion that proves convergence.
// 3. If hulls overlap: fcl::collide's depth and normal.
// 4. The gradient is the normal times the witness points' velocities.
#include "tools/bench/posture_study/hull_rows.h"

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/posture/task.h"

namespace fcl_stpbv::tools {
namespace {

using detail::at;

// The polyhedron under a volume, as FCL's own class, so that it is not recognised as an STP-BV.
std::shared_ptr<fcl::CollisionGeometryd> hullOf(const Body& body) {
  const StpBvGeometry* smooth = asStpBv(body.geometry.get());
  if (!smooth) return body.geometry;
  const auto& convex = static_cast<const fcl::Convexd&>(*smooth);
  auto hull = std::make_shared<fcl::Convexd>(
      std::make_shared<const std::vector<Eigen::Vector3d>>(convex.getVertices()), convex.getFaceCount(),
      std::make_shared<const std::vector<int>>(convex.getFaces()));
  hull->computeLocalAABB();
  return hull;
}

}  // namespace

HullRows::HullRows(std::shared_ptr<const Kinematics> kinematics,
                   std::shared_ptr<const RobotGeometry> geometry, std::vector<CheckedPair> pairs,
                   std::vector<Obstacle> obstacles, HullDistance kind, double rounding, double influence)
    : kinematics_(std::move(kinematics)),
      geometry_(std::move(geometry)),
      pairs_(std::move(pairs)),
      obstacles_(std::move(obstacles)),
      distance_(kind),
      rounding_(rounding),
      influence_(influence) {
  for (const Body& body : geometry_->bodies) hulls_.push_back(hullOf(body));
  for (const CheckedPair& pair : pairs_) {
    const int link = geometry_->bodies[at(pair.body)].link;
    if (pair.obstacle) {
      carriers_.push_back(kinematics_->dependence(link));
      for (Kinematics::Dependence& d : carriers_.back()) d.sign = -1;
    } else {
      carriers_.push_back(kinematics_->dependence(link, geometry_->bodies[at(pair.other)].link));
    }
  }
}

std::string HullRows::name(int row) const {
  const CheckedPair& pair = pairs_[at(row)];
  return geometry_->bodies[at(pair.body)].name + " - " +
         (pair.obstacle ? obstacles_[at(pair.other)].name : geometry_->bodies[at(pair.other)].name);
}

HullRows::Answer HullRows::overlap(const fcl::CollisionGeometryd& a, const Eigen::Isometry3d& poseA,
                                   const fcl::CollisionGeometryd& b, const Eigen::Isometry3d& poseB) const {
  fcl::CollisionRequestd request(1, true);
  fcl::CollisionResultd result;
  fcl::collide(&a, poseA, &b, poseB, request, result);
  if (!result.isCollision())
    return {0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const fcl::Contactd& contact = result.getContact(0);
  return {-contact.penetration_depth, contact.normal, contact.pos, contact.pos};
}

HullRows::Answer HullRows::ask(const fcl::CollisionGeometryd& a, const Eigen::Isometry3d& poseA,
                               const fcl::CollisionGeometryd& b, const Eigen::Isometry3d& poseB) const {
  if (distance_ == HullDistance::exact) {
    const DistanceAnswer answer = distance(a, poseA, b, poseB);
    if (answer.distance > 0) return {answer.distance, answer.normal, answer.points[0], answer.points[1]};
    return overlap(a, poseA, b, poseB);
  }
  fcl::DistanceRequestd request(true);
  request.distance_tolerance = 1e-10;
  fcl::DistanceResultd result;
  const double d = fcl::distance(&a, poseA, &b, poseB, request, result);
  if (!(d > 0)) return overlap(a, poseA, b, poseB);
  const Eigen::Vector3d between = result.nearest_points[1] - result.nearest_points[0];
  return {d, between.stableNormalized(), result.nearest_points[0], result.nearest_points[1]};
}

void HullRows::evaluate(const Point& point, Eigen::Ref<Eigen::VectorXd> values,
                        Eigen::Ref<RowMatrix> jacobian) {
  for (std::size_t row = 0; row < pairs_.size(); ++row) {
    const CheckedPair& pair = pairs_[row];
    const Body& first = geometry_->bodies[at(pair.body)];
    const Eigen::Isometry3d& link = point.state.link[at(first.link)];
    const Obstacle* obstacle = pair.obstacle ? &obstacles_[at(pair.other)] : nullptr;
    const Body* second = obstacle ? nullptr : &geometry_->bodies[at(pair.other)];
    const double rounding = (obstacle ? 1 : 2) * rounding_ + kBeyondMargin;
    const Eigen::Vector3d centre =
        obstacle ? obstacle->centre() : Eigen::Vector3d(point.state.link[at(second->link)] * second->centre);
    const double reach = first.radius + (obstacle ? obstacle->radius() : second->radius);
    values[static_cast<Eigen::Index>(row)] = influence_;
    if ((centre - link * first.centre).norm() >= influence_ + reach) continue;
    ++queries_;
    const Answer answer =
        obstacle ? ask(*hulls_[at(pair.body)], link * first.pose, *obstacle->geometry(), obstacle->pose())
                 : ask(*hulls_[at(pair.body)], link * first.pose, *hulls_[at(pair.other)],
                       point.state.link[at(second->link)] * second->pose);
    if (answer.distance - rounding >= influence_) continue;
    values[static_cast<Eigen::Index>(row)] = answer.distance - rounding;
    for (const Kinematics::Dependence& d : carriers_[row]) {
      const Twist& twist = point.state.motion[at(d.motion)];
      const Eigen::Vector3d& x = d.sign < 0 ? answer.point1 : answer.point2;
      jacobian(static_cast<Eigen::Index>(row), kinematics_->motions()[at(d.motion)].coordinate) +=
          d.sign * answer.normal.dot(twist.linear + twist.angular.cross(x));
    }
  }
}

}  // namespace fcl_stpbv::tools
