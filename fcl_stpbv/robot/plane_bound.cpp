// The gap between two bodies over a box of joint values (docs/proofs.md). It tries planes fixed to the links
// for which the bound at the nearest points is best. It starts with the normal of the distance at the middle,
// and turns it as GJK does, towards the shortest difference of points that the bodies can reach. push_bound.h
// bounds how far the joints move a body towards the plane.
#include "fcl_stpbv/robot/plane_bound.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// Number of links that the plane is tried on, and of steps that improve its normal.
constexpr std::size_t kReferences = 2;
constexpr int kPlaneSteps = 4;

// Number of links of a longer chain for which the loss is bounded: those that lose least in first order.
constexpr std::size_t kRanked = 25;

// How a joint moves the point x per unit of its value.
Vector3d motion(const BoxJoint& joint, const Vector3d& x) {
  return joint.slides ? joint.axis : Vector3d(joint.axis.cross(x - joint.origin));
}

// The point farthest along n to which the joints bring the body, in first order.
Vector3d farthest(const Vector3d& n, const BodySide& side) {
  double best = -kInfinity;
  Vector3d point = Vector3d::Zero();
  for (const Vector3d& x : side.body->points) {
    double reached = n.dot(x);
    for (const OutwardJoint& o : side.joints) reached += o.joint.half * std::abs(n.dot(motion(o.joint, x)));
    if (reached <= best) continue;
    best = reached;
    point = x;
  }
  const Vector3d x = point;
  for (const OutwardJoint& o : side.joints) {
    const Vector3d along = motion(o.joint, x);
    point += (o.joint.slides ? o.joint.half : o.sine) * (n.dot(along) > 0 ? along : Vector3d(-along));
  }
  return point + side.body->radius * n;
}

}  // namespace

void PlaneBound::set(const std::vector<BoxJoint>& joints, const BodyPoints& first, const BodyPoints& second) {
  joints_.clear();
  bool shared = false;
  for (const BoxJoint& joint : joints) {
    for (const OutwardJoint& other : joints_) shared |= other.joint.slot == joint.slot;
    const double half = std::min(joint.half, kPi);
    joints_.push_back(
        {joint, std::sin(std::min(half, kPi / 2)), 1 - std::cos(half), 2 * std::sin(half / 2), 0});
  }
  push_.setShared(shared);
  first_.body = &first;
  second_.body = &second;
}

// Seen from the plane's link, the joints before it lead to the first body, the others to the second.
void PlaneBound::fixTo(std::size_t reference) {
  first_.joints.assign(joints_.rend() - static_cast<std::ptrdiff_t>(reference), joints_.rend());
  second_.joints.assign(joints_.begin() + static_cast<std::ptrdiff_t>(reference), joints_.end());
  for (OutwardJoint& o : first_.joints) o.outwardRate = o.joint.up ? o.joint.rate : -o.joint.rate;
  for (OutwardJoint& o : second_.joints) o.outwardRate = o.joint.up ? -o.joint.rate : o.joint.rate;
}

double PlaneBound::gapAlong(const Vector3d& n, std::size_t reference, Eigen::VectorXd& shares) {
  fixTo(reference);
  shares.setZero();
  return -push_.support(-n, second_, shares) - push_.support(n, first_, shares);
}

// Ranks the links to which the plane can be fixed, by the bound at the nearest points only.
void PlaneBound::rank(const Vector3d& n, const std::array<Vector3d, 2>& nearest) {
  const auto firstOrder = [&](const OutwardJoint& o, const Vector3d& x) {
    return (o.joint.slides ? o.joint.half : o.sine) * std::abs(n.dot(motion(o.joint, x)));
  };
  const auto keepLeast = [&](std::size_t most) {
    std::sort(order_.begin(), order_.end());
    order_.resize(std::min(order_.size(), most));
  };
  double loss = 0;
  for (const OutwardJoint& o : joints_) loss += firstOrder(o, nearest[1]);
  order_.assign(1, {loss, 0});
  for (const OutwardJoint& o : joints_) {
    loss += firstOrder(o, nearest[0]) - firstOrder(o, nearest[1]);
    order_.emplace_back(loss, order_.size());
  }
  keepLeast(kRanked);
  // No push is below 0: a side that alone loses more than the best links on both sides settles its link.
  std::array<double, kReferences> least;  // losses, ascending
  least.fill(kInfinity);
  for (auto& [known, reference] : order_) {
    fixTo(reference);
    push_.prepare(n, first_);
    known = push_.push(n, first_, nearest[0]);
    if (known > least.back()) continue;
    push_.prepare(-n, second_);
    known += push_.push(-n, second_, nearest[1]);
    if (known >= least.back()) continue;
    least.back() = known;
    std::sort(least.begin(), least.end());
  }
  keepLeast(kReferences);
}

double PlaneBound::gap(const Vector3d& normal, const std::array<Vector3d, 2>& nearest, double enough,
                       Eigen::VectorXd& shares) {
  trial_.resize(shares.size());
  double best = -kInfinity;
  const auto tryOut = [&](const Vector3d& n, std::size_t reference) {
    const double found = gapAlong(n, reference, trial_);
    if (found <= best) return;
    best = found;
    shares = trial_;
  };
  rank(normal, nearest);
  for (const auto& [unused, reference] : order_) {
    tryOut(normal, reference);
    // Turn the normal towards the shortest difference of two points to which the bodies are brought, as GJK
    // does.
    Vector3d shortest = normal * std::max(1e-6, normal.dot(nearest[1] - nearest[0]));
    for (int step = 0; step < kPlaneSteps && best <= enough; ++step) {
      const Vector3d n = shortest.normalized();
      const Vector3d corner = farthest(-n, second_) - farthest(n, first_);
      if (step == 0 && n.dot(corner) > 0) shortest = n.dot(corner) * n;
      const Vector3d edge = corner - shortest;
      const double part = std::clamp(-shortest.dot(edge) / edge.squaredNorm(), 0.0, 1.0);
      if (!(part > 0)) break;
      shortest += part * edge;
      if (!(shortest.norm() > 0)) break;
      if (step % 2 == 1) tryOut(shortest.normalized(), reference);
    }
    if (best > enough) break;
  }
  return best;
}

}  // namespace fcl_stpbv::detail
