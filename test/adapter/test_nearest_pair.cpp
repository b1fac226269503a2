// Meshes and trees against each other and against shapes: the nearest elements must be found.
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/nearest_pair.h"
#include "fcl_stpbv/adapter/posed_geometry.h"
#include "fcl_stpbv/convex/relative_pose.h"
#include "test/adapter/element_kinds.h"
#include "test/reference/fcl_bodies.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// Outward rounding for bodies of 1 m in total, a metre apart.
constexpr double kRounding = 4 * kGapRounding;

struct Truth {
  long double distance = 1e9L, second = 1e9L;
  std::map<std::array<std::intptr_t, 2>, long double> all;
};

long double ofElements(const std::vector<TriangleL>& a, const std::vector<TriangleL>& b) {
  long double least = 1e9L;
  for (const TriangleL& s : a)
    for (const TriangleL& t : b) least = std::min(least, referenceDistance(s, t));
  return least;
}

Truth truthOf(const ElementKind& first, const Isometry3d& a, const ElementKind& second, const Isometry3d& b) {
  Truth truth;
  const auto of = second.triangles(b);
  for (const auto& [i, s] : first.triangles(a))
    for (const auto& [j, t] : of) {
      const long double d = truth.all[{i, j}] = ofElements(s, t);
      truth.second = std::min(truth.second, std::max(d, truth.distance));
      truth.distance = std::min(truth.distance, d);
    }
  return truth;
}

/// Least distance of a point from an element's surface.
double offBy(const Vector3d& x, const std::vector<TriangleL>& element) {
  long double least = 1e9L;
  for (const TriangleL& t : element)
    least = std::min(least, referenceDistance(x.cast<long double>().eval(), t));
  return static_cast<double>(least);
}

}  // namespace

TEST_CASE("two meshes, trees or one and a shape apart: the nearest elements, their points, the next ones") {
  const auto kinds = elementKinds();
  Random random(1);
  int asked = 0;
  for (const ElementKind& first : kinds)
    for (const ElementKind& second : kinds) {
      if (!first.surface && !second.surface) continue;
      CAPTURE(first.name, second.name);
      const Isometry3d a = pose(random.rotation(), random.direction());
      const Isometry3d b =
          pose(random.rotation(), a.translation() + random.uniform(0.55, 1) * random.direction());
      const Truth truth = truthOf(first, a, second, b);
      REQUIRE(truth.distance > 0);
      const DistanceAnswer d = distance(*first.geometry, a, *second.geometry, b);
      ++asked;
      CHECK(d.status == DistanceStatus::exact);
      CHECK_FALSE(d.continuous);
      CHECK(static_cast<long double>(d.lower) <= truth.distance);
      CHECK(static_cast<long double>(d.upper) >= truth.distance);
      CHECK(d.upper - d.lower <= 3 * kRounding);
      CHECK(std::abs(static_cast<double>(d.runnerUp - truth.second)) <= kRounding);
      REQUIRE(truth.all.count(d.element) == 1);
      CHECK(std::abs(static_cast<double>(truth.all.at(d.element) - truth.distance)) <= kRounding);
      CHECK(offBy(d.points[0], first.triangles(a).at(d.element[0])) <= kRounding);
      CHECK(offBy(d.points[1], second.triangles(b).at(d.element[1])) <= kRounding);
      CHECK(((d.points[1] - d.points[0]) - d.distance * d.normal).norm() <= 1e-14);
      const fcl::DistanceResultd words = toFclResult(d);
      CHECK((words.b1 == d.element[0] && words.b2 == d.element[1]));
      const DistanceAnswer e = distance(*second.geometry, b, *first.geometry, a);
      CHECK(std::abs(e.distance - d.distance) <= 1e-15);
    }
  CHECK(asked > 100);
}

TEST_CASE("two meshes or trees that overlap are 0 apart, with two elements that meet and a point of both") {
  const auto kinds = elementKinds();
  Random random(2);
  int met = 0;
  for (const ElementKind& first : kinds)
    for (const ElementKind& second : kinds) {
      if (!first.surface || !second.surface) continue;
      CAPTURE(first.name, second.name);
      const Isometry3d a = pose(random.rotation(), random.direction());
      const Isometry3d b = pose(random.rotation(), a.translation() + 0.15 * random.direction());
      const Truth truth = truthOf(first, a, second, b);
      const DistanceAnswer d = distance(*first.geometry, a, *second.geometry, b);
      if (truth.distance > 0) continue;
      ++met;
      CHECK(d.distance == 0);
      CHECK(d.runnerUp == 0);  // many elements meet
      CHECK((d.lower < 0 && d.upper > 0));
      CHECK(d.upper - d.lower <= 2 * kRounding);
      REQUIRE(truth.all.count(d.element) == 1);
      // A cell is solid, so its triangles may be away from a triangle inside it.
      const bool solid = first.name == "octree" || second.name == "octree";
      if (!solid) CHECK(truth.all.at(d.element) == 0);
      CHECK(d.points[0] == d.points[1]);
      if (first.name != "octree") CHECK(offBy(d.points[0], first.triangles(a).at(d.element[0])) <= kRounding);
      if (second.name != "octree")
        CHECK(offBy(d.points[1], second.triangles(b).at(d.element[1])) <= kRounding);
      CHECK(toFclResult(d).min_distance == 0);  // as in FCL
    }
  CHECK(met > 60);
}

TEST_CASE("needles that all but meet as meshes are no farther apart than their upper bound") {
  using Needle = std::array<Vector3d, 3>;
  // Across a needle of kilometres, next to a needle of a metre, a search for the depth ends in rounding.
  const std::array<std::array<Needle, 2>, 3> pairs{
      {{{{{{-0.1640813593259168, 0.10695430533756101, 0.045549859581039701},
           {0.62741927718483226, -0.1317575115888982, -0.25287344929125483},
           {0.39904123211764653, -0.026397592135991427, -0.10319878193671816}}},
         {{{643.53091605074337, 180.6250954413994, 437.78085237537067},
           {16760.38525327354, 4700.2566234388441, 11397.208555866655},
           {-28711.638869151531, -8051.4739537147798, -19523.871764907006}}}}},
       {{{{{0.58661198462909858, 0.24059713669278138, -0.22107041233478661},
           {0.079225136329307305, 0.032406337303198099, -0.031942519808048145},
           {0.18405519867520614, 0.074295193160780953, -0.06932318886220086}}},
         {{{6044.5255249899183, 3520.4024109557622, -5226.8448309454152},
           {113136.76090669315, 65897.542944219153, -97826.217706998141},
           {-135474.70065563329, -78908.456174546853, 117142.59401346257}}}}},
       {{{{{0.44721951695032536, 1.2343997416991088, 0.49919305213736187},
           {-0.44067145739196262, -1.2163259839319858, -0.49188399671783134},
           {0.31149446827435617, 0.85977616851312, 0.34769473100722131}}},
         {{{-26.78073565788516, -22.718811072405408, -8.8760930834230223},
           {199.62347576923472, 176.43826664767229, 69.121141650215804},
           {-241.08480239300232, -211.22704979993307, -82.716339627924896}}}}}}};
  const Isometry3d still = Isometry3d::Identity();
  for (const auto& pair : pairs) {
    std::array<fcl::BVHModel<fcl::OBBRSSd>, 2> mesh;
    std::array<TriangleL, 2> needle;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& [p, q, r] = pair[i];
      mesh[i].beginModel();
      mesh[i].addTriangle(p, q, r);
      mesh[i].endModel();
      needle[i] = placed(still, p, q, r);
    }
    const long double truth = referenceDistance(needle[0], needle[1]);
    REQUIRE(truth > 1e-10L);
    const DistanceAnswer d = distance(mesh[0], still, mesh[1], still);
    CHECK(d.lower <= truth);
    CHECK(d.upper >= truth);
    CHECK(d.status == DistanceStatus::bounded);
  }
}

TEST_CASE("a ball against a mesh is signed, whichever triangle it is deepest in") {
  const ElementKind mesh = meshKind<fcl::OBBRSSd>("OBBRSS", 8);
  const fcl::Sphered ball(0.1);
  Random random(3);
  int deep = 0;
  for (int i = 0; i < 200; ++i) {
    const Isometry3d a = pose(random.rotation(), random.direction());
    const Isometry3d b =
        pose(random.rotation(), a.translation() + random.uniform(0, 0.6) * random.direction());
    long double truth = 1e9L;
    for (const auto& [id, t] : mesh.triangles(a))
      truth = std::min(truth, referenceDistance(b.translation().cast<long double>().eval(), t[0]) - 0.1L);
    const DistanceAnswer d = distance(*mesh.geometry, a, ball, b), e = distance(ball, b, *mesh.geometry, a);
    CAPTURE(i, d.lower, d.upper, static_cast<double>(truth));
    deep += truth < 0;
    CHECK(static_cast<long double>(d.lower) <= truth);
    CHECK(static_cast<long double>(d.upper) >= truth);
    CHECK(std::abs(d.distance - static_cast<double>(truth)) <= kRounding);
    CHECK(e.distance == d.distance);
    CHECK((e.element[0] == -1 && d.element[1] == -1 && e.element[1] >= 0));
  }
  CHECK(deep > 30);
}

TEST_CASE("where FCL measures two meshes it names triangles that are as near as ours") {
  Random random(4);
  const ElementKind mesh = meshKind<fcl::RSSd>("RSS", 8);
  for (int i = 0; i < trials(100); ++i) {
    const Isometry3d a = pose(random.rotation(), random.direction());
    const Isometry3d b =
        pose(random.rotation(), a.translation() + random.uniform(0.1, 1) * random.direction());
    fcl::DistanceRequestd request(true);
    request.distance_tolerance = 1e-10;
    fcl::DistanceResultd theirs, ours;
    fcl::distance(mesh.geometry.get(), a, mesh.geometry.get(), b, request, theirs);
    fcl_stpbv::distance(mesh.geometry.get(), a, mesh.geometry.get(), b, request, ours);
    CAPTURE(i, theirs.b1, theirs.b2, ours.b1, ours.b2);
    CHECK(std::abs(ours.min_distance - theirs.min_distance) <= 1e-14);
    CHECK((ours.b1 >= 0 && ours.b2 >= 0));
    const auto first = mesh.triangles(a), second = mesh.triangles(b);
    const auto between = [&](const fcl::DistanceResultd& d) {
      return ofElements(first.at(d.b1), second.at(d.b2));
    };
    CHECK(std::abs(static_cast<double>(between(ours) - between(theirs))) <= kRounding);
  }
}

TEST_CASE("next to a half space or a plane few of a mesh's triangles are looked at, the nearest among them") {
  const auto mesh = bumpyGround<fcl::OBBRSSd>(40, 0.1);
  Random random(8);
  for (int i = 0; i < 100; ++i) {
    const Vector3d n = random.direction();
    const double offset = random.uniform(-1, 1);
    const fcl::Halfspaced below(n, offset);
    const fcl::Planed sheet(n, offset);
    const Isometry3d here = pose(random.rotation(), random.direction()),
                     there = pose(random.rotation(), random.uniform(0, 3) * random.direction());
    double half = 1e9, plane = 1e9;
    for (int t = 0; t < mesh->num_tris; ++t) {
      double low = 1e9, high = -1e9;
      for (int k = 0; k < 3; ++k) {
        const Vector3d x = here.inverse() * (there * mesh->vertices[mesh->tri_indices[t][k]]);
        low = std::min(low, n.dot(x) - offset);
        high = std::max(high, n.dot(x) - offset);
      }
      half = std::min(half, low);
      plane = std::min(plane, std::max(low, -high));
    }
    const auto compare = [&](const fcl::CollisionGeometryd& flat, double truth) {
      CAPTURE(i, truth);
      const DistanceAnswer d = distance(flat, here, *mesh, there), back = distance(*mesh, there, flat, here);
      CHECK(std::abs(d.distance - truth) <= kRounding * 8);
      CHECK(back.distance == d.distance);
      ProximityCounts counts;
      QueryContext context;
      context.proximity = &counts;
      CHECK(isFartherThan(truth - 1e-3, flat, here, *mesh, there, context));
      CHECK_FALSE(isFartherThan(truth + 1e-3, *mesh, there, flat, here, context));
      CHECK(counts.solved < mesh->num_tris / 20);
    };
    compare(below, half);
    compare(sheet, plane);
  }
}

TEST_CASE("a body deep in a mesh is measured to few of its triangles, the two nearest among them") {
  const auto mesh = bumpyGround<fcl::OBBRSSd>(40, 0.1);
  const std::vector<std::shared_ptr<fcl::CollisionGeometryd>> bodies = {
      geometryOf(randomHull(60, {0.5, 0.5, 0.5}, 20)),  // every normal leads out of it
      geometryOf(randomHull(60, {0.5, 0.5, 0.05}, 21)), std::make_shared<fcl::Ellipsoidd>(0.5, 0.3, 0.4),
      std::make_shared<fcl::Cylinderd>(0.4, 0.8),       std::make_shared<fcl::Cylinderd>(0.6, 0.05),
      std::make_shared<fcl::Coned>(0.4, 0.8),           std::make_shared<fcl::Capsuled>(0.2, 0.8),
      std::make_shared<fcl::Boxd>(0.8, 0.5, 0.6)};
  Random random(9);
  int deep = 0;
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    ConvexBody body, triangle;
    REQUIRE(isConvex(*bodies[k], body));
    int solved = 0;
    constexpr int kPoses = 6;
    for (int i = 0; i < kPoses; ++i) {
      body.pose = pose(random.rotation(), random.direction());
      triangle.pose =
          pose(random.rotation(), body.pose.translation() + random.uniform(0, 0.6) * random.direction());
      const ElementsDistance found = nearestElements(*bodies[k], body.pose, *mesh, triangle.pose, true);
      double least = 1e9, second = 1e9;
      for (int t = 0; t < mesh->num_tris; ++t) {
        const auto corner = [&](int c) { return mesh->vertices[mesh->tri_indices[t][c]]; };
        triangle.shape = Shape::triangleOf(corner(0), corner(1), corner(2));
        const double d = distance(body, triangle).distance;
        second = std::min(second, std::max(d, least));
        least = std::min(least, d);
      }
      CAPTURE(k, i, least, second, found.solved);
      CHECK(std::abs(found.found.distance - least) <= kRounding);
      CHECK(std::abs(found.runnerUp - second) <= kRounding);
      deep += least < -0.02;
      solved += found.solved;
    }
    CAPTURE(k, solved);
    CHECK(solved < kPoses * mesh->num_tris / 50);
  }
  CHECK(deep > 24);
}

TEST_CASE("two large meshes apart are measured by few of their triangles") {
  fcl::BVHModel<fcl::OBBRSSd> mesh;
  fcl::generateBVHModel(mesh, fcl::Ellipsoidd(0.3, 0.2, 0.4), Isometry3d::Identity(), 100u, 100u);
  REQUIRE(mesh.num_tris == 20000);
  Random random(11);
  constexpr int kPoses = 50;
  int solved = 0;
  for (int i = 0; i < kPoses; ++i) {
    const Isometry3d here = pose(random.rotation(), {0, 0, 0}),
                     there = pose(random.rotation(), random.uniform(0.8, 1.2) * random.direction());
    const ElementsDistance found = nearestElements(mesh, here, mesh, there, true),
                           back = nearestElements(mesh, there, mesh, here, true);
    CHECK(found.found.distance > 0);
    CHECK(std::abs(back.found.distance - found.found.distance) <= kRounding);
    CHECK(std::abs(back.runnerUp - found.runnerUp) <= kRounding);
    solved += found.solved;
  }
  CAPTURE(solved);
  CHECK(solved < 140 * kPoses);  // 118 on average
}

TEST_CASE("level faces of many triangles take no more looks than the meshes have corners") {
  const auto grid = [](int cells) {
    std::vector<Vector3d> points;
    std::vector<fcl::Triangle> triangles;
    for (int i = 0; i <= cells; ++i)
      for (int j = 0; j <= cells; ++j)
        points.emplace_back(double(i) / cells - 0.5, double(j) / cells - 0.5, 0);
    for (int i = 0; i < cells; ++i)
      for (int j = 0; j < cells; ++j) {
        const auto a = static_cast<std::size_t>(i * (cells + 1) + j),
                   b = a + static_cast<std::size_t>(cells) + 1;
        triangles.emplace_back(a, b, a + 1);
        triangles.emplace_back(a + 1, b, b + 1);
      }
    return meshOf<fcl::OBBRSSd>(points, triangles);
  };
  const auto a = grid(60), b = grid(45);
  for (const double gap : {0.3, 1e-3, 1e-9}) {
    for (const double turn : {0.0, 0.7}) {
      Isometry3d pose = Isometry3d::Identity();
      pose.linear() = Eigen::AngleAxisd(turn, Vector3d::UnitZ()).toRotationMatrix();
      pose.translation() = Vector3d(0.003, 0.002, gap);
      const ElementsDistance found = nearestElements(*a, Isometry3d::Identity(), *b, pose, false);
      CAPTURE(gap, turn, found.looks);
      CHECK(found.looks < a->num_vertices + b->num_vertices);
      CHECK(found.found.status == DistanceStatus::exact);
      CHECK(std::abs(found.found.distance - gap) <= kRounding);
      CHECK((found.found.lower <= gap && gap <= found.found.upper));
      CHECK(found.found.upper - found.found.lower <= 2 * kRounding);
      CHECK(std::abs(found.runnerUp - gap) <= kRounding);
    }
  }
}
