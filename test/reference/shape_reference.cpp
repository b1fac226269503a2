// 1. A shape's furthest point comes from its numbers or its vertices.
// 2. Cores apart: the gap along a normal tells in which half of the normals better ones are. The other half
// is cut off until no normals are left.
// 3. Cores overlapping: a Fibonacci spiral of normals; the best normal is refined by random steps that
// shrink.
#include "test/reference/shape_reference.h"

#include <cmath>
#include <limits>

#include "test/reference/normal_polygon.h"

namespace fcl_stpbv::test {

namespace {
using Matrix3L = Eigen::Matrix<long double, 3, 3>;

/// Furthest point of a shape along `d` in its own frame, from the shape's numbers.
Vector3L furthest(const TestShape& test, const Vector3L& d) {
  const Shape& s = test.shape;
  const long double across = std::sqrt(d.x() * d.x() + d.y() * d.y());
  const long double radius = s.radius, half = s.half;
  const Vector3L rim(across > 0 ? radius * d.x() / across : radius, across > 0 ? radius * d.y() / across : 0,
                     0);
  if (test.name == "sphere") return Vector3L(0, 0, 0);
  if (test.name == "capsule") return Vector3L(0, 0, d.z() < 0 ? -half : half);
  if (test.name == "cylinder") return rim + Vector3L(0, 0, d.z() < 0 ? -half : half);
  if (test.name == "cone") {
    const Vector3L top(0, 0, half), low = rim - Vector3L(0, 0, half);
    return d.dot(top) > d.dot(low) ? top : low;
  }
  if (test.name == "ellipsoid") {
    const Vector3L e = s.size.cast<long double>().cwiseProduct(d);
    return s.size.cast<long double>().cwiseProduct(e) / e.norm();
  }
  const Eigen::Vector3d* best = nullptr;
  for (const Eigen::Vector3d& p : *test.vertices)
    if (!best || d.dot(p.cast<long double>()) > d.dot(best->cast<long double>())) best = &p;
  return best->cast<long double>();
}

/// A normal that was tried: the gap of the cores along it, and the difference of the points that determine
/// it.
struct Trial {
  Vector3L n, difference;
  long double gap;
};

/// The widest gap, by halving the remaining normals in the gnomonic plane of the first one.
template <typename Look>
ReferenceAnswer widestGap(const Look& look, long double margins, const Vector3L& towards) {
  Trial x = look(towards.normalized());
  Trial best = x;
  const Vector3L z = x.gap > 0 ? x.n : x.difference.normalized();
  NormalPolygon left(z, 1e4L);
  for (int i = 0; i < 300; ++i) {
    if (!left.cut(x.gap > 0 ? Vector3L(x.difference - x.difference.dot(x.n) * x.n) : x.difference)) break;
    x = look(left.centre().normalized());
    if (x.gap > best.gap) best = x;
    // The remaining normals can increase the gap by at most their width times the farthest lever.
    if (left.size() * x.difference.norm() < 1e-16L * left.centre().squaredNorm()) break;
  }
  return {best.gap - margins, best.n, !(best.gap > 0)};
}

/// The widest gap over a Fibonacci spiral of normals, refined by random steps that shrink.
template <typename Gap>
long double widestOver(const Gap& gap, int count) {
  long double best = -std::numeric_limits<long double>::infinity();
  Vector3L top(0, 0, 1);
  const long double golden = std::acos(-1.0L) * (3 - std::sqrt(5.0L));
  for (int i = 0; i < count; ++i) {  // Fibonacci spiral
    const long double z = 1 - (2 * i + 1) / static_cast<long double>(count), w = std::sqrt(1 - z * z);
    const Vector3L n(w * std::cos(golden * i), w * std::sin(golden * i), z);
    if (gap(n) > best) best = gap(n), top = n;
  }
  Random random(7);
  for (long double step = 3 / std::sqrt(static_cast<long double>(count)); step > 1e-9L; step *= 0.7L)
    for (int i = 0; i < 12; ++i) {
      const Vector3L n = (top + step * random.direction().cast<long double>()).normalized();
      if (gap(n) > best) best = gap(n), top = n;
    }
  return best;
}

}  // namespace

const std::vector<std::string>& boundedShapes() {
  static const std::vector<std::string> names{"sphere", "capsule",  "box",  "triangle",
                                              "convex", "cylinder", "cone", "ellipsoid"};
  return names;
}

TestShape randomShape(const std::string& name, Random& random) {
  const auto size = [&] { return std::exp(random.uniform(std::log(0.02), std::log(0.6))); };
  TestShape t{name, {}, std::make_shared<Cloud>()};
  if (name == "sphere") t.shape = Shape::sphere(size());
  if (name == "capsule") t.shape = Shape::capsule(size(), size());
  if (name == "cylinder") t.shape = Shape::cylinderOf(size(), size());
  if (name == "cone") t.shape = Shape::coneOf(size(), size());
  if (name == "ellipsoid") t.shape = Shape::ellipsoidOf({size(), size(), size()});
  if (name == "halfspace") t.shape = Shape::halfspaceOf(random.direction(), random.uniform(-0.3, 0.3));
  if (name == "plane") t.shape = Shape::planeOf(random.direction(), random.uniform(-0.3, 0.3));
  if (name == "box") {
    const Eigen::Vector3d sides(size(), size(), size());
    t.shape = Shape::boxOf(sides);
    *t.vertices = box(sides.x(), sides.y(), sides.z());
  }
  if (name == "triangle") {
    *t.vertices = randomHull(3, {size(), size(), size()}, static_cast<std::uint64_t>(random.below(1 << 30)));
    t.shape = Shape::triangleOf((*t.vertices)[0], (*t.vertices)[1], (*t.vertices)[2]);
  }
  if (name == "convex") {
    const int kind = random.below(3);
    *t.vertices = kind == 0   ? geodesicSphere(size(), 1)
                  : kind == 1 ? cylinder(size(), size(), 12)
                              : randomHull(20, {size(), size(), size()},
                                           static_cast<std::uint64_t>(random.below(1 << 30)));
    t.shape = Shape::polytopeOf(t.vertices->data(), static_cast<int>(t.vertices->size()));
  }
  return t;
}

ReferenceShape TestShape::posed(const Eigen::Isometry3d& pose) const {
  Matrix3L rotation = pose.linear().cast<long double>();
  for (int i = 0; i < 4; ++i) rotation = (rotation * 3 - rotation * rotation.transpose() * rotation) / 2;
  const Vector3L translation = pose.translation().cast<long double>();
  const TestShape self = *this;
  return {[=](const Vector3L& d) -> Vector3L {
            return rotation * furthest(self, rotation.transpose() * d) + translation;
          },
          shape.margin};
}

ReferenceAnswer referenceDistance(const ReferenceBody& a, const ReferenceShape& b, const Vector3L& towards) {
  const auto look = [&](const Vector3L& n) {
    Vector3L ya;
    const long double h = referenceSupport(a, n, &ya) - a.r;
    const Vector3L yb = b.support(-n);
    return Trial{n, yb - ya, n.dot(yb) - h};
  };
  return widestGap(look, a.r + b.margin, towards);
}

ReferenceAnswer referenceDistance(const ReferenceShape& a, const ReferenceShape& b, const Vector3L& towards) {
  const auto look = [&](const Vector3L& n) {
    const Vector3L d = b.support(-n) - a.support(n);
    return Trial{n, d, n.dot(d)};
  };
  return widestGap(look, a.margin + b.margin, towards);
}

long double referenceGap(const ReferenceShape& a, const ReferenceShape& b, const Vector3L& n) {
  return n.dot(b.support(-n) - a.support(n)) - a.margin - b.margin;
}

long double widestGapOverDirections(const ReferenceBody& a, const ReferenceShape& b, int count) {
  return widestOver(
      [&](const Vector3L& n) { return n.dot(b.support(-n)) - b.margin - referenceSupport(a, n); }, count);
}

long double widestGapOverDirections(const ReferenceShape& a, const ReferenceShape& b, int count) {
  return widestOver([&](const Vector3L& n) { return referenceGap(a, b, n); }, count);
}

}  // namespace fcl_stpbv::test
