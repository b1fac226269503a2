// Smallest enclosing ball, an LP-type problem (Welzl 1991; Gaertner 1999): at most four points define it.
// 1. The farthest point outside the ball enters.
// 2. The smallest ball of the at most five points is found by trying their subsets.
// 3. Repeat until no point is outside.
#include "fcl_stpbv/volume/minimum_ball.h"

#include <Eigen/Dense>

namespace fcl_stpbv::detail {
namespace {

using LongVector = Eigen::Matrix<long double, 3, 1>;

struct Candidate {
  LongVector centre = LongVector::Zero();
  long double radius2 = -1;
};

// Smallest ball through all of the given one to four points; its radius2 is negative if the points are
// dependent.
Candidate ballThrough(const std::vector<LongVector>& p) {
  Candidate ball;
  const Eigen::Index k = static_cast<Eigen::Index>(p.size()) - 1;
  LongVector offset = LongVector::Zero();
  if (k > 0) {
    Eigen::Matrix<long double, 3, Eigen::Dynamic, 0, 3, 3> edges(3, k);
    for (Eigen::Index j = 0; j < k; ++j) edges.col(j) = p[static_cast<std::size_t>(j) + 1] - p[0];
    const Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3> gram =
        edges.transpose() * edges;
    const Eigen::FullPivLU<Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>> lu(gram);
    if (lu.rank() < k) return ball;
    offset = edges * lu.solve(gram.diagonal() / 2);
  }
  ball.centre = p[0] + offset;
  ball.radius2 = offset.squaredNorm();
  return ball;
}

}  // namespace

Ball minimumEnclosingBall(const std::vector<Eigen::Vector3d>& points) {
  const Eigen::Vector3d& origin = points.front();
  std::vector<LongVector> held{LongVector::Zero()};
  Candidate ball = ballThrough(held);
  // The radius grows in each round, and a few rounds are enough for any cloud. The limit only prevents an
  // endless loop caused by rounding.
  for (int round = 0; round < 1000; ++round) {
    const Eigen::Vector3d centre = origin + ball.centre.cast<double>();
    std::size_t farthest = 0;
    double farthest2 = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double d2 = (points[i] - centre).squaredNorm();
      if (d2 > farthest2) farthest2 = d2, farthest = i;
    }
    const LongVector p = (points[farthest] - origin).cast<long double>();
    if ((p - ball.centre).squaredNorm() <= ball.radius2 * (1 + 1e-15L)) break;
    held.push_back(p);
    Candidate best;
    std::vector<LongVector> bestHeld;
    const unsigned all = 1u << held.size();
    for (unsigned subset = 1; subset < all; ++subset) {
      std::vector<LongVector> trial;
      for (std::size_t i = 0; i < held.size(); ++i)
        if (subset >> i & 1u) trial.push_back(held[i]);
      if (trial.size() > 4) continue;
      const Candidate c = ballThrough(trial);
      if (c.radius2 < 0 || (best.radius2 >= 0 && c.radius2 >= best.radius2)) continue;
      bool holdsAll = true;
      for (const LongVector& h : held)
        holdsAll = holdsAll && (h - c.centre).squaredNorm() <= c.radius2 * (1 + 1e-15L);
      if (holdsAll) best = c, bestHeld = trial;
    }
    if (best.radius2 <= ball.radius2) break;  // no progress: rounding
    ball = best;
    held = bestHeld;
  }
  Ball result;
  result.centre = origin + ball.centre.cast<double>();
  for (const Eigen::Vector3d& p : points) result.radius = std::max(result.radius, (p - result.centre).norm());
  return result;
}

}  // namespace fcl_stpbv::detail
