// Let the 2x2 matrix W be the radii of curvature of a surface in the plane perpendicular to its normal: if
// the normal turns, its point moves by W times the turn. With A = W of body 1 and D = W of body 2 plus the
// distance,
//
//     turning = (A + D)^-1,   sliding = A (A + D)^-1,   rolling = A (A + D)^-1 D.
//
// 1. W is infinite along an edge and on a face, so it is kept as a fraction, radii / unit.
// 2. For 2x2 matrices adj(A + D) = adj A + adj D. So the inverse is a fraction of such terms, and no large
//    radius is subtracted from another. Faces and edges need no special cases.
// 3. The plane's frame is that in which the radii of the first body are given, or those of the second one if
//    the first is flat or round. Except for an ellipsoid its axes are principal directions. Then the largest
//    radius does not hide the smallest one by rounding.
// 4. For two features that are curved in both directions, one of them round, A + D is almost diagonal in such
//    a frame, and is inverted directly. With an overlap the sum may be small; squares of radii would hide it
//    by rounding.
#include "fcl_stpbv/distance/turning.h"

#include <Eigen/Geometry>
#include <cmath>

namespace fcl_stpbv::detail {

using Eigen::Matrix2d;
using Eigen::Vector2d;

namespace {

struct Curvature {
  Matrix2d radii;  // unit * W; along an edge the projection onto it, on a face zero
  double det;      // unit * det W; on a face 1
  double unit;     // 1, or 0 where W is infinite in some direction
};

Matrix2d adjugate(const Matrix2d& symmetric) {
  Matrix2d adj;
  adj << symmetric(1, 1), -symmetric(0, 1), -symmetric(0, 1), symmetric(0, 0);
  return adj;
}

/// The curvature of a feature, offset by a distance (m). `x` and `y` are its ways' coordinates in the frame.
Curvature curvatureOf(const NormalCone& cone, double offset, const Vector2d& x, const Vector2d& y) {
  if (cone.count == 0) return {Matrix2d::Zero(), 1.0, 0.0};
  const Vector2d edge(-x.y(), x.x());
  const double first = cone.along[0] + offset, second = cone.along[1] + offset;
  if (cone.count == 1) return {edge * edge.transpose(), first, 0.0};
  const Matrix2d mixed = x * y.transpose();
  return {first * x * x.transpose() + second * y * y.transpose() + cone.between * (mixed + mixed.transpose()),
          first * second - cone.between * cone.between, 1.0};
}

bool isRound(const NormalCone& cone) {
  return cone.count == 2 && cone.along[0] == cone.along[1] && cone.between == 0.0;
}

}  // namespace

bool Turning::set(const NormalCone& first, const NormalCone& second, double distance, double rounding) {
  if (first.count == 0 && second.count == 0) return false;
  const bool ofFirst = first.count > 0 && !(isRound(first) && second.count > 0);
  const NormalCone &own = ofFirst ? first : second, &other = ofFirst ? second : first;
  frame.col(0) = own.way[0];
  frame.col(1) = own.count == 2 ? own.way[1] : own.normal.cross(own.way[0]);
  const Curvature inOwn = curvatureOf(own, ofFirst ? 0.0 : distance, {1, 0}, {0, 1}),
                  seen = curvatureOf(other, ofFirst ? distance : 0.0, frame.transpose() * other.way[0],
                                     frame.transpose() * other.way[1]);
  const Curvature &a = ofFirst ? inOwn : seen, &d = ofFirst ? seen : inOwn;

  // A determinant below this fraction of its terms is rounding. For two edges, the determinant is the squared
  // sine of the angle between them.
  constexpr double kTold = 1e-14;
  const auto isTold = [rounding](double det, double terms, double trace) {
    return det > kTold * terms && trace >= 0.0 && det > rounding * trace;
  };
  if (own.count == 2 && isRound(other)) {
    const Matrix2d sum = a.radii + d.radii;
    const double det = sum.determinant();
    if (!isTold(det, std::abs(sum(0, 0) * sum(1, 1)) + sum(0, 1) * sum(0, 1), sum.trace())) return false;
    turning = adjugate(sum) / det;
    sliding = a.radii * turning;
    rolling = sliding * d.radii;
    return true;
  }
  const Matrix2d adjA = adjugate(a.radii), adjD = adjugate(d.radii);
  const double det = d.unit * a.det + a.unit * d.det + adjA.cwiseProduct(d.radii).sum(),
               trace = d.unit * a.radii.trace() + a.unit * d.radii.trace(),
               terms = d.unit * a.det + a.unit * std::abs(d.det) + a.radii.norm() * d.radii.norm();
  if (!isTold(det, terms, trace)) return false;
  turning = (d.unit * adjA + a.unit * adjD) / det;
  sliding = (d.unit * a.det * Matrix2d::Identity() + a.radii * adjD) / det;
  rolling = (a.det * d.radii + d.det * a.radii) / det;
  return true;
}

}  // namespace fcl_stpbv::detail
