// Motions next to meshes and trees: near ones need few examined times, and dense samples agree.
#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "fcl_stpbv/adapter/continuous_collide.h"
#include "test/reference/fcl_bodies.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

TEST_CASE(
    "a body that slides over a flat mesh needs few queries at any distance, and one that sinks meets it in "
    "time") {
  const auto floor = bumpyGround<fcl::OBBRSSd>(10, 0.0);
  const fcl::Boxd crate(0.1, 0.08, 0.06);
  fcl::BVHModel<fcl::OBBRSSd> mesh;
  fcl::generateBVHModel(mesh, crate, Isometry3d::Identity());
  const StpBvGeometry smooth(StpBv::build(box(0.1, 0.08, 0.06), {0.01, 10}));
  const double extent = smooth.volume().support(-Vector3d::UnitZ());
  SteadyMotion still;
  for (const auto& [body, half] :
       {std::pair<const fcl::CollisionGeometryd*, double>(&crate, 0.03), {&mesh, 0.03}, {&smooth, extent}})
    for (const double room : {1e-3, 1e-6})
      for (const double turn : {0.0, 2.0}) {
        CAPTURE(half, room, turn);
        SteadyMotion slide;
        slide.begin.translation() = Vector3d(-0.1, 0.02, half + room);
        slide.linear = {0.2, 0.01, 0};
        slide.angular = {0, 0, turn};
        const MotionAnswer over = firstContact(*floor, still, *body, slide);
        CHECK(over.verdict == MotionVerdict::free);
        // Points on a circle leave the plane in which they start to move.
        const long few = turn > 0 ? 300 : 30;
        CHECK(over.queries < few);
        CHECK(firstContact(*body, slide, *floor, still).queries < few);
        slide.linear.z() = -2 * room;
        const MotionAnswer sinks = firstContact(*floor, still, *body, slide, {0, 1e-6});
        CHECK(sinks.verdict == MotionVerdict::contact);
        // 2 room takes 1 unit of time, up to rounding.
        CHECK(std::abs(sinks.until - 0.5) <= 1e-6 + 1e-15 / room);
      }
}

TEST_CASE("a slide in a room and along a tree's cells takes few looks") {
  const fcl::Boxd crate(0.1, 0.08, 0.06);
  const auto slide = [&](const fcl::CollisionGeometryd& around, double floor, long few) {
    SteadyMotion still, motion;
    motion.begin.translation() = Vector3d(-0.1, 0.02, floor + 0.03 + 1e-6);
    motion.linear = {0.2, 0, 0};
    const MotionAnswer answer = firstContact(around, still, crate, motion);
    CHECK(answer.verdict == MotionVerdict::free);
    CHECK(answer.queries < few);
    motion.begin.translation().z() -= 2e-6;
    CHECK(firstContact(around, still, crate, motion).verdict == MotionVerdict::contact);
  };
  fcl::BVHModel<fcl::OBBRSSd> room;  // its hull contains the crate
  fcl::generateBVHModel(room, fcl::Boxd(2, 2, 1), Isometry3d::Identity());
  slide(room, -0.5, 10);
#if FCL_HAVE_OCTOMAP
  const auto cells = std::make_shared<octomap::OcTree>(0.0625);
  for (int i = -8; i < 8; ++i)
    for (int j = -8; j < 8; ++j) {
      const auto x = static_cast<float>(0.0625 * (i + 0.5)), y = static_cast<float>(0.0625 * (j + 0.5));
      cells->updateNode(octomap::point3d(x, y, -0.03F), true);
      cells->updateNode(octomap::point3d(x, 0.51F, y + 0.5F), true);  // a wall beside the floor
    }
  slide(fcl::OcTreed(cells), 0, 30);
#endif
}

TEST_CASE("a body that moves with a mesh keeps its distance from it at any speed") {
  const auto floor = bumpyGround<fcl::AABBd>(10, 0.05);
  std::vector<Vector3d> points;
  Random random(9);
  for (int i = 0; i < 25; ++i) points.push_back(0.3 * random.direction() + Vector3d(0, 0, 0.35 + 1e-6));
  fcl::BVHModel<fcl::OBBRSSd> cloud;
  cloud.beginModel();
  cloud.addSubModel(points);
  cloud.endModel();
  SteadyMotion motion;
  motion.linear = {3, 2, 1};
  const MotionAnswer answer = firstContact(*floor, motion, cloud, motion);
  CHECK(answer.verdict == MotionVerdict::free);
  CHECK(answer.queries < 5);
}

TEST_CASE("bodies that graze bumpy ground are free or meet it where dense samples see it") {
  Random random(6);
  int free = 0, hits = 0;
  long queries = 0;
  for (const double height : {0.0, 0.001, 0.1}) {
    const auto ground = bumpyGround<fcl::OBBRSSd>(20, height);
    fcl::BVHModel<fcl::AABBd> mesh;
    fcl::generateBVHModel(mesh, fcl::Ellipsoidd(0.1, 0.1, 0.1), Isometry3d::Identity(), 8, 8);
    const auto smooth = geometryOf(box(0.2, 0.15, 0.1), 0.02, 10);
    for (const fcl::CollisionGeometryd* body : {static_cast<const fcl::CollisionGeometryd*>(&mesh),
                                                static_cast<const fcl::CollisionGeometryd*>(smooth.get())})
      for (int i = 0; i < trials(40); ++i) {
        SteadyMotion still, graze;
        graze.begin = pose(random.rotation(), random.uniform(0, 0.6) * random.direction());
        graze.linear = random.uniform(0, 0.6) * random.direction();
        graze.angular = random.uniform(0, 2) * random.direction();
        // At a height where it almost touches at the middle of its way.
        graze.begin.translation().z() = graze.linear.z() = 0;
        const Isometry3d middle = graze.at(0.5);
        graze.begin.translation().z() = 1;
        const fcl::Halfspaced below(Vector3d::UnitZ(), 0);
        const double low = distance(below, Isometry3d::Identity(), *smooth, middle).distance;
        graze.begin.translation().z() = height - low + std::pow(10.0, random.uniform(-6, -1.5));
        const MotionAnswer found = firstContact(*ground, still, *body, graze, {0, 1e-5});
        REQUIRE(found.verdict != MotionVerdict::undecided);
        queries += found.queries;
        const bool isFree = found.verdict == MotionVerdict::free;
        ++(isFree ? free : hits);
        constexpr int kSamples = 200;
        for (int k = 0; k <= kSamples; ++k) {
          const double t = static_cast<double>(k) / kSamples;
          if (!isFree && t >= found.from) break;
          REQUIRE(distance(*ground, Isometry3d::Identity(), *body, graze.at(t)).distance > -1e-12);
        }
        if (!isFree)
          CHECK(distance(*ground, Isometry3d::Identity(), *body, graze.at(found.until)).distance <= 1e-9);
      }
  }
  CAPTURE(free, hits, queries);
  CHECK((free > trials(80) && hits > trials(40) / 2));
  CHECK(queries <= 20 * (free + hits));
}
