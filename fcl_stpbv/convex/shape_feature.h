// Finds the feature of a simple shape nearest to a point outside: a corner, an edge, a face, a rim or a side.
// In other words, in which feature's Voronoi region the point is (Mirtich 1998; Ericson, Real-Time Collision
// Detection, 5.1).
#pragma once

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/convex/shape.h"
#include "fcl_stpbv/packed.h"

namespace fcl_stpbv::detail {

/// A feature of a shape's core, and its point nearest to the given point. Frame of the shape.
struct ShapeFeature {
  enum class Kind {
    none,    ///< not known: a shape with many features, or a degenerate one
    inside,  ///< the point is in the core
    corner,  ///< one point
    line,    ///< an edge; with a radius, a cylinder's side
    face,    ///< flat
    rim,     ///< of a disc
    side,    ///< a generator of a cone
    whole    ///< an ellipsoid
  };
  Kind kind = Kind::none;
  int which = 0;      ///< number of the feature among those of the shape
  Packed point{};     ///< the nearest point; for a line with a radius, that of the axis; for a rim and an
                      ///< ellipsoid, the centre (m)
  Packed axis{};      ///< unit: along a line, a face's outward normal, a rim's axis, towards a cone's apex
  Packed apex{};      ///< of a cone (m)
  double radius = 0;  ///< of a rim, or around a line (m)
  double cosine = 0, sine = 0;  ///< components of a cone's outward normals across and along its axis
};

inline ShapeFeature featureOfBox(const Shape& box, const Packed& x) {
  const Packed half = pack(box.size);
  ShapeFeature f;
  int outside[3], sides = 0, axis = 0;
  for (int i = 0; i < 3; ++i) {
    outside[i] = x[i] > half[i] ? 1 : x[i] < -half[i] ? 2 : 0;
    f.which = 3 * f.which + outside[i];
    sides += outside[i] != 0;
  }
  using Kind = ShapeFeature::Kind;
  f.kind = Kind::inside;
  if (sides == 0) return f;
  // A face's normal is the only axis along which the point is outside. An edge is along the only axis along
  // which it is not.
  for (int i = 0; i < 3; ++i)
    if ((outside[i] != 0) == (sides == 1)) axis = i;
  f.kind = sides == 1 ? Kind::face : sides == 2 ? Kind::line : Kind::corner;
  f.point = -larger(-half, -larger(-half, x));
  f.axis[axis] = outside[axis] == 2 ? -1.0 : 1.0;
  return f;
}

/// For a segment and a cylinder.
inline ShapeFeature featureOfCylinder(const Shape& shape, const Packed& x) {
  using Kind = ShapeFeature::Kind;
  const bool beyond = std::abs(x[2]) > shape.half, segment = shape.kind == ShapeKind::segment,
             aside = x[0] * x[0] + x[1] * x[1] > shape.radius * shape.radius;
  const double z = std::min(std::max(x[2], -shape.half), shape.half);
  ShapeFeature f;
  f.which = !beyond ? 0 : x[2] > 0.0 ? 1 : 2;
  f.point = Packed{0, 0, z, 0};
  f.axis = Packed{0, 0, 1, 0};
  if (segment || aside) {
    f.kind = !beyond ? Kind::line : segment ? Kind::corner : Kind::rim;
    f.radius = segment ? 0.0 : shape.radius;
  } else if (beyond) {
    f.kind = Kind::face;
    f.which += 2;
    f.point = Packed{x[0], x[1], z, 0};
    if (x[2] < 0.0) f.axis = -f.axis;
  } else {
    f.kind = Kind::inside;
  }
  return f;
}

inline ShapeFeature featureOfCone(const Shape& cone, const Packed& x) {
  using Kind = ShapeFeature::Kind;
  const double away = std::sqrt(x[0] * x[0] + x[1] * x[1]), height = 2.0 * cone.half,
               slant = std::sqrt(cone.radius * cone.radius + height * height), below = cone.half - x[2];
  ShapeFeature f;
  f.axis = Packed{0, 0, 1, 0};
  f.point = Packed{0, 0, -cone.half, 0};
  f.radius = cone.radius;
  if (below > height && away <= cone.radius) {
    f.kind = Kind::face;
    f.axis = -f.axis;
    f.point = Packed{x[0], x[1], -cone.half, 0};
    return f;
  }
  if (!(slant > 0.0)) return f;
  f.cosine = height / slant;
  f.sine = cone.radius / slant;
  const double along = f.sine * away + f.cosine * below;
  const bool out = f.cosine * away - f.sine * below > 0.0;  // outside the side
  if (!out && below >= 0.0 && below <= height && away <= cone.radius) {
    f.kind = Kind::inside;
    return f;
  }
  if (!out && below > height)
    f.kind = Kind::rim;  // below the base and outside its disc
  else
    f.kind = along <= 0.0 ? Kind::corner : along < slant ? Kind::side : Kind::rim;
  f.which = static_cast<int>(f.kind);
  if (f.kind == Kind::corner) f.point = Packed{0, 0, cone.half, 0};
  if (f.kind == Kind::side) {
    const double scale = f.sine * along / std::max(away, 1e-300);
    f.point = Packed{scale * x[0], scale * x[1], cone.half - f.cosine * along, 0};
    f.apex = Packed{0, 0, cone.half, 0};
  }
  return f;
}

inline ShapeFeature featureOfTriangle(const Shape& triangle, const Packed& x) {
  using Kind = ShapeFeature::Kind;
  ShapeFeature f;
  Packed p[3], side[3];
  bool before[3], behind[3];  // whether `x` is before the side's start, and past its end
  for (std::size_t i = 0; i < 3; ++i) p[i] = pack(triangle.corner[i]);
  for (int i = 0; i < 3; ++i) {
    const Packed& end = p[(i + 1) % 3];
    side[i] = end - p[i];
    before[i] = !(dot(x - p[i], side[i]) > 0.0);
    behind[i] = !(dot(x - end, side[i]) < 0.0);
  }
  for (int i = 0; i < 3; ++i)
    if (before[i] && behind[(i + 2) % 3]) {
      f.kind = Kind::corner;
      f.which = i;
      f.point = p[i];
      return f;
    }
  const auto unit = [](const Packed& v) { return v / std::sqrt(std::max(dot(v, v), 1e-300)); };
  const Packed up = cross(side[0], side[1]);
  for (int i = 0; i < 3; ++i) {
    const Packed from = x - p[i];
    if (before[i] || behind[i] || dot(cross(up, side[i]), from) > 0.0) continue;
    f.kind = Kind::line;
    f.which = 3 + i;
    f.axis = unit(side[i]);
    f.point = p[i] + dot(from, f.axis) * f.axis;
    return f;
  }
  const Packed normal = unit(up);
  const double height = dot(normal, x - p[0]);
  f.kind = Kind::face;
  f.which = height > 0.0 ? 6 : 7;
  f.axis = height > 0.0 ? normal : -normal;
  f.point = x - height * normal;
  return f;
}

/// The kind is `none` for an ellipsoid without thickness.
inline ShapeFeature featureOfEllipsoid(const Shape& ellipsoid, const Packed& x) {
  const Packed size = pack(ellipsoid.size), scaled = x / size;
  ShapeFeature f;
  if (ellipsoid.size.minCoeff() > 0.0)
    f.kind = dot(scaled, scaled) > 1.0 ? ShapeFeature::Kind::whole : ShapeFeature::Kind::inside;
  return f;
}

/// The feature nearest to `x`, for shapes that have few features.
inline ShapeFeature nearestFeature(const Shape& shape, const Packed& x) {
  switch (shape.kind) {
    case ShapeKind::point: {
      ShapeFeature f;
      f.kind = ShapeFeature::Kind::corner;
      return f;
    }
    case ShapeKind::segment:
    case ShapeKind::cylinder:
      return featureOfCylinder(shape, x);
    case ShapeKind::box:
      return featureOfBox(shape, x);
    case ShapeKind::triangle:
      return featureOfTriangle(shape, x);
    case ShapeKind::cone:
      return featureOfCone(shape, x);
    case ShapeKind::ellipsoid:
      return featureOfEllipsoid(shape, x);
    case ShapeKind::polytope:
    case ShapeKind::halfspace:
    case ShapeKind::plane:
      break;
  }
  return {};
}

/// The vector to `x` from the core's nearest point, which is on the feature `f` found by nearestFeature().
/// Not for an ellipsoid. Its relative accuracy is full even if the vector is very short.
inline Packed wayFrom(const ShapeFeature& f, const Packed& x) {
  using Kind = ShapeFeature::Kind;
  const Packed from = x - (f.kind == Kind::side ? f.apex : f.point);
  if (f.kind == Kind::corner || f.kind == Kind::face) return from;
  const Packed along = dot(from, f.axis) * f.axis, out = from - along;
  const double length = std::sqrt(dot(out, out));
  const Packed outward = length > 0.0 ? Packed(out / length) : Packed{};
  if (f.kind == Kind::side) {
    const Packed normal = f.cosine * outward + f.sine * f.axis;
    return dot(from, normal) * normal;
  }
  const Packed across = (length - f.radius) * outward;
  return f.kind == Kind::rim ? along + across : across;
}

}  // namespace fcl_stpbv::detail
