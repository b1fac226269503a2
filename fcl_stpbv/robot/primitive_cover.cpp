// Makes the STP-BV that covers a primitive: the ball itself, a spindle for a capsule, the corners of a box,
// or two polygons around a cylinder's ends, which contain the circles.
#include "fcl_stpbv/robot/primitive_cover.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/fitted_radii.h"

namespace fcl_stpbv::detail {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

// The primitive lies in the union of balls of radius `margin` around all points of the hull of `points`. This
// union exceeds it by at most `beyond`.
struct Skeleton {
  Points points;
  double margin = 0, beyond = 0;
};

// Adds the corners of a regular polygon around a circle, which touches the middles of its sides. So every
// point of the circle is a convex combination of two corners.
void addPolygon(double radius, double r, double z, Skeleton& skeleton) {
  constexpr int kFewest = 8, kMost = 64;
  constexpr double kPartOfMargin = 0.25;
  const double wanted = kPi / std::acos(radius / (radius + kPartOfMargin * r));
  const int corners = wanted < kMost ? std::max(kFewest, static_cast<int>(std::ceil(wanted))) : kMost;
  const double outer = radius / std::cos(kPi / corners);
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * kPi * k / corners;
    skeleton.points.emplace_back(outer * std::cos(angle), outer * std::sin(angle), z);
  }
  skeleton.beyond = outer - radius;
}

Skeleton skeletonOf(const fcl::CollisionGeometryd& primitive, double r) {
  Skeleton skeleton;
  switch (primitive.getNodeType()) {
    case fcl::GEOM_SPHERE:
      return {{Vector3d::Zero()}, static_cast<const fcl::Sphered&>(primitive).radius};
    case fcl::GEOM_CAPSULE: {
      const auto& capsule = static_cast<const fcl::Capsuled&>(primitive);
      return {{{0, 0, -capsule.lz / 2}, {0, 0, capsule.lz / 2}}, capsule.radius};
    }
    case fcl::GEOM_BOX:
      for (int corner = 0; corner < 8; ++corner)
        skeleton.points.push_back(
            Vector3d(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5)
                .cwiseProduct(static_cast<const fcl::Boxd&>(primitive).side));
      return skeleton;
    case fcl::GEOM_CYLINDER: {
      const auto& cylinder = static_cast<const fcl::Cylinderd&>(primitive);
      addPolygon(cylinder.radius, r, -cylinder.lz / 2, skeleton);
      addPolygon(cylinder.radius, r, cylinder.lz / 2, skeleton);
      return skeleton;
    }
    case fcl::GEOM_CONE: {
      const auto& cone = static_cast<const fcl::Coned&>(primitive);
      addPolygon(cone.radius, r, -cone.lz / 2, skeleton);
      skeleton.points.emplace_back(0, 0, cone.lz / 2);
      return skeleton;
    }
    default:
      return skeleton;
  }
}

}  // namespace

PrimitiveCover primitiveCover(const fcl::CollisionGeometryd& primitive, const StpBvOptions& radii) {
  const Skeleton skeleton = skeletonOf(primitive, radii.r);
  if (skeleton.points.empty()) return {};
  StpBvOptions own{skeleton.margin > 0 ? skeleton.margin : radii.r, radii.R};
  const double ball = StpBv::smallestR(skeleton.points, 0);
  // If R is below twice the smallest R, another R is fitted, because near the smallest R the surface is
  // almost a ball for any primitive.
  if (own.R < 2 * (own.r + ball)) own.R = std::max(2 * own.r, fittedR(ball, own.r));
  PrimitiveCover cover;
  cover.volume = StpBv::build(skeleton.points, own);
  cover.excess = overCover(*cover.volume, skeleton.points);
  // Support functions add up: that of the rounded skeleton is that of the skeleton plus the margin.
  cover.excess.max = std::max(0.0, cover.excess.max - skeleton.margin) + skeleton.beyond;
  cover.excess.mean = std::max(0.0, cover.excess.mean - skeleton.margin);
  return cover;
}

}  // namespace fcl_stpbv::detail
