// Independent answers for an STP-BV against a simple shape: long double, supports straight from each shape's
// definition, and halving of the remaining normals. No features, nothing shared with the library.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "fcl_stpbv/convex/shape.h"
#include "test/reference/reference.h"

namespace fcl_stpbv::test {

/// A posed convex core in world coordinates, by its support points, and the ball around it.
struct ReferenceShape {
  std::function<Vector3L(const Vector3L&)> support;
  long double margin = 0;
};

/// A shape to test with: what the library takes, and the reference of the same numbers. Owns its vertices.
struct TestShape {
  std::string name;
  Shape shape;
  std::shared_ptr<Cloud> vertices;
  ReferenceShape posed(const Eigen::Isometry3d& pose) const;
};

/// One of the bounded kinds, sizes drawn from `random`: sphere, capsule, box, triangle, convex, cylinder,
/// cone, ellipsoid; and a half space or a plane.
TestShape randomShape(const std::string& name, Random& random);
const std::vector<std::string>& boundedShapes();

/// Widest gap between the cores, less the margins. Exact while the cores are
/// apart; else only `overlap` says something.
struct ReferenceAnswer {
  long double distance;
  Vector3L normal;
  bool overlap;
};
ReferenceAnswer referenceDistance(const ReferenceBody& a, const ReferenceShape& b, const Vector3L& towards);
ReferenceAnswer referenceDistance(const ReferenceShape& a, const ReferenceShape& b, const Vector3L& towards);

/// Signed gap between the supporting planes with normal `n`, from a to b.
long double referenceGap(const ReferenceShape& a, const ReferenceShape& b, const Vector3L& n);

/// Widest gap over `count` directions, polished by shrinking random steps: for cores that overlap.
long double widestGapOverDirections(const ReferenceBody& a, const ReferenceShape& b, int count);
long double widestGapOverDirections(const ReferenceShape& a, const ReferenceShape& b, int count);

}  // namespace fcl_stpbv::test
