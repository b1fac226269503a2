// Octrees as in maps: most of the space is known to be free, and whole blocks of it are one cell.
#include <fcl/config.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "fcl_stpbv/adapter/collide.h"
#include "fcl_stpbv/adapter/continuous_collide.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "test/reference/fcl_bodies.h"
#include "test/reference/trials.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

constexpr int kWide = 16;        // cells each way
constexpr double kCell = 0.125;  // m, exact in octomap's floats

/// How up to date a map's marks of inner cells are.
enum class Marks { current, stale, noFreeCells };

/// A cube of cells around the origin. A floor, a post and some other cells are occupied.
struct Map {
  std::shared_ptr<octomap::OcTree> cells = std::make_shared<octomap::OcTree>(kCell);
  std::vector<Vector3d> occupied;  // centres

  explicit Map(Marks marks) {
    Random random(4);
    std::vector<int> extra;
    for (int i = 0; i < 30; ++i) extra.push_back(random.below(kWide * kWide * kWide));
    for (int i = 0; i < kWide; ++i)
      for (int j = 0; j < kWide; ++j)
        for (int k = 0; k < kWide; ++k) {
          const bool full = k == 0 || (i == 3 && j == 5) ||
                            std::count(extra.begin(), extra.end(), (i * kWide + j) * kWide + k) > 0;
          const Vector3d centre = kCell * (Vector3d(i, j, k) + Vector3d::Constant(0.5 - kWide / 2));
          if (full) occupied.push_back(centre);
          if (!full && marks == Marks::noFreeCells) continue;
          const Eigen::Vector3f p = centre.cast<float>();
          // Lazy updates leave the marks above a cell unchanged: free, in this case.
          cells->updateNode(octomap::point3d(p.x(), p.y(), p.z()), full, marks == Marks::stale);
        }
    if (marks == Marks::current) cells->prune();
  }
};

std::vector<std::shared_ptr<fcl::CollisionGeometryd>> bodies() {
  return {geometryOf(box(0.2, 0.3, 0.1), 0.02, 10), std::make_shared<fcl::Boxd>(0.3, 0.2, 0.4),
          std::make_shared<fcl::Cylinderd>(0.1, 0.5), std::make_shared<fcl::Sphered>(0.2),
          bumpyGround<fcl::OBBRSSd>(4, 0.1)};
}

/// Distance of a body from one cell, as a box of its own (m).
double fromCell(const Vector3d& centre, const Isometry3d& tree, const fcl::CollisionGeometryd& body,
                const Isometry3d& pose) {
  Isometry3d place = tree;
  place.translation() = tree * centre;
  return distance(fcl::Boxd(kCell, kCell, kCell), place, body, pose).distance;
}

}  // namespace

TEST_CASE("distances, contacts and thresholds of a map are those of its occupied cells, one by one") {
  Random random(7);
  int hits = 0, apart = 0;
  for (const Marks marks : {Marks::current, Marks::stale, Marks::noFreeCells}) {
    const Map map(marks);
    const fcl::OcTreed tree(map.cells);
    for (const auto& body : bodies())
      for (int i = 0; i < trials(24); ++i) {
        const Isometry3d treePose = i % 3 == 0 ? at(0, 0, 0) : pose(random.rotation(), random.direction()),
                         inTree = pose(random.rotation(), random.uniform(0, 1.6) * random.direction()),
                         where = treePose * inTree;
        const bool surface = body->getNodeType() == fcl::BV_OBBRSS;  // two surfaces have no depth
        double least = std::numeric_limits<double>::infinity();
        std::size_t meeting = 0;
        for (const Vector3d& cell : map.occupied) {
          const double d = fromCell(cell, treePose, *body, where);
          least = std::min(least, d);
          meeting += d <= 0;
        }
        CAPTURE(marks, body->getNodeType(), i, least);
        const double found = distance(tree, treePose, *body, where).distance;
        const double turned = distance(*body, where, tree, treePose).distance;
        const double expected = surface ? std::max(least, 0.0) : least;
        CHECK(std::abs(found - expected) <= 1e-12);  // hundreds of roundings of places a few metres away
        CHECK(std::abs(turned - expected) <= 1e-12);
        if (std::abs(least) < 1e-9) continue;
        ++(least > 0 ? apart : hits);
        for (const double x : {-0.05, 0.0, 0.1, 0.5}) {
          if (std::abs(least - x) < 1e-9 || (x < 0 && surface)) continue;
          CHECK(isFartherThan(x, tree, treePose, *body, where) == (least > x));
          CHECK(isFartherThan(x, *body, where, tree, treePose) == (least > x));
        }
        fcl::CollisionResultd yes, all;
        CHECK((collide(&tree, treePose, body.get(), where, {1, false}, yes) > 0) == (least <= 0));
        collide(body.get(), where, &tree, treePose, {1000000, false}, all);
        if (!surface) CHECK(all.numContacts() == meeting);
      }
  }
  CHECK((hits > trials(100) && apart > trials(60)));
}

TEST_CASE("a tree of free cells alone is nowhere near anything, and meets nothing") {
  const auto cells = std::make_shared<octomap::OcTree>(0.1);
  cells->updateNode(octomap::point3d(0.3F, 0.1F, 0.2F), false);
  cells->updateNode(octomap::point3d(1.3F, 0.1F, 0.2F), false);
  const fcl::OcTreed tree(cells);
  auto others = bodies();
  others.push_back(std::make_shared<fcl::OcTreed>(Map(Marks::current).cells));
  others.push_back(std::make_shared<fcl::OcTreed>(cells));
  constexpr double kFar = std::numeric_limits<double>::max();
  const Isometry3d here = at(0, 0, 0), nowhere = at(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  SteadyMotion still, past;
  past.linear = {1, 0, 0};
  for (const auto& other : others) {
    for (const bool first : {true, false}) {
      const DistanceAnswer d =
          first ? distance(tree, here, *other, here) : distance(*other, here, tree, here);
      CHECK(d.status == DistanceStatus::exact);
      CHECK((d.distance == kFar && d.lower == kFar && d.upper > kFar));
      CHECK((d.normal.isZero(0) && d.gradient[0].isZero(0) && d.gradient[1].isZero(0)));
      CHECK(toFclResult(d).min_distance == kFar);  // as in FCL
    }
    CHECK(distance(tree, here, *other, nowhere).status == DistanceStatus::invalid);
    CHECK(isFartherThan(0.0, tree, here, *other, here));
    fcl::CollisionResultd none;
    CHECK(collide(&tree, here, other.get(), here, {1, true}, none) == 0);
    CHECK(firstContact(tree, still, *other, past).verdict == MotionVerdict::free);
    CHECK(firstContact(*other, past, tree, still).verdict == MotionVerdict::free);
  }
}

TEST_CASE("space known to be free costs a query nothing") {
  const Map map(Marks::current), bare(Marks::noFreeCells);
  const fcl::OcTreed known(map.cells), unknown(bare.cells);
  Random random(8);
  for (const auto& body : bodies())
    for (int i = 0; i < 20; ++i) {
      const Isometry3d where = pose(random.rotation(), random.uniform(0, 1) * random.direction());
      const auto work = [&](const fcl::OcTreed& tree) {
        ProximityCounts counts;
        QueryContext context;
        context.proximity = &counts;
        isFartherThan(0.0, tree, at(0, 0, 0), *body, where, context);
        return counts.bounds;
      };
      CHECK(work(known) <= work(unknown) + 8);
      if (body->getNodeType() != fcl::BV_OBBRSS) CHECK(work(known) < 250);
    }
}
TEST_CASE("a scene's free map hides nothing else in it") {
  const auto cells = std::make_shared<octomap::OcTree>(kCell);
  cells->updateNode(octomap::point3d(0.1F, 0, 0), false);
  const auto tree = std::make_shared<fcl::OcTreed>(cells);
  fcl::CollisionObjectd map(tree), ball(std::make_shared<fcl::Sphered>(0.1)),
      box(std::make_shared<fcl::Boxd>(0.2, 0.2, 0.2), at(1, 0, 0)),
      none(std::make_shared<fcl::Sphered>(-1.0));
  DistanceData data;
  double dist = std::numeric_limits<double>::max();
  CHECK(toFclResult(data.result).min_distance == dist);  // as in FCL, before the first pair
  distanceCallback(&map, &ball, &data, dist);
  CHECK((data.result.status == DistanceStatus::exact && data.result.object[0] == &map));
  CHECK(toFclResult(data.result).min_distance == std::numeric_limits<double>::max());
  CHECK(dist < std::numeric_limits<double>::max());
  distanceCallback(&ball, &box, &data, dist);
  CHECK(data.result.distance == Approx(0.8).margin(1e-15));
  CHECK(data.invalid == 0);
  distanceCallback(&map, &none, &data, dist);  // not even the map is clear of an invalid body
  CHECK(data.result.distance == -std::numeric_limits<double>::infinity());
}
#endif
