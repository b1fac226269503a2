// An independent answer to check every query against: long double, straight from the definition, no topology.
//
// A volume is the intersection of all balls of radius R that hold the margin spheres
// (docs/theory.md, 1), so its support is h(n) = R + min n.C over the centres C within rho = R - r of
// every point. That minimum has at most three active points and is found by adding the point its
// ball misses most. Nothing here is shared with the library.
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

/// The nearest rotation to a matrix next to one: its polar factor, by Newton's iteration (Higham 1986), whose
/// error is squared each time.
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

/// Support value along the unit vector `n`; the core's point there (the surface's less `r n`) goes to
/// `corePoint`. Good to about 1e-19 (|p| + R).
long double referenceSupport(const ReferenceBody& body, const Vector3L& n, Vector3L* corePoint = nullptr);

template <class Real>
struct ReferenceDistanceOf {
  Real distance;  ///< signed gap along `normal`: a lower bound of the signed distance, whatever `normal` is
  Real gap;       ///< what the distance of the core points allows beyond that: the proof that it is right
  Vector3Of<Real> normal;    ///< unit, from a to b
  Vector3Of<Real> point[2];  ///< witness points on the surfaces
};
using ReferenceDistance = ReferenceDistanceOf<long double>;

/// The distance of two volumes whose cores are apart along `towards`, any rough direction from a to b with
/// that property: a plane cut through the middle of the normals still possible, in the gnomonic plane of
/// `towards`, until they are one to rounding. The answer proves itself by its `gap`.
ReferenceDistance referenceDistance(const ReferenceBody& a, const ReferenceBody& b, const Vector3L& towards);

/// Signed gap between the supporting planes with normal `n`, from a to b (docs/theory.md, 5).
long double referenceGap(const ReferenceBody& a, const ReferenceBody& b, const Vector3L& n);

/// The widest gap over a dense set of `count` directions: what the best separating translation is compared to
/// where the bodies are deep in each other.
long double widestGapOverDirections(const ReferenceBody& a, const ReferenceBody& b, int count);

}  // namespace fcl_stpbv::test
