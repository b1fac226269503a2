// Encloses the true distance of two volumes along an answer's normal, with as many digits as needed: long
// double if 1e-19 of R is negligible compared with a certificate's width, 113 bits otherwise, and a hundred
// digits for a sample.
#pragma once

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <limits>

#include "fcl_stpbv/distance/distance.h"
#include "test/reference/reference_of.h"

namespace fcl_stpbv::test {

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;
using Hundred =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

/// `least` <= true value <= `most`, each up to `slack`, which comes from rounding.
template <class Real>
struct Enclosure {
  Real least, most;
  double slack;

  bool holdsLower(double lower) const { return Real(lower) <= most + slack; }
  bool holdsUpper(double upper) const { return Real(upper) >= least - slack; }
  double width() const { return static_cast<double>(most - least) + 2 * slack; }
};

/// Accuracy of supports of bodies of this size: 16 roundings of R and of the coordinates for each body, and
/// as many again in their sum.
template <class Real>
double roundings(double size) {
  return 64 * static_cast<double>(std::numeric_limits<Real>::epsilon()) * size;
}

/// A cloud, its radii and its pose in a query.
struct Placed {
  const Cloud& cloud;
  double r, R;
  const Eigen::Isometry3d& pose;
};

/// The body relative to `origin`. Far from the world's origin only the difference of the origins matters, and
/// it is exact there.
template <class Real>
ReferenceBodyOf<Real> seenFrom(const Eigen::Vector3d& origin, const Placed& placed) {
  Eigen::Isometry3d turn = placed.pose;
  turn.translation().setZero();
  ReferenceBodyOf<Real> body = bodyOf<Real>(placed.cloud, placed.r, placed.R, turn);
  const Vector3Of<Real> at = placed.pose.translation().cast<Real>() - origin.cast<Real>();
  for (Vector3Of<Real>& p : body.points) p += at;
  return body;
}

/// Encloses the true value along the answer's normal, between the gap of the two supporting planes and the
/// distance of the core points. If that is wider than `fine` and `search` is set, the reference's search
/// narrows it.
template <class Real>
Enclosure<Real> enclose(const Distance& d, const Placed& first, const Placed& second, double fine,
                        bool search) {
  // Answers are nearer to the true normal than this (rad).
  constexpr double kNearby = 1e-3;
  const Eigen::Vector3d origin = first.pose.translation();
  const auto a = seenFrom<Real>(origin, first), b = seenFrom<Real>(origin, second);
  const double size = first.R + second.R + first.cloud[0].norm() + second.cloud[0].norm() +
                      (second.pose.translation() - origin).norm();
  const Vector3Of<Real> n = d.normal.cast<Real>().normalized();
  Vector3Of<Real> x, y;
  const Real gap = -supportOf<Real>(a, n, &x) - supportOf<Real>(b, Vector3Of<Real>(-n), &y);
  Enclosure<Real> truth{gap, (y - x).norm() - a.r - b.r, roundings<Real>(size)};
  if (search && !(truth.most - truth.least <= Real(fine))) {
    const auto found = distanceOf<Real>(a, b, n, Real(fine), kNearby);
    // Without a plane between the cores the search gives no result.
    if (found.distance >= truth.least) {
      truth.least = found.distance;
      truth.most = std::min<Real>(truth.most, found.distance + found.gap);
    }
  }
  return truth;
}

}  // namespace fcl_stpbv::test
