// Checks the claim:
// 1. Compute the points' heights over the claimed ball.
// 2. Find the points that it touches: at most forty, no two at one place.
// 3. For each one, two and three of these, find the weights whose mean is nearest to the line along n through
//    x, and the lower bound that ball_hull_check.h derives from them.
#include "test/reference/ball_hull_check.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace fcl_stpbv::test {
namespace {

using Vector = Eigen::Matrix<long double, 3, 1>;

// Weights of the point nearest to the line along n through the origin, on two points' segment or in three
// points' triangle.
struct Weights {
  long double a, b, c;
};

Weights onSegment(const Vector& a, const Vector& b, const Vector& n) {
  const Vector edge = b - a, across = edge - n.dot(edge) * n;
  const long double length2 = across.squaredNorm();
  const long double t = length2 > 0 ? std::clamp(-a.dot(across) / length2, 0.0L, 1.0L) : 0.0L;
  return {1 - t, t, 0};
}

Weights inTriangle(const Vector& a, const Vector& b, const Vector& c, const Vector& n) {
  // Areas, seen along n, of the triangles between the origin and the sides.
  const long double u = n.dot(b.cross(c)), v = n.dot(c.cross(a)), w = n.dot(a.cross(b)), sum = u + v + w;
  if (sum == 0 || u * sum < 0 || v * sum < 0 || w * sum < 0) return {-1, 0, 0};
  return {u / sum, v / sum, w / sum};
}

}  // namespace

BallHullClaim checkBallHull(const std::vector<Eigen::Vector3d>& points, double radius,
                            const Eigen::Vector3d& normal, const Eigen::Vector3d& x) {
  const Vector n = normal.cast<long double>().normalized();
  const long double rho = radius;
  std::vector<Vector> q;  // relative to x
  for (const Eigen::Vector3d& p : points) q.push_back(p.cast<long double>() - x.cast<long double>());

  long double outside = -std::numeric_limits<long double>::infinity(), size = 0;
  std::vector<std::pair<long double, Vector>> near;
  for (const Vector& p : q) {
    //
    // p + rho n
    //  - rho, without cancellation.
    const long double height = (p.squaredNorm() + 2 * rho * n.dot(p)) / ((p + rho * n).norm() + rho);
    outside = std::max(outside, height);
    size = std::max(size, p.norm());
    near.push_back({-height, p});
  }
  // The points that the claimed ball touches give the best bound. Additional points, or one of several close
  // together, do no harm.
  std::sort(near.begin(), near.end(), [](const auto& s, const auto& t) { return s.first < t.first; });
  std::vector<Vector> touched;
  const long double rounding =
      64 * std::numeric_limits<double>::epsilon() * (x.cwiseAbs().maxCoeff() + radius);
  for (const auto& [depth, p] : near) {
    const Vector& here = p;
    const bool isApart = std::all_of(touched.begin(), touched.end(),
                                     [&](const Vector& t) { return (t - here).norm() > 1e-7L * size; });
    if (touched.size() < 40 && isApart && (touched.empty() || depth <= 1e-7L * size + rounding))
      touched.push_back(p);
  }

  // Lower bound on the support, relative to n.x.
  long double lower = -std::numeric_limits<long double>::infinity();
  const auto consider = [&](const Vector& a, const Vector& b, const Vector& c, const Weights& w) {
    if (w.a < 0) return;
    const Vector y = w.a * a + w.b * b + w.c * c;
    const long double spread =
        w.a * (a - y).squaredNorm() + w.b * (b - y).squaredNorm() + w.c * (c - y).squaredNorm();
    if (spread > rho * rho) return;
    lower = std::max(lower, n.dot(y) + spread / (rho + std::sqrt(rho * rho - spread)));
  };
  for (std::size_t i = 0; i < touched.size(); ++i) {
    consider(touched[i], touched[i], touched[i], {1, 0, 0});
    for (std::size_t j = i + 1; j < touched.size(); ++j) {
      consider(touched[i], touched[j], touched[j], onSegment(touched[i], touched[j], n));
      for (std::size_t k = j + 1; k < touched.size(); ++k)
        consider(touched[i], touched[j], touched[k], inTriangle(touched[i], touched[j], touched[k], n));
    }
  }
  return {static_cast<double>(outside), static_cast<double>(-lower)};
}

}  // namespace fcl_stpbv::test
