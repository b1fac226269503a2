// An independent answer for every query: long double, directly from the definition, without topology.
//
// A volume is the intersection of all balls of radius R that contain the margin spheres (docs/theory.md, 1).
// So its support is h(n) = R + min n.C over the centres C within rho = R - r of every point. That minimum has
// at most three active points. It is found by adding, again and again, the point that its ball misses by
// most. The code shares nothing with the library.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "test/reference/shapes.h"

namespace fcl_stpbv::test {

template <class Real>
using Vector3Of = Eigen::Matrix<Real, 3, 1>;
using Vector3L = Vector3Of<long double>;
using Matrix3L = Eigen::Matrix<long double, 3, 3>;

/// The rotation nearest to a matrix that is almost a rotation: its polar factor, by Newton's iteration
/// (Higham 1986), which squares the error in each step.
Matrix3L nearestRotation(const Eigen::Matrix3d& m);

/// A volume's points in world coordinates and its radii (m). Numbers of other precision
/// than long double are for reference_of.h.
template <class Real>
struct ReferenceBodyOf {
  std::vector<Vector3Of<Real>> points;
  Real r;
  Real R;
};
using ReferenceBody = ReferenceBodyOf<long double>;

ReferenceBody referenceBody(const Cloud& points, double r, double R,
                            const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity());

/// Support value along the unit vector `n`. `corePoint` receives the core's point there (the surface's point
/// minus `r n`). Accurate to about 1e-19 (|p| + R).
long double referenceSupport(const ReferenceBody& body, const Vector3L& n, Vector3L* corePoint = nullptr);

template <class Real>
struct ReferenceDistanceOf {
  Real distance;  ///< signed gap along `normal`: a lower bound on the signed distance for any `normal`
  Real gap;       ///< how much larger the distance of the core points is: the proof that `distance` is right
  Vector3Of<Real> normal;    ///< unit, from a to b
  Vector3Of<Real> point[2];  ///< witness points on the surfaces
};
using ReferenceDistance = ReferenceDistanceOf<long double>;

/// The distance of two volumes whose cores are apart along `towards`, a rough direction from a to b. Planes
/// cut the set of remaining normals through its middle, in the gnomonic plane of `towards`, until it is a
/// single normal to rounding. The answer's `gap` proves it.
ReferenceDistance referenceDistance(const ReferenceBody& a, const ReferenceBody& b, const Vector3L& towards);

/// Signed gap between the supporting planes with normal `n`, from a to b (docs/theory.md, 5).
long double referenceGap(const ReferenceBody& a, const ReferenceBody& b, const Vector3L& n);

/// The widest gap over a dense set of `count` directions. The best separating translation of bodies that are
/// deep in each other is compared with it.
long double widestGapOverDirections(const ReferenceBody& a, const ReferenceBody& b, int count);

}  // namespace fcl_stpbv::test
