// Computes the last digits of normal and points for two bodies apart whose nearest faces, ends or edges are
// nearly parallel.
//
// When GJK's bounds agree up to rounding, its normal is only accurate to the square root of that, and the
// differences of the corners' heights are as small as the rounding of the bodies' size. So:
// 1. Turn GJK's normal n by t. The gap is then D + min(h + p.t) - D |t|^2 / 2. Here D is the gap along n, and
//    each difference of two support points has the height D + h along n and the offset p perpendicular to n.
// 2. For up to three differences, the t with the largest gap has a closed form. The difference that is lowest
//    at that t is added, until none is lower. The weights of the differences give the two points.
#include <algorithm>
#include <array>
#include <initializer_list>

#include "fcl_stpbv/distance/shape_pair.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// A difference of two corners, in coordinates along and across the normal.
struct LevelDifference {
  Vector3d onA{0, 0, 0}, onB{0, 0, 0};  ///< the corners (m)
  double height = 0;                    ///< above the lowest difference (m)
  Vector2d across{0, 0};                ///< offset perpendicular to the normal (m)

  double heightAt(const Vector2d& turn) const { return height + across.dot(turn); }
};

/// Up to four differences, and the turn at which the gap between them is widest.
struct WidestTurn {
  std::array<LevelDifference, 4> difference;
  std::array<double, 4> weight{};
  int count = 0;
  Vector2d turn{0, 0};      ///< tangent of the angle
  double gap = -kInfinity;  ///< the gap at that turn, less D (m)

  void add(const LevelDifference& one) { difference[at(count++)] = one; }
  Vector3d weighted(Vector3d LevelDifference::*point) const {
    Vector3d sum(0, 0, 0);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      sum += weight[i] * (difference[i].*point);
    return sum;
  }
  double lowest(const Vector2d& turned) const {
    double least = kInfinity;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
      least = std::min(least, difference[i].heightAt(turned));
    return least;
  }

  /// The widest turn for all of these differences, at the distance `d` (m). Keeps only those with a weight.
  WidestTurn best(double d) const {
    WidestTurn widest;
    // The weighted sum of the offsets across is `d` times the turn, but only up to rounding of the bodies'
    // size. If several differences have the same height at the turn, their heights determine the turn.
    const auto offer = [&](std::initializer_list<int> which, std::initializer_list<double> weights,
                           const Vector2d& turned) {
      WidestTurn x;
      x.turn = turned;
      const double* w = weights.begin();
      for (const int i : which) {
        if (!(*w >= 0.0)) return;
        x.weight[at(x.count)] = *w++;
        x.add(difference[at(i)]);
      }
      x.gap = lowest(turned) - 0.5 * d * turned.squaredNorm();
      if (x.gap > widest.gap) widest = x;
    };
    for (int i = 0; i < count; ++i) {
      const LevelDifference& p = difference[at(i)];
      offer({i}, {1.0}, p.across / d);
      for (int j = 0; j < i; ++j) {
        const LevelDifference& q = difference[at(j)];
        const Vector2d e = q.across - p.across;
        const double e2 = e.squaredNorm(), he = p.height - q.height;  // equal heights: e.t = he
        const double w = (d * he - p.across.dot(e)) / e2;
        offer({i, j}, {1.0 - w, w}, he / e2 * e + cross(e, p.across) / (d * e2) * Vector2d(-e.y(), e.x()));
        for (int k = 0; k < j; ++k) {
          const LevelDifference& r = difference[at(k)];
          const Vector2d f = r.across - p.across;
          const double area = cross(e, f), hf = p.height - r.height;
          const Vector2d t((he * f.y() - hf * e.y()) / area, (hf * e.x() - he * f.x()) / area),
              from = d * t - p.across;
          const double u = cross(from, f) / area, v = cross(e, from) / area;
          offer({i, j, k}, {1.0 - u - v, u, v}, t);
        }
      }
    }
    return widest;
  }

 private:
  static double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }
};

}  // namespace

std::optional<OppositePoints> oppositeLevel(const ShapePair& p, Vector3d n) {
  constexpr int kRounds = 4, kSteps = 40;
  for (int round = 0; round < kRounds; ++round) {
    const Vector3d e = n.unitOrthogonal(), f = n.cross(e);
    const auto onA = [&](const Vector3d& m) { return p.a.support(m); };
    const auto onB = [&](const Vector3d& m) { return p.pose.placed(p.b.support(p.pose.opposite(m))); };
    const Vector3d topA = onA(n), topB = onB(n);
    const double distance = n.dot(topB - topA);
    if (!(distance > p.rounding)) return {};
    const auto lowest = [&](const Vector2d& turn) {
      const Vector3d m = n + turn.x() * e + turn.y() * f, a = onA(m), b = onB(m), between = b - a;
      return LevelDifference{a, b, n.dot(b - topB) - n.dot(a - topA), {e.dot(between), f.dot(between)}};
    };
    WidestTurn widest;
    LevelDifference next = lowest(Vector2d(0, 0));
    for (int step = 0; step < kSteps; ++step) {
      widest.add(next);
      widest = widest.best(distance);
      next = lowest(widest.turn);
      if (next.heightAt(widest.turn) >= widest.lowest(widest.turn) - 0.1 * p.rounding) break;
    }
    n = (n + widest.turn.x() * e + widest.turn.y() * f).normalized();
    const double gap = ShapePair::Difference(p.a, p.b, p.pose).support(n).gap;
    const Vector3d pointOfA = widest.weighted(&LevelDifference::onA),
                   toB = widest.weighted(&LevelDifference::onB) - pointOfA;
    if ((toB - gap * n).norm() <= 2.0 * p.rounding) return OppositePoints{n, gap, pointOfA, toB};
  }
  return {};
}

}  // namespace fcl_stpbv::detail
