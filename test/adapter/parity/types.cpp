// FCL's types with their convex pieces, and the true answer for two of them: the least distance over all
// pairs of pieces, pairs with the nearest balls first. Half spaces and planes have closed forms here.
// triangles.h handles two triangles, shape_reference.h everything else.
#include "test/adapter/parity/types.h"

#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "test/adapter/element_kinds.h"

namespace fcl_stpbv::parity {

using namespace test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

Type shapeType(const std::string& name, std::shared_ptr<fcl::CollisionGeometryd> geometry,
               const TestShape& shape) {
  return {name, std::move(geometry), false, [shape](const Isometry3d& pose) {
            Piece piece;
            piece.shape = shape.posed(pose);
            piece.centre = (pose * shape.shape.centre).cast<long double>();
            piece.radius = shape.shape.reach + shape.shape.margin + 1e-9;
            return std::vector<Piece>{piece};
          }};
}

/// The convex hull of some triangles' corners.
Piece hullOf(std::intptr_t id, const std::vector<TriangleL>& triangles) {
  std::vector<Vector3L> corners;
  for (const TriangleL& t : triangles) corners.insert(corners.end(), t.begin(), t.end());
  Piece piece;
  piece.id = id;
  if (triangles.size() == 1) piece.triangle = triangles[0];
  piece.centre = Vector3L::Zero();
  for (const Vector3L& c : corners) piece.centre += c / static_cast<long double>(corners.size());
  for (const Vector3L& c : corners) piece.radius = std::max(piece.radius, (c - piece.centre).norm());
  piece.shape.support = [corners](const Vector3L& d) {
    return *std::max_element(corners.begin(), corners.end(),
                             [&](const Vector3L& p, const Vector3L& q) { return d.dot(p) < d.dot(q); });
  };
  return piece;
}

Type elementType(const ElementKind& kind) {
  return {kind.name, kind.geometry, true, [triangles = kind.triangles](const Isometry3d& pose) {
            std::vector<Piece> all;
            for (const auto& [id, t] : triangles(pose)) all.push_back(hullOf(id, t));
            return all;
          }};
}

Type flatType(const std::string& name, std::shared_ptr<fcl::CollisionGeometryd> geometry, double offset) {
  return {name, std::move(geometry), false, [name, offset](const Isometry3d& pose) {
            Piece piece;
            piece.unbounded = true;
            piece.thin = name == "plane";
            piece.normal = pose.linear().col(2).cast<long double>().normalized();
            piece.offset = offset + piece.normal.dot(pose.translation().cast<long double>());
            return std::vector<Piece>{piece};
          }};
}

/// The signed distance of two pieces. `overlap` is set if only that is known.
ReferenceAnswer distanceOf(const Piece& a, const Piece& b) {
  if (a.unbounded && b.unbounded) return {0, a.normal, true};  // no two of them are parallel in this test
  if (a.unbounded || b.unbounded) {
    const Piece &flat = a.unbounded ? a : b, &other = a.unbounded ? b : a;
    const auto height = [&](const Vector3L& n) { return n.dot(other.shape.support(n)) + other.shape.margin; };
    const long double above = -height(-flat.normal) - flat.offset;
    const long double below = flat.offset - height(flat.normal);
    return {flat.thin ? std::max(above, below) : above, flat.normal, false};
  }
  if (a.triangle && b.triangle) return {test::referenceDistance(*a.triangle, *b.triangle), a.normal, false};
  const Vector3L way = b.centre - a.centre;
  return referenceDistance(a.shape, b.shape, way.norm() > 0 ? way : Vector3L(0, 0, 1));
}

long double ballGap(const Piece& a, const Piece& b) {
  if (a.unbounded || b.unbounded) return -std::numeric_limits<long double>::infinity();
  return (b.centre - a.centre).norm() - a.radius - b.radius;
}

}  // namespace

std::vector<Type> allTypes() {
  std::vector<Type> all;
  const auto shape = [&](const std::string& name, auto geometry, const Shape& known,
                         std::shared_ptr<Cloud> vertices = nullptr) {
    all.push_back(shapeType(name, geometry, TestShape{name, known, std::move(vertices)}));
  };
  const Vector3d sides(0.3, 0.2, 0.4), axes(0.1, 0.2, 0.15);
  const auto corners = std::make_shared<Cloud>(box(sides.x(), sides.y(), sides.z()));
  const auto points = std::make_shared<Cloud>(randomHull(40, axes, 5));
  const auto triangle = std::make_shared<Cloud>(Cloud{{0.2, 0, 0}, {-0.1, 0.2, 0}, {0, -0.2, 0.1}});
  const Cloud& t = *triangle;
  shape("sphere", std::make_shared<fcl::Sphered>(0.2), Shape::sphere(0.2));
  shape("capsule", std::make_shared<fcl::Capsuled>(0.1, 0.3), Shape::capsule(0.1, 0.3));
  shape("ellipsoid", std::make_shared<fcl::Ellipsoidd>(axes), Shape::ellipsoidOf(axes));
  shape("box", std::make_shared<fcl::Boxd>(sides), Shape::boxOf(sides), corners);
  shape("cylinder", std::make_shared<fcl::Cylinderd>(0.1, 0.3), Shape::cylinderOf(0.1, 0.3));
  shape("cone", std::make_shared<fcl::Coned>(0.1, 0.3), Shape::coneOf(0.1, 0.3));
  shape("convex", detail::hullGeometry(*points),
        Shape::polytopeOf(points->data(), static_cast<int>(points->size())), points);
  shape("triangle", std::make_shared<fcl::TrianglePd>(t[0], t[1], t[2]), Shape::triangleOf(t[0], t[1], t[2]),
        triangle);
  all.push_back(flatType("halfspace", std::make_shared<fcl::Halfspaced>(Vector3d::UnitZ(), 0.1), 0.1));
  all.push_back(flatType("plane", std::make_shared<fcl::Planed>(Vector3d::UnitZ(), 0.1), 0.1));
  for (const ElementKind& kind : elementKinds())
    if (kind.surface) all.push_back(elementType(kind));
  return all;
}

Truth truthOf(const std::vector<Piece>& a, const std::vector<Piece>& b, bool allMeeting) {
  std::vector<std::pair<long double, std::pair<const Piece*, const Piece*>>> order;
  for (const Piece& p : a)
    for (const Piece& q : b) order.push_back({ballGap(p, q), {&p, &q}});
  std::sort(order.begin(), order.end());
  Truth truth;
  long double least = std::numeric_limits<long double>::infinity();
  for (const auto& [bound, pair] : order) {
    if (bound > least || (!allMeeting && truth.overlap)) break;
    const ReferenceAnswer found = distanceOf(*pair.first, *pair.second);
    const long double d = found.overlap ? 0 : found.distance;
    least = std::min(least, std::max(d, 0.0L));
    if (d <= 0) {
      if (!truth.overlap) truth.distance = static_cast<double>(d);
      truth.overlap = true;
      truth.meeting.push_back({pair.first->id, pair.second->id});
    }
  }
  if (!truth.overlap) truth.distance = static_cast<double>(least);
  std::sort(truth.meeting.begin(), truth.meeting.end());
  return truth;
}

double distanceOf(const std::vector<Piece>& pieces, const Vector3d& point) {
  if (!point.allFinite()) return std::numeric_limits<double>::infinity();
  Piece dot;
  dot.centre = point.cast<long double>();
  dot.shape.support = [p = dot.centre](const Vector3L&) { return p; };
  return std::max(0.0, truthOf(pieces, {dot}).distance);
}

std::vector<Piece> only(const std::vector<Piece>& pieces, std::intptr_t id) {
  for (const Piece& piece : pieces)
    if (piece.id == id) return {piece};
  return pieces;
}

double gapAlong(const std::vector<Piece>& a, const std::vector<Piece>& b, const Vector3d& n) {
  return static_cast<double>(referenceGap(a[0].shape, b[0].shape, n.cast<long double>().normalized()));
}

double widestGap(const std::vector<Piece>& a, const std::vector<Piece>& b) {
  return static_cast<double>(widestGapOverDirections(a[0].shape, b[0].shape, 500));
}

}  // namespace fcl_stpbv::parity
