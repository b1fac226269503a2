// Upper bound on how fast a row's gradient may change (docs/control.md), from each body's least and largest
// radius of curvature, the distance and the velocities.
#include <algorithm>
#include <array>
#include <cmath>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/twist.h"

namespace fcl_stpbv {
namespace {

using detail::at;
using detail::kInfinity;
using detail::velocityOf;
using Eigen::Vector3d;

double across(const Vector3d& v, const Vector3d& n) { return (v - n.dot(v) * n).norm(); }

/// Least and largest radius of curvature of a body's surface.
struct Roundness {
  double least, most;
};

/// For a polyhedron they are 0 and infinite. Its normal cannot turn at all or turns freely along a direction,
/// so it does not enter `skew`.
bool roundnessOf(const fcl::CollisionGeometryd& geometry, Roundness& result) {
  if (const StpBvGeometry* smooth = asStpBv(&geometry)) {
    result = {smooth->volume().radii().r, smooth->volume().radii().R};
    return true;
  }
  result = {0, kInfinity};
  const fcl::NODE_TYPE type = geometry.getNodeType();
  return type == fcl::GEOM_BOX || type == fcl::GEOM_CONVEX || type == fcl::GEOM_TRIANGLE ||
         type == fcl::GEOM_HALFSPACE;
}

/// S = W_A + W_B + d, of both bodies' radii of curvature W and their distance d (m).
struct RadiiSum {
  double least;  ///< its least eigenvalue
  double deep;   ///< depth of the overlap
  double skew;   ///< bound on |S^-1 W|
};

/// False if nothing bounds how fast the normal and the points move.
bool sumOf(double distance, const std::array<Roundness, 2>& round, RadiiSum& sum) {
  sum.least = distance + round[0].least + round[1].least;
  sum.deep = std::max(0.0, -distance);
  if (!(sum.least > 0) || sum.deep > std::max(round[0].least, round[1].least)) return false;
  // Two edges that cross slide the faster the smaller their angle is.
  if (std::isinf(round[0].most) && std::isinf(round[1].most)) return false;
  double most = distance;  // of a polyhedron only open ways count
  for (const Roundness& one : round) most += std::isinf(one.most) ? 0 : one.most;
  const double ratio = std::sqrt(most / sum.least);
  sum.skew = (ratio + 1 / ratio) / 2;
  return true;
}

/// Bounds on the velocities of the normal (1/s) and of the witness points on their bodies (m/s).
struct Slides {
  double turn = kInfinity, slide[2] = {0, 0};
};

Slides slidesOf(double distance, const Vector3d& n, const std::array<Vector3d, 2>& point,
                const std::array<Roundness, 2>& round, const RadiiSum& both, const Twist& first,
                const Twist& other) {
  Slides result;
  const double spin = (other.angular - first.angular).cross(n).norm();
  for (std::size_t side = 0; side < 2; ++side) {
    const Vector3d& x = point[side];
    const double apart = across(velocityOf(x, other) - velocityOf(x, first), n);
    const Roundness &own = round[side], &others = round[1 - side];
    // Of this body's W: |S^-1 W|, and W S^-1 (S - W), the parallel sum. Where the other body's W + d may be
    // negative this body's W + d is not, and each is what it is on the other side and a part of d.
    double share = both.skew, sum = std::min(own.most, others.most + distance);
    if (both.deep > others.least) {
      share += both.deep / both.least;
      sum = std::min(others.most, own.most + distance) + both.deep * (both.skew + share);
    }
    // The normal as body 1, then body 2, carries it, and what it turns against that.
    const Vector3d carried = (side == 0 ? other : first).angular.cross(n);
    result.turn = std::min(result.turn, carried.norm() + apart / both.least + share * spin);
    result.slide[side] = share * apart + sum * spin;
  }
  return result;
}

}  // namespace

double CollisionConstraints::gradientRateBound(int row) const {
  requireRow(row);
  if (at(row) >= pairs_.size() || !moving_) return kInfinity;
  const Row& r = rows_[at(row)];
  const Witness w = known(at(row));
  double slope, curvature;
  levelled(at(row), w.distance, slope, curvature);
  if (slope == 0 && curvature == 0) return 0;
  // A pair with a slope is not far away, so its distance cannot be measured.
  if (w.status == DistanceStatus::invalid) return kInfinity;
  std::array<Roundness, 2> round;
  if (!roundnessOf(*geometry_->bodies[at(r.a)].geometry, round[0]) ||
      !roundnessOf(second(pairs_[at(row)]), round[1]))
    return kInfinity;
  RadiiSum both;
  if (!sumOf(w.distance, round, both)) return kInfinity;
  Twist first, other;
  bodyVelocities(at(row), first, other);
  const Vector3d& n = w.normal;
  const Slides slides = slidesOf(w.distance, n, w.point, round, both, first, other);
  const double speed = n.dot(velocityOf(w.point[1], other) - velocityOf(w.point[0], first));
  double sum = 0, shared = 0;  // joints that share a coordinate are neighbours in the list of terms
  for (int t = r.firstTerm; t < r.lastTerm; ++t) {
    const Term& term = terms_[at(t)];
    const Vector3d& x = w.point[at(term.side)];
    const Twist &motion = state_.motion[at(term.motion)], &change = rate_.motion[at(term.motion)];
    const Twist& body = term.side == 0 ? first : other;
    const Vector3d lever = velocityOf(x, motion);
    // The part of the joint itself: the velocity change along n that the joint gives to the material point at
    // x.
    const double own = std::abs(n.dot(velocityOf(x, change) + motion.angular.cross(velocityOf(x, body))));
    const double entry =
        slope * (slides.turn * lever.norm() + motion.angular.norm() * slides.slide[term.side] + own) +
        std::abs(curvature * speed) * lever.norm();
    shared += entry;
    if (t + 1 < r.lastTerm && terms_[at(t + 1)].slot == term.slot) continue;
    sum += shared * shared;
    shared = 0;
  }
  return std::sqrt(sum);
}

}  // namespace fcl_stpbv
