// Tests isFarther for every pair of geometries, and how few elements are queried for it.
#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif

#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/distance/distance.h"
#include "fcl_stpbv/distance/threshold.h"
#include "test/reference/fcl_bodies.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// One body of a geometry, in the geometry's frame.
struct Part {
  StpBv::Ptr volume;
  Shape shape;
  Vector3d place;
};

struct Kind {
  const char* name;
  std::shared_ptr<fcl::CollisionGeometryd> geometry;
  std::vector<Part> parts;
};

template <typename BV>
Kind mesh(const char* name) {
  auto model = std::make_shared<fcl::BVHModel<BV>>();
  fcl::generateBVHModel(*model, fcl::Ellipsoidd(0.2, 0.15, 0.25), fcl::Transform3d::Identity(), 8, 8);
  Kind kind{name, model, {}};
  for (int t = 0; t < model->num_tris; ++t) {
    const fcl::Triangle& i = model->tri_indices[t];
    kind.parts.push_back(
        {nullptr,
         Shape::triangleOf(model->vertices[i[0]], model->vertices[i[1]], model->vertices[i[2]]),
         {0, 0, 0}});
  }
  return kind;
}

/// Every type, about 0.4 m in size.
std::vector<Kind> everyKind() {
  std::vector<Kind> all;
  const auto volume = StpBv::build(randomHull(30, {0.2, 0.15, 0.1}, 3));
  all.push_back({"volume", std::make_shared<StpBvGeometry>(volume), {{volume, {}, {0, 0, 0}}}});
  const auto shape = [&](const char* name, std::shared_ptr<fcl::CollisionGeometryd> geometry) {
    Shape s;
    REQUIRE(shapeOf(*geometry, s));
    all.push_back({name, geometry, {{nullptr, s, {0, 0, 0}}}});
  };
  shape("sphere", std::make_shared<fcl::Sphered>(0.2));
  shape("capsule", std::make_shared<fcl::Capsuled>(0.1, 0.3));
  shape("ellipsoid", std::make_shared<fcl::Ellipsoidd>(0.1, 0.2, 0.15));
  shape("box", std::make_shared<fcl::Boxd>(0.3, 0.2, 0.4));
  shape("cylinder", std::make_shared<fcl::Cylinderd>(0.1, 0.3));
  shape("cone", std::make_shared<fcl::Coned>(0.1, 0.3));
  shape("convex", hullGeometry(randomHull(40, {0.1, 0.2, 0.15}, 5)));
  shape("triangle", std::make_shared<fcl::TrianglePd>(Vector3d(0.2, 0, 0), Vector3d(-0.1, 0.2, 0),
                                                      Vector3d(0, -0.2, 0.1)));
  shape("half space", std::make_shared<fcl::Halfspaced>(Vector3d(0, 0, 1), 0.1));
  shape("plane", std::make_shared<fcl::Planed>(Vector3d(0, 0, 1), 0.1));
  all.push_back(mesh<fcl::OBBRSSd>("mesh of OBBRSS"));
  all.push_back(mesh<fcl::AABBd>("mesh of AABB"));
  all.push_back(mesh<fcl::KDOP<double, 24>>("mesh of KDOP"));
#if FCL_HAVE_OCTOMAP
  auto cells = std::make_shared<octomap::OcTree>(0.05);
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3f p = (0.2 * random.direction()).cast<float>();
    cells->updateNode(octomap::point3d(p.x(), p.y(), p.z()), i % 4 != 0);
  }
  const auto tree = std::make_shared<fcl::OcTreed>(cells);
  Kind kind{"tree", tree, {}};
  for (const auto& c : tree->toBoxes())
    kind.parts.push_back({nullptr, Shape::boxOf(Vector3d::Constant(c[3])), Vector3d(c[0], c[1], c[2])});
  all.push_back(kind);
#endif
  return all;
}

/// The distance of two bodies, or what is known of it.
Distance between(const Part& p, Isometry3d a, const Part& q, Isometry3d b) {
  a.translation() = a * p.place;
  b.translation() = b * q.place;
  if (p.volume && q.volume) return distance(*p.volume, a, *q.volume, b);
  if (p.volume) return distance(*p.volume, a, q.shape, b);
  if (q.volume) return distance(p.shape, a, *q.volume, b);
  return distance(p.shape, a, q.shape, b);
}

/// Whether it is a mesh or a tree.
bool isSurface(const Kind& kind) {
  return kind.geometry->getObjectType() == fcl::OT_BVH || kind.geometry->getObjectType() == fcl::OT_OCTREE;
}

/// The least distance over all pairs of bodies. Two surfaces have no depth.
Distance leastBetween(const Kind& first, const Isometry3d& a, const Kind& second, const Isometry3d& b) {
  Distance least;
  least.lower = least.upper = std::numeric_limits<double>::infinity();
  for (const Part& p : first.parts)
    for (const Part& q : second.parts) {
      const Distance d = between(p, a, q, b);
      if (d.status == DistanceStatus::invalid) return d;
      least.lower = std::min(least.lower, d.lower);
      least.upper = std::min(least.upper, d.upper);
    }
  if (isSurface(first) && isSurface(second)) {
    least.lower = std::max(least.lower, 0.0);
    least.upper = std::max(least.upper, 0.0);
  }
  least.status = DistanceStatus::bounded;
  return least;
}

}  // namespace

TEST_CASE(
    "farther than a little less than the distance, not farther than a little more, for every two kinds") {
  const auto kinds = everyKind();
  Random random(1);
  int apart = 0, overlapping = 0, unknown = 0;
  for (const Kind& first : kinds)
    for (const Kind& second : kinds)
      for (int i = 0; i < 4; ++i) {
        CAPTURE(first.name, second.name, i);
        const double far = i == 3 ? 1000 : 1;  // m from the world's origin
        const Isometry3d a = pose(random.rotation(), far * random.direction());
        const Isometry3d b =
            pose(random.rotation(), a.translation() + random.uniform(0.2, 0.9) * random.direction());
        const auto farther = [&](double x) {
          return isFartherThan(x, *first.geometry, a, *second.geometry, b);
        };
        const Distance d = leastBetween(first, a, second, b);
        if (d.status == DistanceStatus::invalid) {  // two planes
          ++unknown;
          CHECK_FALSE(farther(-1e3));
          continue;
        }
        ++(d.lower > 0 ? apart : overlapping);
        CAPTURE(d.lower, d.upper);
        // A depth of round bodies is accurate to 1e-6 of it: an ulp in a cell's place may move its bounds by
        // that.
        const double slack = 1e-12 * far + (d.lower < 0 ? 1e-6 * -d.lower : 0);
        CHECK(farther(d.lower - slack));
        CHECK_FALSE(farther(d.upper + slack));
        CHECK(collides(*first.geometry, a, *second.geometry, b, d.upper + slack));
      }
  CHECK(apart > 300);
  CHECK(overlapping > 100);
  CHECK(unknown == 16);
}

TEST_CASE(
    "queries for a threshold: one bound far away, few elements near it, and none after the first one within "
    "it") {
  const auto kinds = everyKind();
  Random random(2);
  long pairs = 0, solvedBelow = 0, solvedAbove = 0, asked = 0;
  for (const Kind& first : kinds)
    for (const Kind& second : kinds) {
      CAPTURE(first.name, second.name);
      ProximityCounts counts;
      QueryContext context;
      context.proximity = &counts;
      const Isometry3d a = pose(random.rotation(), random.direction());
      const auto farther = [&](double x, const Isometry3d& b) {
        counts = {};
        return isFartherThan(x, *first.geometry, a, *second.geometry, b, context);
      };
      const bool unbounded = first.parts[0].shape.unbounded() || second.parts[0].shape.unbounded();
      const Isometry3d away = pose(random.rotation(), a.translation() + 5 * random.direction());
      if (!unbounded) {
        CHECK(farther(1, away));
        CHECK(counts.solved == 0);
        // A tree's root is kilometres wide, so it takes a few levels to get to the cells.
        if (first.parts[0].place.isZero() && second.parts[0].place.isZero()) CHECK(counts.bounds == 1);
      }
      const Isometry3d b = pose(random.rotation(), a.translation() + 0.7 * random.direction());
      const Distance d = leastBetween(first, a, second, b);
      if (d.status == DistanceStatus::invalid || !(d.lower > 0)) continue;
      ++asked;
      pairs += static_cast<long>(first.parts.size() * second.parts.size());
      CHECK(farther(d.lower - 1e-3, b));
      solvedBelow += counts.solved;
      CHECK_FALSE(farther(d.upper + 1e-3, b));
      solvedAbove += counts.solved;
    }
  CAPTURE(pairs, asked, solvedBelow, solvedAbove);
  CHECK(solvedBelow <= pairs / 500);  // 0.14 % of all pairs of bodies, a millimetre below the distance
  CHECK(solvedAbove <= 2 * asked);    // 1.2 per question on average, a millimetre above the distance
}

TEST_CASE("balls in two simple shapes tell that these meet, and never more than that") {
  const fcl::Sphered ball(0.2);
  const fcl::Boxd cube(0.4, 0.4, 0.4);
  const fcl::Cylinderd cylinder(0.2, 0.4);
  const fcl::Ellipsoidd ellipsoid(0.2, 0.2, 0.2);
  Random random(6);
  for (const fcl::CollisionGeometryd* first :
       std::initializer_list<const fcl::CollisionGeometryd*>{&ball, &cube, &cylinder, &ellipsoid})
    for (const fcl::CollisionGeometryd* second :
         std::initializer_list<const fcl::CollisionGeometryd*>{&ball, &cube, &cylinder, &ellipsoid}) {
      ProximityCounts counts;
      QueryContext context;
      context.proximity = &counts;
      // To 1e-12 m, because rounding is below 1e-13 for a size of a metre. Faces, ends and balls are opposite
      // each other along x, y or z, so the balls' distance is that of the bodies. A cylinder has ends only
      // along z, and its side in all directions across z.
      for (const double gap : {-0.3, -1e-3, 1e-3, 0.3}) {
        const Vector3d axis = Vector3d::Unit(static_cast<int>(random.uniform(0, 3)));
        Isometry3d a = pose(random.rotation(), random.direction()), b = a;
        b.translation() += a.linear() * ((0.4 + gap) * axis);
        CAPTURE(first->getNodeType(), second->getNodeType(), gap, axis);
        CHECK_FALSE(isFartherThan(gap + 1e-12, *first, a, *second, b, context));
        CHECK(isFartherThan(gap - 1e-12, *first, a, *second, b, context));
        counts = {};
        CHECK_FALSE(isFartherThan(gap + 1e-12, *first, a, *second, b, context));
        CHECK(counts.solved == 0);
      }
    }
}

TEST_CASE("a threshold below 0 is decided by the distance of two overlapping kinds") {
  const auto kinds = everyKind();
  Random random(4);
  int surfaces = 0, bodies = 0;
  for (const Kind& first : kinds)
    for (const Kind& second : kinds)
      for (int i = 0; i < 3; ++i) {
        const Isometry3d a = pose(random.rotation(), random.direction());
        const Isometry3d b =
            pose(random.rotation(), a.translation() + random.uniform(0, 0.3) * random.direction());
        const DistanceAnswer d = distance(*first.geometry, a, *second.geometry, b);
        if (d.status == DistanceStatus::invalid || !(d.lower <= 0)) continue;
        CAPTURE(first.name, second.name, i, d.lower, d.upper);
        ++(isSurface(first) && isSurface(second) ? surfaces : bodies);
        const double slack = 1e-12 - 1e-6 * d.lower;  // a depth of round bodies is accurate to 1e-6 of it
        for (const double x : {-1e-9, -1e-3, -0.1, -0.4, -10.0}) {
          if (x < d.lower - slack) CHECK(isFartherThan(x, *first.geometry, a, *second.geometry, b));
          if (x > d.upper + slack) CHECK_FALSE(isFartherThan(x, *first.geometry, a, *second.geometry, b));
          if (x > d.upper + slack) CHECK(collides(*first.geometry, a, *second.geometry, b, x));
        }
      }
  CHECK((surfaces > 20 && bodies > 200));
}

TEST_CASE("two triangles that cross are no deeper in each other than 0, as their distance says") {
  const auto triangle = [](const std::vector<Vector3d>& corners) {
    return meshOf<fcl::OBBRSSd>(corners, {fcl::Triangle(0, 1, 2)});
  };
  const auto a = triangle({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}}),
             b = triangle({{0, -1, -1}, {0, -1, 1}, {0, 1, 0}});
  const Isometry3d here = Isometry3d::Identity();
  CHECK(distance(*a, here, *b, here).distance == 0);
  for (const double x : {-1e-6, -0.1, -0.4, -0.5, -10.0}) {
    CHECK(isFartherThan(x, *a, here, *b, here));
    CHECK_FALSE(collides(*a, here, *b, here, x));
  }
  CHECK_FALSE(isFartherThan(0, *a, here, *b, here));
  CHECK_FALSE(isFartherThan(-0.0, *a, here, *b, here));
}

TEST_CASE("the remembered normal's planes answer the next question alone") {
  const auto kinds = everyKind();
  Random random(3);
  for (const Kind& second : kinds) {
    if (second.parts.size() > 1 || second.parts[0].shape.unbounded()) continue;
    CAPTURE(second.name);
    PairCache cache;
    ProximityCounts counts;
    QueryContext context;
    context.cache = &cache;
    context.proximity = &counts;
    const Isometry3d a = pose(random.rotation(), random.direction());
    Isometry3d b = pose(random.rotation(), a.translation() + 0.6 * random.direction());
    const double d = distance(*kinds[0].geometry, a, *second.geometry, b, context).distance;
    REQUIRE(d > 0.01);
    b.translation() += 1e-4 * random.direction();
    CHECK(isFartherThan(d - 1e-3, *kinds[0].geometry, a, *second.geometry, b, context));
    CHECK(counts.solved == 0);
  }
}

TEST_CASE("a pair with an invalid pose or an empty geometry is not farther than any threshold") {
  const auto kinds = everyKind();
  Isometry3d broken = Isometry3d::Identity(), scaled = Isometry3d::Identity();
  broken.translation().x() = std::nan("");
  scaled.linear() *= 2;
  const Isometry3d here = Isometry3d::Identity(), there = pose(Eigen::Matrix3d::Identity(), {10, 0, 0});
  for (const Kind& kind : kinds) {
    CAPTURE(kind.name);
    CHECK_FALSE(isFartherThan(-1, *kind.geometry, here, *kinds[0].geometry, broken));
    CHECK_FALSE(isFartherThan(-1, *kind.geometry, scaled, *kinds[0].geometry, there));
    CHECK_FALSE(isFartherThan(std::nan(""), *kind.geometry, here, *kinds[0].geometry, there));
    CHECK_FALSE(isFartherThan(-1, *kind.geometry, here, fcl::BVHModel<fcl::OBBRSSd>(), there));
  }
}

TEST_CASE("two volumes at any depth and any threshold are judged as their distance's bounds say") {
  const std::vector<StpBv::Ptr> volumes{
      StpBv::build(geodesicSphere(0.2, 2), {0.01, 10}), StpBv::build(box(0.2, 0.3, 0.4), {0.03, 1}),
      StpBv::build(randomHull(50, {0.2, 0.15, 0.1}, 3), {0.01, 10}),
      StpBv::build(plate(0.3, 0.2), {0.01, 10}), StpBv::build({{0, 0, 0}}, {0.1, 10})};
  Random random(9);
  int yes = 0, no = 0;
  for (const StpBv::Ptr& a : volumes)
    for (const StpBv::Ptr& b : volumes)
      for (int i = 0; i < 60; ++i) {
        const Isometry3d pa = pose(random.rotation(), random.direction());
        const Isometry3d pb =
            pose(random.rotation(), pa.translation() + random.uniform(0, 0.6) * random.direction());
        const Distance d = distance(*a, pa, *b, pb);
        CAPTURE(i, d.lower, d.upper);
        PairCache cache;
        for (const double x : {0.0, 0.05, -0.05, -0.15, d.lower - 1e-9, d.upper + 1e-9}) {
          const bool farther = isFartherThan(x, *a, pa, *b, pb, i % 2 ? &cache : nullptr);
          if (d.lower > x + 1e-12) CHECK(farther);
          if (d.upper <= x) CHECK_FALSE(farther);
          ++(farther ? yes : no);
        }
      }
  CHECK((yes > 2000 && no > 2000));
}
