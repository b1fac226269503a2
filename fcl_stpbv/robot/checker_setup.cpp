// Sets a CollisionChecker up: its bodies with their spheres, its pairs with their rounding, its margin.
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/checker_impl.h"

namespace fcl_stpbv {

using namespace detail;
using Eigen::Isometry3d;
using Eigen::Vector3d;

CollisionChecker::Impl::Impl(std::shared_ptr<const Kinematics> kinematics,
                             std::shared_ptr<const RobotGeometry> geometry, std::vector<CheckedPair> pairs,
                             std::vector<Obstacle> obstacles, double margin)
    : kinematics_(std::move(kinematics)),
      geometry_(std::move(geometry)),
      pairs_(std::move(pairs)),
      obstacles_(std::move(obstacles)),
      state_(kinematics_->makeState()) {
  if (pairs_.empty())
    throw Error("CollisionChecker: no pairs are given, so that nothing could be said about collisions");
  const std::size_t world = state_.link.size();
  state_.link.push_back(Isometry3d::Identity());
  for (const Body& body : geometry_->bodies)
    addBody(at(body.link), *body.geometry, body.pose, body.centre, body.radius);
  for (const Obstacle& obstacle : obstacles_)
    addBody(world, *obstacle.geometry(), obstacle.pose(), obstacle.centre(), obstacle.radius());
  for (const CheckedPair& pair : pairs_) addPair(pair);
  const PairedBodies paired = pairedBodies(pairs_, *geometry_);
  for (const int body : paired.bodies) placed_.push_back(at(body));
  for (const int obstacle : paired.obstacles) placed_.push_back(geometry_->bodies.size() + at(obstacle));
  placing_ = kinematics_->subtree(paired.links);
  std::vector<BodyReach> reaches;
  for (const std::size_t i : placed_) {
    const PlacedBody& body = bodies_[i];
    const int link = body.frame == world ? -1 : static_cast<int>(body.frame);
    reaches.push_back(reachOf(link, body.inFrame, body.centre, body.radius));
  }
  rounding_ = PoseRounding(*kinematics_, reaches);
  centres_.resize(bodies_.size());
  near_.resize(pairs_.size());
  hits_.reserve(pairs_.size());
  setMargin(margin);
}

void CollisionChecker::Impl::addBody(std::size_t frame, const fcl::CollisionGeometryd& geometry,
                                     const Isometry3d& pose, const Vector3d& centre, double radius) {
  PlacedBody placed{frame, &geometry, pose, centre, radius, -kInfinity, hasFiniteCorners(geometry),
                    false, {}};
  placed.convex = isConvex(geometry, placed.body);
  const StpBv* volume = placed.body.volume;
  if (volume && std::isfinite(radius)) {
    placed.centre = pose * volume->centre();
    placed.radius = volume->enclosingRadius();
    placed.inner = volume->innerRadius() + volume->radii().r;
  } else if (placed.convex && !placed.body.unbounded() && std::isfinite(radius)) {
    const fcl::Sphered point(0);  // a sphere's centre need not be in the body that the sphere is around
    Isometry3d where = Isometry3d::Identity();
    where.translation() = centre;
    const double away = distance(geometry, pose, point, where).upper;
    if (away <= 0) placed.inner = -away;
  }
  if (!placed.centre.allFinite() || !std::isfinite(placed.radius)) {  // a half space, or an invalid pose
    placed.centre = pose.translation();
    placed.radius = kInfinity;
  }
  bodies_.push_back(placed);
}

void CollisionChecker::Impl::addPair(const CheckedPair& pair) {
  requireBodies(pair, *geometry_, obstacles_.size(), "CollisionChecker");
  KeptPair added{};
  added.a = at(pair.body);
  added.b = at(pair.other) + (pair.obstacle ? geometry_->bodies.size() : 0);
  const PlacedBody &a = bodies_[added.a], &b = bodies_[added.b];
  added.halfR = b.body.volume ? 0.5 * b.body.volume->radii().R : kInfinity;
  added.rounding = kGapRounding * (a.radius + b.radius) + 2 * (a.body.supportError() + b.body.supportError());
  if (a.convex && b.convex) added.rounding += kGapRounding * (a.body.extent() + b.body.extent());
  // For 1 + u.w, which stands for |t|^2 / 2.
  if (b.body.volume) added.rounding += kGapRounding * b.body.volume->radii().R;
  checked_.push_back(added);
}

std::string CollisionChecker::Impl::name(int pair) const {
  if (pair == Hit().pair) return "(q is not a valid configuration)";
  if (pair < 0 || at(pair) >= pairs_.size())
    throw Error("CollisionChecker: there is no pair " + std::to_string(pair) + " of " +
                std::to_string(pairs_.size()));
  return nameOf(pairs_[at(pair)], *geometry_, obstacles_);
}

void CollisionChecker::Impl::setMargin(double margin) {
  if (std::isnan(margin)) throw Error("CollisionChecker: the margin is not a number");
  margin_ = margin;
  for (std::size_t p = 0; p < checked_.size(); ++p) {
    const KeptPair& pair = checked_[p];
    const double reach = bodies_[pair.a].radius + bodies_[pair.b].radius + margin;
    near_.set(p, pair.a, pair.b,
              reach >= 0 ? reach : kInfinity);  // for such a deep overlap the spheres prove nothing
  }
}

}  // namespace fcl_stpbv
