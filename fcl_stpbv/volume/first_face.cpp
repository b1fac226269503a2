// Finds the first face: moves the ball until a first point stops it, tilts it about this point until it
// touches a second point, and rolls it over both points until it touches a third.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_side.h"
#include "fcl_stpbv/volume/minimum_ball.h"
#include "fcl_stpbv/volume/rolling_cloud.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;

// Starts with a ball that contains all points and moves it against `direction` until its surface touches a
// point. `normal` becomes the ball's normal there. Let d be the direction and q = p - centre, split into q.d
// and a vector t perpendicular to d. Then p stops the ball at the depth q.d + kappa t^2 / (1 + sqrt(1 -
// kappa^2 t^2)) below the farthest position. This formula contains no large number.
int touchFirst(const RollingCloud& cloud, const Vector3d& direction, Vector3d* normal) {
  const Vector3d centre = minimumEnclosingBall(cloud.points).centre;
  int best = -1;
  double deepest = 0;
  for (int i = 0; i < cloud.count(); ++i) {
    if (cloud.tree.isRemoved(i)) continue;
    const Vector3d q = cloud.at(i) - centre, across = q - q.dot(direction) * direction;
    const double t = cloud.curvature * across.norm(), root = std::sqrt(std::max(0.0, 1 - t * t));
    const double depth = q.dot(direction) + across.norm() * t / (1 + root);
    if (best >= 0 && depth <= deepest) continue;
    best = i, deepest = depth;
    *normal = cloud.curvature * across + root * direction;
  }
  return best;
}

// Tilts the ball about `a` in some direction. Returns the point that stops the ball; of two points at the
// same angle, the farther one.
int touchSecond(const RollingCloud& cloud, int a, const Vector3d& normal) {
  const Vector3d aside = normal.unitOrthogonal();
  int best = -1;
  double bestAngle = 0, bestLength = 0;
  for (int i = 0; i < cloud.count(); ++i) {
    if (i == a || cloud.tree.isRemoved(i)) continue;
    const Vector3d q = cloud.at(i) - cloud.at(a);
    const double x = q.dot(normal), y = q.dot(aside), s = std::hypot(x, y), length = q.norm();
    if (s == 0) continue;
    double angle = std::atan2(y, x) - std::acos(std::max(-1.0, -0.5 * cloud.curvature * length * length / s));
    while (angle < 0) angle += kTwoPi;
    const bool tie = best >= 0 && std::abs(angle - bestAngle) < 1e-14;
    if (best < 0 || (tie ? length > bestLength : angle < bestAngle))
      best = i, bestAngle = angle, bestLength = length;
  }
  return best;
}

// The point that the ball meets first when it rolls over the edge from a to b.
int touchThird(const RollingCloud& cloud, int a, int b, const Vector3d& across) {
  int best = -1;
  double bestAngle = 0;
  for (int i = 0; i < cloud.count(); ++i) {
    if (i == a || i == b || cloud.tree.isRemoved(i)) continue;
    const double angle = leavingAngle(cloud, a, b, across, i);
    if (angle < 0 || (best >= 0 && angle >= bestAngle)) continue;
    if (!TouchingBall(cloud.at(b), cloud.at(a), cloud.at(i), cloud.radius).valid()) continue;
    best = i, bestAngle = angle;
  }
  return best;
}

}  // namespace

FirstFace firstFace(RollingCloud& cloud) {
  // Points that are very close to each other may be touched in the wrong order because of rounding. Then
  // start from another direction. The directions form a spiral, so that they are unlikely to coincide with an
  // axis of a hand-made cloud.
  constexpr int kTries = 64;
  constexpr double kGolden = 2.399963229728653;  // rad, from one direction to the next
  for (int k = 0; k < kTries; ++k) {
    const double z = 0.7643977126843163 - 1.7 * k / kTries, side = std::sqrt(1 - z * z);
    const Vector3d d(side * std::cos(kGolden * k - 0.6), side * std::sin(kGolden * k - 0.6), z);
    Vector3d normal = d;
    const int a = touchFirst(cloud, d, &normal);
    cloud.removeTwins(a);
    const int b = touchSecond(cloud, a, normal);
    if (b < 0) return {{}, {a}};
    cloud.removeTwins(b);
    // The ball's normal at a after the ball has been tilted about a until it touches b.
    const Vector3d edge = cloud.at(b) - cloud.at(a), u = edge.normalized(), aside = normal.unitOrthogonal();
    const double x = edge.dot(normal), y = edge.dot(aside), s = std::hypot(x, y);
    const double angle =
        std::atan2(y, x) - std::acos(std::max(-1.0, -0.5 * cloud.curvature * edge.squaredNorm() / s));
    const Vector3d tilted = std::cos(angle) * normal + std::sin(angle) * aside;
    const Vector3d across = (tilted - tilted.dot(u) * u).normalized();
    const int c = touchThird(cloud, a, b, across);
    if (c < 0) return {{}, {a, b}};
    try {
      return {pivot(cloud, a, b, across, c, isLone(cloud, a, b)), {}};
    } catch (const Error&) {  // rounding: a and b are no edge of the hull
    }
  }
  throw Error(
      "no first face found: the cloud's coordinates are too close to degenerate for double precision");
}

}  // namespace fcl_stpbv::detail
