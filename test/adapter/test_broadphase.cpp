// FCL's seven broadphase managers with this library's callbacks find the nearest or deepest pair of random
// scenes; the reference checks all pairs. Also tests pairs left out, stops at contact, caches, and pairs
// without an answer.
#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_SaP.h>
#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/broadphase/broadphase_interval_tree.h>
#include <fcl/broadphase/broadphase_spatialhash.h>
#include <fcl/geometry/shape/sphere.h>

#include <catch2/catch.hpp>
#include <map>
#include <memory>
#include <string>

#include "fcl_stpbv/adapter/collide.h"
#include "fcl_stpbv/adapter/fcl_distance.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;
using Eigen::Vector3d;

namespace {

using Manager = fcl::BroadPhaseCollisionManagerd;
using Scene = std::vector<std::shared_ptr<fcl::CollisionObjectd>>;

std::map<std::string, std::unique_ptr<Manager>> allManagers() {
  using Hash =
      fcl::detail::SparseHashTable<fcl::AABBd, fcl::CollisionObjectd*, fcl::detail::SpatialHash<double>>;
  std::map<std::string, std::unique_ptr<Manager>> managers;
  managers["DynamicAABBTree"] = std::make_unique<fcl::DynamicAABBTreeCollisionManagerd>();
  managers["DynamicAABBTreeArray"] = std::make_unique<fcl::DynamicAABBTreeCollisionManager_Arrayd>();
  managers["IntervalTree"] = std::make_unique<fcl::IntervalTreeCollisionManagerd>();
  managers["Naive"] = std::make_unique<fcl::NaiveCollisionManagerd>();
  managers["SaP"] = std::make_unique<fcl::SaPCollisionManagerd>();
  managers["SSaP"] = std::make_unique<fcl::SSaPCollisionManagerd>();
  managers["SpatialHash"] = std::make_unique<fcl::SpatialHashingCollisionManager<double, Hash>>(
      0.5, Vector3d::Constant(-3), Vector3d::Constant(3), 1000);
  return managers;
}

/// `count` bodies at random in a cube with this half side.
Scene randomScene(int count, double half, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::shared_ptr<StpBvGeometry>> kinds;
  for (const Cloud& cloud :
       {box(0.1, 0.15, 0.2), geodesicSphere(0.1, 1), cylinder(0.05, 0.3, 12), plate(0.2, 0.1)})
    kinds.push_back(std::make_shared<StpBvGeometry>(StpBv::build(cloud, {0.01, 5})));
  Scene scene;
  for (int i = 0; i < count; ++i) {
    const Vector3d t(random.uniform(-half, half), random.uniform(-half, half), random.uniform(-half, half));
    scene.push_back(std::make_shared<fcl::CollisionObjectd>(kinds[static_cast<std::size_t>(i) % kinds.size()],
                                                            pose(random.rotation(), t)));
  }
  return scene;
}

double bruteForce(const Scene& scene) {
  double least = std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < scene.size(); ++i)
    for (std::size_t j = i + 1; j < scene.size(); ++j)
      least = std::min(least, distance(*scene[i], *scene[j]).distance);
  return least;
}

DistanceData ask(Manager& manager, const Scene& scene, DistanceData data = {}) {
  for (const auto& object : scene) manager.registerObject(object.get());
  manager.setup();
  manager.distance(&data, distanceCallback);
  manager.clear();
  return data;
}

}  // namespace

TEST_CASE("every manager finds the closest pair of a separated scene") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scene scene = randomScene(15, 2.0, seed);
    const double expected = bruteForce(scene);
    for (auto& [name, manager] : allManagers()) {
      CAPTURE(name, seed);
      const DistanceData data = ask(*manager, scene);
      CHECK(std::abs(data.result.distance - expected) <= 1e-13);
      CHECK(data.result.continuous);
      REQUIRE(data.result.object[0] != nullptr);
      CHECK(std::abs(distance(*data.result.object[0], *data.result.object[1]).distance - expected) <= 1e-13);
    }
  }
}

TEST_CASE("parts of one body are left out, and every manager finds the nearest parts of two bodies") {
  Random random(4);
  for (int trial = 0; trial < 20; ++trial) {
    Scene scene;
    int bodies[3];
    double expected = std::numeric_limits<double>::max();
    for (int& body : bodies) {
      const Eigen::Isometry3d at = pose(random.rotation(), 0.6 * random.direction());
      for (const double side : {-0.1, 0.1}) {  // two bars that overlap in the middle
        Cloud bar = box(0.3, 0.05, 0.05);
        for (Vector3d& p : bar) p.x() += side;
        const auto part = std::make_shared<StpBvGeometry>(StpBv::build(bar, {0.01, 5}));
        scene.push_back(std::make_shared<fcl::CollisionObjectd>(part, at));
        scene.back()->setUserData(&body);
      }
    }
    for (std::size_t i = 0; i < scene.size(); ++i)
      for (std::size_t j = i + 1; j < scene.size(); ++j)
        if (i / 2 != j / 2) expected = std::min(expected, distance(*scene[i], *scene[j]).distance);
    DistanceData settings;
    settings.leaveOut = [](const auto* a, const auto* b) { return a->getUserData() == b->getUserData(); };
    for (auto& [name, manager] : allManagers()) {
      CAPTURE(name, trial);
      const DistanceData data = ask(*manager, scene, settings);
      CHECK(std::abs(data.result.distance - expected) <= 1e-13);
      REQUIRE(data.result.object[0]);
      CHECK(data.result.object[0]->getUserData() != data.result.object[1]->getUserData());
    }
    fcl::NaiveCollisionManagerd naive;
    for (const auto& object : scene) naive.registerObject(object.get());
    CollisionData contact;
    contact.leaveOut = settings.leaveOut;
    naive.collide(&contact, collisionCallback);
    CHECK(contact.result.isCollision() == (expected <= 0));
    contact = {};
    naive.collide(&contact, collisionCallback);
    CHECK(contact.result.isCollision());
  }
}

TEST_CASE("every manager finds the deepest pair of a crowded scene") {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Scene scene = randomScene(40, 0.5, seed);
    const double expected = bruteForce(scene);
    REQUIRE(expected < -0.02);
    for (auto& [name, manager] : allManagers()) {
      CAPTURE(name, seed);
      CHECK(std::abs(ask(*manager, scene).result.distance - expected) <= 1e-13);
    }
  }
}

TEST_CASE("stopping at contact asks no more pairs than needed to find one") {
  const Scene scene = randomScene(40, 0.5, 3);
  for (auto& [name, manager] : allManagers()) {
    CAPTURE(name);
    DistanceData data;
    data.stopAtContact = true;
    const DistanceData stopped = ask(*manager, scene, data), full = ask(*manager, scene);
    CHECK(stopped.result.distance <= 0);
    CHECK(stopped.pairs <= full.pairs);
  }
}

TEST_CASE("data that is done is left alone") {
  const Scene scene = randomScene(10, 2.0, 5);
  DistanceData data;
  data.done = true;
  fcl::NaiveCollisionManagerd manager;
  data = ask(manager, scene, data);
  CHECK(data.pairs == 0);
  CHECK(data.result.distance == std::numeric_limits<double>::max());
}

TEST_CASE("data accumulates over queries until it is cleared") {
  fcl::NaiveCollisionManagerd manager;
  DistanceData data = ask(manager, randomScene(10, 1.0, 7));
  const double first = data.result.distance;
  data = ask(manager, randomScene(10, 20.0, 8), data);
  CHECK(data.result.distance == first);
  data.clear();
  data = ask(manager, randomScene(10, 20.0, 8), data);
  CHECK(data.result.distance > first);
}

TEST_CASE("pair caches change the work of a manager's query, not its answer") {
  const Scene scene = randomScene(15, 1.5, 9);
  PairCaches caches;
  fcl::NaiveCollisionManagerd manager;
  DistanceData data;
  data.caches = &caches;
  MappingCounts counts;
  data.mapping = &counts;
  const DistanceData cold = ask(manager, scene, data);
  const long asked = counts.total();
  CHECK(asked > 0);
  const DistanceData warm = ask(manager, scene, data);
  CHECK(counts.total() == asked);
  CHECK(caches.size() == cold.pairs);
  CHECK(std::abs(warm.result.distance - cold.result.distance) <= 1e-14);
}

TEST_CASE("pairs of simple shapes in a scene are answered, and marked as not continuous") {
  Scene scene = randomScene(8, 1.5, 11);
  const auto ball = std::make_shared<fcl::Sphered>(0.1);
  scene.push_back(
      std::make_shared<fcl::CollisionObjectd>(ball, pose(Eigen::Matrix3d::Identity(), {5, 0, 0})));
  scene.push_back(
      std::make_shared<fcl::CollisionObjectd>(ball, pose(Eigen::Matrix3d::Identity(), {5.201, 0, 0})));
  for (auto& [name, manager] : allManagers()) {
    CAPTURE(name);
    const DistanceData data = ask(*manager, scene);
    CHECK(data.result.distance == Approx(0.001).margin(1e-9));
    CHECK_FALSE(data.result.continuous);
  }
}

TEST_CASE("a pair without an answer is the result, whatever else is near") {
  const auto cube = std::make_shared<StpBvGeometry>(StpBv::build(box(0.2, 0.2, 0.2)));
  fcl::CollisionObjectd a(cube), b(cube, pose(Eigen::Matrix3d::Identity(), {0.5, 0, 0})), broken(cube);
  Eigen::Isometry3d nowhere = Eigen::Isometry3d::Identity(), skew = nowhere;
  nowhere.translation()[1] = std::nan("");
  skew.linear() *= 1.0 + 1e-5;
  skew.translation()[1] = 0.24;
  for (const Eigen::Isometry3d& wrong : {nowhere, skew})
    for (const bool first : {true, false}) {
      broken.setTransform(wrong);
      DistanceData data;
      double dist = std::numeric_limits<double>::max();
      const auto ask = [&](fcl::CollisionObjectd& other) {
        CHECK_FALSE(distanceCallback(&a, &other, &data, dist));
        CHECK((dist > 0 && dist < std::numeric_limits<double>::max()));
      };
      if (first) ask(broken);
      ask(b);
      if (first) CHECK(data.result.status == DistanceStatus::invalid);
      if (!first) {
        CHECK(dist == data.result.distance);
        ask(broken);
      }
      CHECK(data.result.status == DistanceStatus::invalid);
      CHECK(data.result.distance == -std::numeric_limits<double>::infinity());
      CHECK(data.result.object[1] == &broken);
      CHECK(data.invalid == 1);
      CHECK(data.pairs == 2);
      CHECK(toFclResult(data.result).min_distance == -1);
      data.clear();
      data.stopAtContact = true;
      CHECK(distanceCallback(&a, &broken, &data, dist));
    }
}
