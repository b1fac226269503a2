// reference_of.h for long double. A rotation is made orthogonal by Newton's iteration. The widest gap is
// searched along a Fibonacci spiral of directions.
#include "test/reference/reference.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "test/reference/reference_of.h"

namespace fcl_stpbv::test {

Matrix3L nearestRotation(const Eigen::Matrix3d& m) {
  Matrix3L rotation = m.cast<long double>();
  for (int i = 0; i < 5; ++i) rotation = Matrix3L((rotation + rotation.inverse().transpose()) / 2);
  return rotation;
}

ReferenceBody referenceBody(const Cloud& points, double r, double R, const Eigen::Isometry3d& pose) {
  return bodyOf<long double>(points, r, R, pose);
}

long double referenceSupport(const ReferenceBody& body, const Vector3L& n, Vector3L* corePoint) {
  return supportOf(body, n, corePoint);
}

long double referenceGap(const ReferenceBody& a, const ReferenceBody& b, const Vector3L& n) {
  return -referenceSupport(a, n) - referenceSupport(b, -n);
}

ReferenceDistance referenceDistance(const ReferenceBody& a, const ReferenceBody& b, const Vector3L& towards) {
  return distanceOf(a, b, towards);
}

long double widestGapOverDirections(const ReferenceBody& a, const ReferenceBody& b, int count) {
  long double best = -std::numeric_limits<long double>::infinity();
  const long double golden = std::acos(-1.0L) * (3 - std::sqrt(5.0L));
  for (int i = 0; i < count; ++i) {  // Fibonacci spiral
    const long double z = 1 - (2 * i + 1) / static_cast<long double>(count), w = std::sqrt(1 - z * z);
    const Vector3L n(w * std::cos(golden * i), w * std::sin(golden * i), z);
    best = std::max(best, referenceGap(a, b, n));
  }
  return best;
}

}  // namespace fcl_stpbv::test
