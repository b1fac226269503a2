// FCL's own distance, unsigned, for pairs that this library has no answer to, kept from what FCL does not
// survive.
#include "fcl_stpbv/adapter/fcl_fallback.h"

#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/distance.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif

#include <algorithm>
#include <cmath>
#include <utility>

#include "fcl_stpbv/adapter/fcl_shapes.h"

namespace fcl_stpbv {
namespace {

// FCL's default of 1e-6 leaves up to 2 % of answers off by more than that; this costs at most 3 % more time.
constexpr double kTolerance = 1e-10;
// Witness points that do not span the distance to this part of it are not witness points.
constexpr double kConsistent = 1e-6;

/// A mesh with a root, whose corners are numbers: libccd asserts on what is none.
template <typename BV>
bool isSoundMesh(const fcl::CollisionGeometryd& geometry) {
  const auto& mesh = static_cast<const fcl::BVHModel<BV>&>(geometry);
  if (!(mesh.getNumBVs() > 0) || !mesh.vertices) return false;
  return std::all_of(mesh.vertices, mesh.vertices + mesh.num_vertices,
                     [](const Eigen::Vector3d& p) { return p.allFinite(); });
}

/// A shape of finite sizes, none negative. FCL divides by an ellipsoid's.
bool isSoundShape(const fcl::CollisionGeometryd& geometry) {
  Shape shape;
  if (!shapeOf(geometry, shape) || !shape.valid()) return false;
  return shape.kind != ShapeKind::ellipsoid || shape.size.minCoeff() > 0.0;
}

/// FCL dereferences null for half of its types: it has no support function for planes and half spaces, and no
/// root for empty meshes and trees. Of meshes it measures these three. libccd ends the process where a number
/// is none.
bool fclSurvives(const fcl::CollisionGeometryd& geometry) {
  switch (geometry.getNodeType()) {
    case fcl::GEOM_BOX:
    case fcl::GEOM_SPHERE:
    case fcl::GEOM_ELLIPSOID:
    case fcl::GEOM_CAPSULE:
    case fcl::GEOM_CONE:
    case fcl::GEOM_CYLINDER:
    case fcl::GEOM_CONVEX:
      return isSoundShape(geometry);
    case fcl::BV_RSS:
      return isSoundMesh<fcl::RSSd>(geometry);
    case fcl::BV_kIOS:
      return isSoundMesh<fcl::kIOSd>(geometry);
    case fcl::BV_OBBRSS:
      return isSoundMesh<fcl::OBBRSSd>(geometry);
#if FCL_HAVE_OCTOMAP
    case fcl::GEOM_OCTREE:
      return static_cast<const fcl::OcTreed&>(geometry).getRoot() != nullptr;
#endif
    default:
      return false;
  }
}

/// Derivative of the distance for a body that carries the witness point `x` along `n` (paper eq. 2).
TwistGradient twistGradient(const Eigen::Vector3d& n, const Eigen::Vector3d& x,
                            const Eigen::Vector3d& origin) {
  TwistGradient g;
  g << n, (x - origin).cross(n);
  return g;
}

}  // namespace

DistanceAnswer fallbackDistance(const fcl::CollisionGeometryd& geometry1, const fcl::Transform3d& pose1,
                                const fcl::CollisionGeometryd& geometry2, const fcl::Transform3d& pose2) {
  DistanceAnswer answer;
  answer.geometry = {&geometry1, &geometry2};
  if (!fclSurvives(geometry1) || !fclSurvives(geometry2)) return answer;

  // Never signed: FCL's asserts would end the process on a part of the overlapping pairs. Never the caller's
  // result: a reused one only gets smaller.
  const fcl::DistanceRequestd request(/*enable_nearest_points=*/true, /*enable_signed_distance=*/false, 0.0,
                                      0.0, kTolerance, fcl::GST_LIBCCD);
  fcl::DistanceResultd result;
  result.nearest_points[0].setConstant(std::numeric_limits<double>::quiet_NaN());
  result.nearest_points[1].setConstant(std::numeric_limits<double>::quiet_NaN());
  try {
    fcl::distance(&geometry1, pose1, &geometry2, pose2, request, result);
  } catch (...) {  // FCL gave up on this configuration: nothing is known
    answer.status = DistanceStatus::bounded;
    answer.distance = 0;
    return answer;
  }
  const double d = result.min_distance;
  if (!(d < std::numeric_limits<double>::max())) return answer;  // FCL has no function for this pair of types

  answer.status = DistanceStatus::bounded;
  if (!(d > 0)) {  // -1: overlapping, or its cap on iterations
    answer.distance = answer.upper = 0;
    return answer;
  }
  answer.distance = answer.upper = d;
  answer.lower = 0;  // FCL errs upwards only, by stopping early; how far is not known
  // FCL swaps a mesh and a shape, and its result with them.
  if (result.o1 == &geometry2 && &geometry1 != &geometry2)
    std::swap(result.nearest_points[0], result.nearest_points[1]);
  const Eigen::Vector3d p = result.nearest_points[0], q = result.nearest_points[1];
  if (!(std::abs((q - p).norm() - d) <= kConsistent * d)) return answer;
  answer.points = {p, q};
  answer.normal = (q - p) / d;
  answer.gradient = {twistGradient(-answer.normal, p, pose1.translation()),
                     twistGradient(answer.normal, q, pose2.translation())};
  return answer;
}

}  // namespace fcl_stpbv
