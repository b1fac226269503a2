// Apart: Wolfe's active sets, on the differences of corners. The corner that is extreme along the present
// difference joins; corners without weight leave. Overlapping: all normals across three corners of one hull,
// and across two directions between corners, one of each hull.
#include "test/reference/stability/polyhedra.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace fcl_stpbv::stability {

namespace {

using MatrixL = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using VectorL = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

const Vector3L& extreme(const std::vector<Vector3L>& points, const Vector3L& n) {
  return *std::max_element(points.begin(), points.end(),
                           [&](const Vector3L& p, const Vector3L& q) { return n.dot(p) < n.dot(q); });
}

long double largest(const std::vector<Vector3L>& points) {
  long double length = 0;
  for (const Vector3L& p : points) length = std::max(length, p.cwiseAbs().maxCoeff());
  return length;
}

/// Weights, with sum 1, of the point nearest to the origin in the affine span of these points.
VectorL flatWeights(const std::vector<Vector3L>& points) {
  const auto count = static_cast<Eigen::Index>(points.size());
  VectorL weights(count);
  weights[0] = 1;
  if (count == 1) return weights;
  MatrixL axes(3, count - 1);
  for (Eigen::Index i = 1; i < count; ++i) axes.col(i - 1) = points[static_cast<std::size_t>(i)] - points[0];
  Eigen::CompleteOrthogonalDecomposition<MatrixL> solver;
  solver.setThreshold(1e-17L);
  solver.compute(axes);
  weights.tail(count - 1) = -solver.solve(points[0]);
  weights[0] -= weights.tail(count - 1).sum();
  return weights;
}

/// A convex combination of differences of corners.
struct Active {
  std::vector<Vector3L> points;
  std::vector<long double> weights;

  Vector3L at() const {
    Vector3L sum(0, 0, 0);
    for (std::size_t i = 0; i < points.size(); ++i) sum += weights[i] * points[i];
    return sum;
  }

  /// Moves to the point nearest to the origin in the hull of the active points. Points that it does not need
  /// leave.
  void settle() {
    for (;;) {
      const VectorL target = flatWeights(points);
      long double step = 1;
      for (std::size_t i = 0; i < points.size(); ++i) {
        const long double wanted = target[static_cast<Eigen::Index>(i)];
        if (wanted < 0) step = std::min(step, weights[i] / (weights[i] - wanted));
      }
      for (std::size_t i = 0; i < points.size(); ++i)
        weights[i] += step * (target[static_cast<Eigen::Index>(i)] - weights[i]);
      if (step >= 1) break;
      std::size_t least = 0;
      for (std::size_t i = 1; i < points.size(); ++i)
        if (weights[i] < weights[least]) least = i;
      points.erase(points.begin() + static_cast<std::ptrdiff_t>(least));
      weights.erase(weights.begin() + static_cast<std::ptrdiff_t>(least));
    }
    for (std::size_t i = points.size(); i-- > 0;)
      if (points.size() > 1 && weights[i] <= 0) {
        points.erase(points.begin() + static_cast<std::ptrdiff_t>(i));
        weights.erase(weights.begin() + static_cast<std::ptrdiff_t>(i));
      }
  }
};

long double overlapAlong(const std::vector<Vector3L>& a, const std::vector<Vector3L>& b, const Vector3L& n) {
  long double highA = n.dot(a[0]), lowA = highA, highB = n.dot(b[0]), lowB = highB;
  for (const Vector3L& p : a) highA = std::max(highA, n.dot(p)), lowA = std::min(lowA, n.dot(p));
  for (const Vector3L& p : b) highB = std::max(highB, n.dot(p)), lowB = std::min(lowB, n.dot(p));
  return std::min(highA - lowB, highB - lowA);
}

}  // namespace

std::vector<Vector3L> placedCorners(const test::Cloud& points, const Eigen::Isometry3d& pose,
                                    const Eigen::Vector3d& origin) {
  const Eigen::Matrix<long double, 3, 3> rotation = pose.linear().cast<long double>();
  const Vector3L offset = pose.translation().cast<long double>() - origin.cast<long double>();
  std::vector<Vector3L> placed;
  for (const Eigen::Vector3d& p : points) placed.push_back(rotation * p.cast<long double>() + offset);
  return placed;
}

Nearest nearestDifference(const std::vector<Vector3L>& a, const std::vector<Vector3L>& b) {
  const long double rounding = 64 * std::numeric_limits<long double>::epsilon() * (largest(a) + largest(b));
  Active active{{b[0] - a[0]}, {1}};
  Nearest best;
  long double narrowest = std::numeric_limits<long double>::infinity();
  for (int i = 0; i < 1000; ++i) {
    const Vector3L v = active.at();
    const long double length = v.norm();
    if (length <= rounding) {
      best.overlap = true;
      best.difference = v;
      return best;
    }
    const Vector3L n = v / length;
    const Vector3L corner = extreme(b, -n) - extreme(a, n);
    const long double gap = length - n.dot(corner);
    if (gap < narrowest) {
      narrowest = gap;
      best.difference = v;
      best.proven = gap <= 16 * rounding;
    }
    if (gap <= rounding) return best;
    for (const Vector3L& p : active.points)
      if (p == corner) return best;  // no new corner: rounding allows no nearer point
    active.points.push_back(corner);
    active.weights.push_back(0);
    active.settle();
  }
  return best;
}

std::optional<long double> leastOverlap(const std::vector<Vector3L>& a, const std::vector<Vector3L>& b) {
  constexpr std::size_t kMost = 20;
  if (a.size() > kMost || b.size() > kMost) return std::nullopt;
  long double least = std::numeric_limits<long double>::infinity();
  const auto attempt = [&](const Vector3L& normal, long double scale) {
    const long double length = normal.norm();
    if (length > 1e-15L * scale) least = std::min(least, overlapAlong(a, b, normal / length));
  };
  std::vector<Vector3L> sides[2];
  for (const auto* points : {&a, &b}) {
    std::vector<Vector3L>& own = sides[points == &b];
    for (std::size_t i = 0; i < points->size(); ++i)
      for (std::size_t j = i + 1; j < points->size(); ++j) {
        own.push_back((*points)[j] - (*points)[i]);
        for (std::size_t k = j + 1; k < points->size(); ++k) {
          const Vector3L side = (*points)[k] - (*points)[i];
          attempt(own.back().cross(side), own.back().norm() * side.norm());
        }
      }
  }
  for (const Vector3L& p : sides[0])
    for (const Vector3L& q : sides[1]) attempt(p.cross(q), p.norm() * q.norm());
  return least;
}

}  // namespace fcl_stpbv::stability
