// Independent answers for an STP-BV and a simple shape: long double, supports directly from each shape's
// definition, and halving of the remaining normals. No features, and no code of the library.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "fcl_stpbv/convex/shape.h"
#include "test/reference/reference.h"

namespace fcl_stpbv::test {

/// A posed convex core in world coordinates, given by its support points, and its margin.
struct ReferenceShape {
  std::function<Vector3L(const Vector3L&)> support;
  long double margin = 0;
};

/// A shape for tests: the library's shape, and the reference with the same numbers. Owns its vertices.
struct TestShape {
  std::string name;
  Shape shape;
  std::shared_ptr<Cloud> vertices;
  ReferenceShape posed(const Eigen::Isometry3d& pose) const;
};

/// A shape with sizes drawn from `random`. Bounded kinds: sphere, capsule, box, triangle, convex, cylinder,
/// cone, ellipsoid. Also a half space or a plane.
TestShape randomShape(const std::string& name, Random& random);
const std::vector<std::string>& boundedShapes();

/// Widest gap between the cores, minus the margins. Exact while the cores are apart; otherwise only `overlap`
/// has a meaning.
struct ReferenceAnswer {
  long double distance;
  Vector3L normal;
  bool overlap;
};
ReferenceAnswer referenceDistance(const ReferenceBody& a, const ReferenceShape& b, const Vector3L& towards);
ReferenceAnswer referenceDistance(const ReferenceShape& a, const ReferenceShape& b, const Vector3L& towards);

/// Signed gap between the supporting planes with normal `n`, from a to b.
long double referenceGap(const ReferenceShape& a, const ReferenceShape& b, const Vector3L& n);

/// Widest gap over `count` directions, refined by random steps that shrink. For cores that overlap.
long double widestGapOverDirections(const ReferenceBody& a, const ReferenceShape& b, int count);
long double widestGapOverDirections(const ReferenceShape& a, const ReferenceShape& b, int count);

}  // namespace fcl_stpbv::test
