// Pivots the ball over an edge:
// 1. guess a point on which the ball may come to rest;
// 2. find the point that is highest over that ball, with a tree (point_tree.h);
// 3. if it is outside the ball, try again with this point; otherwise the ball rests.
// Sides are decided exactly (ball_side.h). Angles are rounded, but they only decide the order in which points
// are tried.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/ball_side.h"
#include "fcl_stpbv/volume/rolling_cloud.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;
constexpr double kDiametral = 1 + 1e-9;  // so that rounding does not leave out the edge's own ends

// Takes the place of leavingAngle() for a point so close to a or b that its own angle is lost in rounding.
// The angle is taken from the ball at rest.
double angleOf(const RollingCloud& cloud, const TouchingBall& ball, int a, int b, const Vector3d& across) {
  const Vector3d side = (cloud.at(b) - cloud.at(a)).normalized().cross(across);
  const double angle = std::atan2(ball.normal().dot(side), ball.normal().dot(across));
  constexpr double kRounding = 1e-8;  // rad; an angle of 0 may come out this far below 0
  return angle < -kRounding ? angle + kTwoPi : std::max(0.0, angle);
}

// A point that the ball leaves before it has rolled by `rest` and that is inside again by then; -1 if there
// is none. Such a point is outside for only a part of the roll. If that part is less than half a turn, the
// point lies in the ball that has the edge as its diameter (`aside`). Otherwise the point is outside in the
// middle of the roll.
int leftOnTheWay(const RollingCloud& cloud, int a, int b, const Vector3d& across, double rest) {
  const Vector3d edge = cloud.at(b) - cloud.at(a), u = edge.normalized(), side = u.cross(across);
  std::vector<int> aside;
  cloud.tree.within(cloud.at(a) + 0.5 * edge, 0.5 * edge.norm() * kDiametral, &aside);
  const double sine = std::sin(rest), cosine = std::cos(rest),
               margin = 1e-9 * edge.norm();  // far above rounding, so that no point in the wedge is left out
  int left = -1;
  double first = rest - 1e-8;  // rad, as in angleOf(); points that leave later are still outside at the end
  for (const int i : aside) {
    if (i == a || i == b) continue;
    // A point is highest over the ball when the normal points at it across the edge; most points do not lie
    // in the wedge that the normal sweeps.
    const Vector3d q = cloud.at(i) - cloud.at(a);
    const double x = q.dot(across), y = q.dot(side);
    if (rest < 3 /* rad: a wedge below half a turn, with room */ &&
        (y < -margin || x * sine - y * cosine < -margin))
      continue;
    const double angle = leavingAngle(cloud, a, b, across, i);
    if (angle >= 0 && angle < first) left = i, first = angle;
  }
  if (left >= 0 || rest < 0.5 * kTwoPi - 1e-6) return left;
  const double half = 0.5 * cloud.curvature * edge.norm();
  const Vector3d middle = -half * u + std::sqrt(std::max(0.0, 1 - half * half)) *
                                          (std::cos(0.5 * rest) * across + std::sin(0.5 * rest) * side);
  std::vector<int> near;
  const double tolerance = 4e-15 * cloud.extent;
  const PointTree::Highest top = cloud.tree.highest(cloud.at(a), middle, cloud.curvature, tolerance, &near);
  return top.height > tolerance ? top.index : -1;
}

}  // namespace

bool isLone(const RollingCloud& cloud, int a, int b) {
  if (cloud.curvature == 0) return true;
  std::vector<int> found;
  cloud.tree.within(0.5 * (cloud.at(a) + cloud.at(b)), 0.5 * (cloud.at(b) - cloud.at(a)).norm() * kDiametral,
                    &found, 3);
  return found.size() <= 2;
}

double leavingAngle(const RollingCloud& cloud, int a, int b, const Vector3d& across, int p) {
  // In long double: near the smallest radius the arc cosine loses half of its digits.
  using Vector = Eigen::Matrix<long double, 3, 1>;
  const Vector edge = (cloud.at(b) - cloud.at(a)).cast<long double>(),
               q = (cloud.at(p) - cloud.at(a)).cast<long double>();
  const Vector w = across.cast<long double>();
  const long double length = edge.norm(), curvature = cloud.curvature, half = curvature * length / 2;
  const Vector u = edge / length;
  const long double constant = curvature / 2 * (q.squaredNorm() - length * q.dot(u));
  const long double scale = std::sqrt(std::max(0.0L, 1 - half * half));
  const long double x = scale * q.dot(w), y = scale * q.dot(u.cross(w)), s = std::hypot(x, y);
  if (s <= std::abs(constant) || s < 1e-14L * length) return -1;
  double angle = static_cast<double>(std::atan2(y, x) - std::acos(-constant / s));
  while (angle < 0) angle += kTwoPi;
  // If a point leaves at once, rounding may make its angle almost a whole turn. No point stays inside that
  // long.
  return angle > kTwoPi - 1e-8 ? 0 : angle;
}

Ring pivot(RollingCloud& cloud, int a, int b, const Vector3d& across, int candidate, bool lone) {
  std::vector<int> sent, near;
  for (int round = 0; round < 10000; ++round) {
    const TouchingBall ball(cloud.at(b), cloud.at(a), cloud.at(candidate), cloud.radius);
    if (!ball.valid()) break;
    // Largest error of a height over this ball in double precision (m).
    const double tolerance = cloud.extent * (2e-15 + 4 * ball.normalError());
    // Any point outside leaves the ball before the present candidate does. A point near a or b is quickly
    // found.
    PointTree::Highest top =
        cloud.tree.highestBeside(round % 2 == 0 ? a : b, cloud.at(b), ball.normal(), cloud.curvature);
    if (top.height <= tolerance)
      top = cloud.tree.highest(cloud.at(b), ball.normal(), cloud.curvature, tolerance, &near);
    if (top.height > tolerance) {
      candidate = top.index;
      continue;
    }
    int outside = -1;
    long double height = 0;
    std::vector<int> touched{b, a, candidate};
    for (const int i : near) {
      if (i == a || i == b || i == candidate) continue;
      const int side = ball.side(cloud.at(i));
      if (side == 0) touched.push_back(i);
      if (side > 0 && (outside < 0 || ball.height(cloud.at(i)) > height))
        outside = i, height = ball.height(cloud.at(i));
    }
    if (outside < 0 && !lone) {
      const double rest = leavingAngle(cloud, a, b, across, candidate);
      outside = leftOnTheWay(cloud, a, b, across, rest >= 0 ? rest : angleOf(cloud, ball, a, b, across));
      // Sides of the ball are exact, but angles are not: among near-duplicate points the ball may jump back
      // and forth. If it has been at a point once and did not stay, it does not rest there.
      if (std::find(sent.begin(), sent.end(), outside) != sent.end()) outside = -1;
      sent.push_back(outside);
    }
    if (outside >= 0) {
      candidate = outside;
      continue;
    }
    touched.erase(
        std::remove_if(touched.begin(), touched.end(), [&](int i) { return cloud.tree.isRemoved(i); }),
        touched.end());
    Ring ring = ringOf(cloud.points, ball, b, a, std::move(touched));
    if (cloud.claim(ring)) return ring;
    const auto alive =
        std::find_if(ring.begin() + 2, ring.end(), [&](int i) { return !cloud.tree.isRemoved(i); });
    if (alive == ring.end()) break;
    candidate = *alive;
  }
  throw Error(
      "the rolling ball found no rest: the cloud's coordinates are too close to degenerate for double "
      "precision");
}

}  // namespace fcl_stpbv::detail
