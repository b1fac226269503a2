// Monotone Newton ascent of the gap between an STP-BV's core and one smooth feature of another body.
//
// 1. If the start has no gap, find a normal with a gap by bisection of the remaining directions.
// 2. Take Newton's step on the sphere. If it does not raise the gap, shorten it along its great circle to
//    where the slope is about zero, by a bracketed secant method.
// 3. Stop when the gradient is only rounding.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fcl_stpbv/convex/direction_cone.h"
#include "fcl_stpbv/convex/support.h"
#include "fcl_stpbv/distance/patch_pair.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/volume/stp_bv.h"

namespace fcl_stpbv::detail {

/// Support point of one patch along the unit normal `n`, even if `n` is outside of its region. Body frame.
inline SupportPoint viewPatch(const StpBv& body, const Eigen::Vector3d& n, int index) {
  const PosedPatch patch = posedPatch(body, index);
  const CoreView view = viewCore(patch, pack(n));
  return {n, index, unpack(patch.anchor), view.rise, unpack(patch.anchor + view.offset)};
}

/// Support point of the volume along `n`. The search for the owner starts at the patch `hint` (-1: anywhere).
/// Adds the number of patches changed to `steps`.
inline SupportPoint viewVolume(const StpBv& body, const Eigen::Vector3d& n, int hint, int& steps) {
  const int index = body.owner(n, hint);
  steps += index != hint;
  return viewPatch(body, n, index);
}

/// An STP-BV's core as a body of the support concept (convex/support.h). The search for the patch of a normal
/// starts at the last patch.
struct StpBvCore {
  const StpBv& body;
  int patch;   ///< the last one; -1: none
  int& steps;  ///< counts patches changed
};

inline SupportPoint supportPoint(StpBvCore& core, const Eigen::Vector3d& n) {
  const SupportPoint view = viewVolume(core.body, n, core.patch, core.steps);
  core.patch = view.patch;
  return view;
}

/// Radii of curvature of the core at the support point: the derivative of the point by the normal (m).
inline Eigen::Matrix3d curvatureRadii(const StpBv& body, const SupportPoint& view) {
  return coreCurvature(posedPatch(body, view.patch), view.n);
}

/// Rounding errors of the numbers of one pair.
struct Rounding {
  double gap;          ///< of a gap (m)
  double certificate;  ///< bound on that error, with the poses' own rounding (m)
  double across;  ///< of a difference of core points across the normal: an ulp moves a face's by rho ulp (m)
};

/// Support point of a feature of the other body along the opposite normal. Each feature also has `wobble`
/// (m): the error of its point that the rounding of a unit normal causes, in addition to that of the
/// coordinates.
struct FeatureView {
  Eigen::Vector3d point;
  Eigen::Matrix3d curvature;  ///< derivative of `point` with its own outward normal (m)
};

/// A single point: a ball's centre, a corner, an apex.
struct PointFeature {
  Eigen::Vector3d p;
  FeatureView along(const Eigen::Vector3d&) const { return {p, Eigen::Matrix3d::Zero()}; }
  const Eigen::Vector3d* direction() const { return nullptr; }
  double wobble(const Eigen::Vector3d&) const { return 0.0; }
};

/// An infinite line. Only normals perpendicular to it have a gap, so the ascent is along a great circle.
struct LineFeature {
  Eigen::Vector3d p;
  Eigen::Vector3d t;  ///< unit
  FeatureView along(const Eigen::Vector3d&) const { return {p, Eigen::Matrix3d::Zero()}; }
  const Eigen::Vector3d* direction() const { return &t; }
  double wobble(const Eigen::Vector3d&) const { return 0.0; }
};

/// The rim of a disc: the torus formula with the other sign of kappa (docs/theory.md, 2).
struct RimFeature {
  Eigen::Vector3d centre;
  Eigen::Vector3d axis;  ///< unit
  double radius;
  /// Limits the radius of curvature: with one that is too small the ascent still moves, with an infinite one
  /// it does not.
  double floor = 1e-6;
  FeatureView along(const Eigen::Vector3d& n) const {
    // Projected twice, because rounding along the axis is magnified by radius / c below.
    Eigen::Vector3d side = n - n.dot(axis) * axis;
    side -= side.dot(axis) * axis;
    const double c = side.norm();
    if (!(c > 0.0)) return {centre, Eigen::Matrix3d::Zero()};
    const Eigen::Vector3d around = axis.cross(n) / c;
    return {centre - (radius / c) * side, (radius / std::max(c, floor)) * around * around.transpose()};
  }
  const Eigen::Vector3d* direction() const { return nullptr; }
  /// If the normal is near the axis, an ulp moves the point far along the rim.
  double wobble(const Eigen::Vector3d& n) const {
    return radius * std::min(1e-6, 1e-15 / (n - n.dot(axis) * axis).norm());
  }
};

/// A whole ellipsoid: the image of the unit ball. Uses only sums of squares, which are accurate even for an
/// ellipsoid as thin as a disc.
struct EllipsoidFeature {
  Eigen::Vector3d centre;
  Eigen::Matrix3d axes;  ///< columns: the semi-axes (m)
  FeatureView along(const Eigen::Vector3d& n) const {
    const Eigen::Vector3d e = axes.transpose() * n;
    const double h = e.norm();
    if (!(h > 0.0)) return {centre, Eigen::Matrix3d::Zero()};  // a flat ellipsoid, and `n` is its normal
    const Eigen::Vector3d ball = e / h, point = axes * ball;
    const Eigen::Matrix3d across = axes - point * ball.transpose();
    return {centre - point, across * across.transpose() / h};
  }
  const Eigen::Vector3d* direction() const { return nullptr; }
  /// An ulp of the normal moves the point by an ulp of the radius of curvature, which is large on a flat
  /// side.
  double wobble(const Eigen::Vector3d& n) const {
    const double size = axes.norm(), h = (axes.transpose() * n).norm();
    return size * std::min(1.0, 1e-15 * size / std::max(h, 1e-300));
  }
};

/// One trial normal of an ascent.
struct AscentPoint {
  SupportPoint view;
  FeatureView feature;
  double gap = 0;
  Eigen::Vector3d across;  ///< gradient of the gap on the sphere, or on the great circle of a line
};

template <typename Feature>
AscentPoint ascentPoint(const SupportPoint& view, const Feature& feature) {
  const Eigen::Vector3d& n = view.n;
  AscentPoint x{view, feature.along(n), 0.0, Eigen::Vector3d(0, 0, 0)};
  x.gap = x.view.gap(x.feature.point);
  const Eigen::Vector3d difference = x.feature.point - x.view.point;
  x.across = difference - difference.dot(n) * n;
  if (const Eigen::Vector3d* t = feature.direction()) x.across -= x.across.dot(*t) * *t;
  return x;
}

template <typename Feature>
AscentPoint ascentPoint(const StpBv& body, const Feature& feature, const Eigen::Vector3d& n, int hint,
                        int& steps) {
  return ascentPoint(viewVolume(body, n, hint, steps), feature);
}

/// Finds a normal with a gap by bisection of the remaining directions (docs/theory.md, 5: the points of a
/// failed trial exclude half of all directions). False if there is none.
template <typename Feature>
bool findGap(const StpBv& body, const Feature& feature, AscentPoint& x, double touch, int& steps) {
  const auto difference = [&](const AscentPoint& y) -> Eigen::Vector3d {
    return y.gap * y.view.n + y.across;
  };
  if (x.gap > touch) return true;
  if (!(difference(x).norm() > touch)) return false;
  if (const Eigen::Vector3d* t = feature.direction()) {
    constexpr int kHalvings = 60;
    const Eigen::Vector3d d = difference(x) - difference(x).dot(*t) * *t;
    const Eigen::Vector3d e1 = d.normalized(), e2 = t->cross(e1);
    constexpr double kQuarter = kPi / 2;
    double low = -kQuarter, high = kQuarter;
    for (int i = 0; i < kHalvings && high > low; ++i) {
      const double angle = 0.5 * (low + high);
      x = ascentPoint(body, feature, (std::cos(angle) * e1 + std::sin(angle) * e2).normalized(), x.view.patch,
                      steps);
      if (x.gap > touch) return true;
      const Eigen::Vector3d next = difference(x);
      if (!(next.norm() > touch)) return false;
      const double pole = std::atan2(next.dot(e2), next.dot(e1));
      low = std::max(low, pole - kQuarter);
      high = std::min(high, pole + kQuarter);
    }
    return false;
  }
  const auto asTrial = [&] { return DirectionTrial{x.view.n, x.gap, difference(x)}; };
  bisectDirections(
      asTrial(), touch,
      [&](const Eigen::Vector3d& n) {
        x = ascentPoint(body, feature, n, x.view.patch, steps);
        return asTrial();
      },
      [&](const DirectionTrial& t) { return t.gap > touch; });
  return x.gap > touch;
}

/// Newton's step on the sphere (docs/theory.md, 6): the matrix W_A + W_B +
/// gap, positive while there is a gap.
inline Eigen::Vector3d newtonTarget(const StpBv& body, const AscentPoint& x, const Eigen::Vector3d* line) {
  const Eigen::Vector3d& n = x.view.n;
  Eigen::Vector3d e1;
  if (line) {
    e1 = line->cross(n).normalized();
  } else {
    int smallest = 0;
    n.cwiseAbs().minCoeff(&smallest);
    e1 = n.cross(Eigen::Vector3d::Unit(smallest)).normalized();
  }
  const Eigen::Matrix3d w = curvatureRadii(body, x.view) + x.feature.curvature;
  const double g1 = x.across.dot(e1), m11 = e1.dot(w * e1) + x.gap;
  if (line) return (n + (m11 > 0.0 ? g1 / m11 : g1) * e1).normalized();
  const Eigen::Vector3d e2 = n.cross(e1);
  const double g2 = x.across.dot(e2), m22 = e2.dot(w * e2) + x.gap, m12 = e1.dot(w * e2);
  const double det = m11 * m22 - m12 * m12;
  if (!(det > 0.0 && m11 > 0.0)) return (n + x.across.normalized()).normalized();
  return (n + ((m22 * g1 - m12 * g2) / det) * e1 + ((m11 * g2 - m12 * g1) / det) * e2).normalized();
}

/// Ascends from `x` to a local maximum of the gap. True if the gradient there is only rounding. Each step
/// raises the gap: if Newton's step does not, it is shortened to where the slope along it is about zero, by a
/// bracketed secant method (the gap is C1).
template <typename Feature>
bool ascendFrom(const StpBv& body, const Feature& feature, AscentPoint& x, const Rounding& rounding,
                int& pairs, int& steps) {
  constexpr int kSteps = 60, kTrials = 40;
  constexpr double kFlat = 0.05;  // of the slope at the start; the next Newton step solves for the rest
  for (int i = 0; i < kSteps; ++i) {
    const double flat = x.across.norm();
    const double rounded = rounding.across + feature.wobble(x.view.n);
    if (flat <= 0.25 * rounded) return true;
    ++pairs;
    const Eigen::Vector3d to = newtonTarget(body, x, feature.direction());
    AscentPoint y = ascentPoint(body, feature, to, x.view.patch, steps);
    const Eigen::Vector3d cross = x.view.n.cross(to);
    const double sine = cross.norm();
    const Eigen::Vector3d pole = sine > 0.0 ? Eigen::Vector3d(cross / sine) : cross;
    const auto slope = [&](const AscentPoint& p) { return p.across.dot(pole.cross(p.view.n)); };
    const double start = slope(x);
    const bool flatter = y.across.norm() < 0.5 * flat;
    // Near the maximum gaps differ only by rounding, so the gradient decides.
    const bool accepted = flatter ? y.gap >= x.gap - rounding.gap : y.gap > x.gap && slope(y) > -0.5 * start;
    if (!accepted) {
      if (flat <= rounded) return true;
      if (y.view.patch != x.view.patch) {
        // The step crossed a boundary, beyond which the gap has another curvature. So repeat the step from
        // `x` with the formula of the patch beyond the boundary.
        const AscentPoint there = ascentPoint(viewPatch(body, x.view.n, y.view.patch), feature);
        const AscentPoint z =
            ascentPoint(body, feature, newtonTarget(body, there, feature.direction()), y.view.patch, steps);
        if (z.across.norm() < 0.5 * flat && z.gap >= x.gap - rounding.gap) {
          x = z;
          continue;
        }
      }
      if (!(sine > 1e-15) || !(start > 0.0)) return false;
      double low = 0.0, high = 1.0, lowSlope = start, highSlope = slope(y);
      // Beyond a region boundary, Newton's step may overshoot to a normal whose gap is equal up to rounding.
      // Then the normal with the smaller gradient is better.
      const auto better = [&](const AscentPoint& p, const AscentPoint& than) {
        return p.gap > than.gap + rounding.gap ||
               (p.gap >= than.gap - rounding.gap && p.across.norm() < than.across.norm());
      };
      AscentPoint best = better(y, x) ? y : x;
      bool grew = better(y, x);
      for (int k = 0; k < kTrials; ++k) {
        double at = 0.5 * (low + high);
        if (highSlope < 0.0 && k % 3 != 2) at = low + (high - low) * lowSlope / (lowSlope - highSlope);
        if (!(at > low && at < high)) break;
        Eigen::Vector3d m = ((1.0 - at) * x.view.n + at * to).normalized();
        const AscentPoint mid = ascentPoint(body, feature, m, x.view.patch, steps);
        const double here = slope(mid);
        if (better(mid, best)) best = mid, grew = true;
        const bool above = mid.gap >= x.gap - rounding.gap;
        if (above && std::abs(here) <= kFlat * start) break;
        if (above && here > 0.0)
          low = at, lowSlope = here;
        else
          high = at, highSlope = std::min(here, 0.0);
      }
      if (!grew) return false;
      y = best;
    }
    x = y;
  }
  return x.across.norm() <= rounding.across + feature.wobble(x.view.n);
}

/// Ascends to the widest gap, from any start. True if there is a gap, and its gradient there is only
/// rounding.
template <typename Feature>
bool ascendFeature(const StpBv& body, const Feature& feature, AscentPoint& x, const Rounding& rounding,
                   int& pairs, int& steps) {
  return findGap(body, feature, x, rounding.gap, steps) &&
         ascendFrom(body, feature, x, rounding, pairs, steps);
}

}  // namespace fcl_stpbv::detail
