// Objects that may be shared between threads: volumes and geometries by any number of threads, a batch by its
// own threads. Built with the thread sanitizer (preset tsan), this test finds races.
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/config.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/geometric_shape_to_BVH_model.h>
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <string>
#include <thread>
#include <vector>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/batch.h"
#include "fcl_stpbv/robot/worker_pool.h"
#include "test/reference/robots.h"

namespace fcl_stpbv::test {
namespace {

using namespace detail;

Eigen::Isometry3d turned(int k) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(0.1 * k, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(0.5, 0.01 * k, 0);
  return pose;
}

/// One geometry of each kind, shared by all threads.
std::vector<std::shared_ptr<fcl::CollisionGeometryd>> everyKind() {
  std::vector<std::shared_ptr<fcl::CollisionGeometryd>> all{
      std::make_shared<StpBvGeometry>(StpBv::build(box(0.2, 0.1, 0.3))),
      std::make_shared<fcl::Sphered>(0.1),
      std::make_shared<fcl::Capsuled>(0.1, 0.3),
      std::make_shared<fcl::Ellipsoidd>(0.1, 0.2, 0.3),
      std::make_shared<fcl::Boxd>(0.1, 0.2, 0.3),
      std::make_shared<fcl::Cylinderd>(0.1, 0.3),
      std::make_shared<fcl::Coned>(0.1, 0.3),
      std::make_shared<fcl::Halfspaced>(Eigen::Vector3d(0, 0, 1), -0.2),
      std::make_shared<fcl::Planed>(Eigen::Vector3d(0, 0, 1), -0.2),
      std::make_shared<fcl::TrianglePd>(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0),
                                        Eigen::Vector3d(0, 1, 0))};
  all.push_back(hullGeometry(randomHull(30, {0.2, 0.1, 0.15}, 3)));
  const auto add = [&](auto mesh) {
    fcl::generateBVHModel(*mesh, fcl::Sphered(0.2), fcl::Transform3d::Identity(), 8, 8);
    all.push_back(mesh);
  };
  add(std::make_shared<fcl::BVHModel<fcl::AABBd>>());
  add(std::make_shared<fcl::BVHModel<fcl::OBBd>>());
  add(std::make_shared<fcl::BVHModel<fcl::RSSd>>());
  add(std::make_shared<fcl::BVHModel<fcl::kIOSd>>());
  add(std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>());
  add(std::make_shared<fcl::BVHModel<fcl::KDOP<double, 16>>>());
  add(std::make_shared<fcl::BVHModel<fcl::KDOP<double, 18>>>());
  add(std::make_shared<fcl::BVHModel<fcl::KDOP<double, 24>>>());
#if FCL_HAVE_OCTOMAP
  auto cells = std::make_shared<octomap::OcTree>(0.05);
  for (int i = 0; i < 30; ++i) cells->updateNode(0.01f * static_cast<float>(i), 0.1f, 0.02f, true);
  all.push_back(std::make_shared<fcl::OcTreed>(cells));
#endif
  return all;
}

}  // namespace

TEST_CASE("an exception from a caller's progress function reaches the caller, for any number of threads") {
  for (const int threads : {1, 2, 4}) {
    std::atomic<int> done = 0;
    const auto work = [&] {
      shareOut(
          8, threads, [&](std::size_t) { ++done; },
          [](std::size_t i) {
            if (i == 3) throw Error("enough");
          });
    };
    CHECK_THROWS_WITH(work(), "enough");
    CHECK(done == 7);
    std::vector<std::size_t> told;
    shareOut(
        200, threads, [](std::size_t) {}, [&](std::size_t i) { told.push_back(i); });
    CHECK((told.size() == 200 && std::is_sorted(told.begin(), told.end())));
  }
}

TEST_CASE("a pool waits for all of its work before it throws what a piece has thrown, and works on") {
  for (const int threads : {1, 2, 4}) {
    WorkerPool pool(threads);
    for (int round = 0; round < 100; ++round) {
      std::atomic<int> done = 0;
      const auto work = [&] {
        pool.share(50, [&](int k, std::size_t i) {
          if (k < 0 || k >= pool.threads()) throw Error("no such thread");
          if (i >= 20 && i < 30) throw Error("piece " + std::to_string(i));
          ++done;
        });
      };
      CHECK_THROWS_WITH(work(), "piece 20");
      CHECK(done == 40);
    }
  }
}

TEST_CASE("eight threads that share a geometry of every kind get the answers of one thread") {
  const StpBvGeometry link(StpBv::build(geodesicSphere(0.1, 2)));
  const auto linkShared = std::make_shared<StpBvGeometry>(StpBv::build(geodesicSphere(0.1, 2)));
  const auto kinds = everyKind();
  constexpr int kPoses = 20, kThreads = 8;
  // Each thread has its own object, which is made beforehand because FCL's constructor writes into the
  // geometry.
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
  for (int i = 0; i < 3 * (kThreads + 1); ++i)
    objects.push_back(std::make_unique<fcl::CollisionObjectd>(
        i % 3 == 0 ? linkShared : kinds[i % 3 == 1 ? 0 : 4], turned(9 * (i % 3))));
  const auto ask = [&](int thread, std::vector<double>& found) {
    const auto* own = &objects[static_cast<std::size_t>(3 * thread)];
    fcl::DynamicAABBTreeCollisionManagerd manager;
    manager.registerObjects({own[0].get(), own[1].get(), own[2].get()});
    for (int k = 0; k < kPoses; ++k) {
      for (const auto& kind : kinds)
        found.push_back(distance(link, Eigen::Isometry3d::Identity(), *kind, turned(k)).distance);
      for (std::size_t i = 0; i < kinds.size(); ++i)  // each kind with another one
        found.push_back(isFartherThan(0.05, *kinds[i], Eigen::Isometry3d::Identity(),
                                      *kinds[(i + static_cast<std::size_t>(k)) % kinds.size()], turned(k)));
      own[0]->setTransform(turned(k));
      own[0]->computeAABB();
      manager.update();
      DistanceData data;
      manager.distance(&data, distanceCallback);
      found.push_back(data.result.distance);
    }
  };
  std::vector<double> alone;
  ask(kThreads, alone);
  std::vector<std::vector<double>> found(kThreads);
  std::vector<std::thread> threads;
  for (int i = 0; i < kThreads; ++i)
    threads.emplace_back([&, i] { ask(i, found[static_cast<std::size_t>(i)]); });
  for (auto& thread : threads) thread.join();
  for (const auto& list : found) CHECK(list == alone);
}

TEST_CASE("threads that share two geometries get the answers of one thread") {
  const StpBvGeometry first(StpBv::build(geodesicSphere(0.1, 2))), second(StpBv::build(box(0.2, 0.1, 0.3)));
  constexpr int kPoses = 200, kThreads = 4;
  const auto ask = [&](std::vector<double>& found) {
    PairCache cache;
    for (int k = 0; k < kPoses; ++k) {
      QueryContext context;
      if (k % 2 == 0) context.cache = &cache;  // the others start from FCL's witness
      found.push_back(distance(first, Eigen::Isometry3d::Identity(), second, turned(k), context).distance);
    }
  };
  std::vector<double> alone;
  ask(alone);
  std::vector<std::vector<double>> found(kThreads);
  std::vector<std::thread> threads;
  for (auto& list : found) threads.emplace_back([&] { ask(list); });
  for (auto& thread : threads) thread.join();
  for (const auto& list : found) CHECK(list == alone);  // the same instructions on the same numbers
}

TEST_CASE("volumes built in several threads at once are the same") {
  const Cloud points = randomHull(300, {0.1, 0.2, 0.15}, 7);
  std::vector<StpBv::Ptr> built(4);
  std::vector<std::thread> threads;
  for (auto& volume : built) threads.emplace_back([&] { volume = StpBv::build(points); });
  for (auto& thread : threads) thread.join();
  for (const auto& volume : built) {
    CHECK(volume->vertices() == built[0]->vertices());
    CHECK(volume->faces() == built[0]->faces());
  }
}

TEST_CASE("a batch of a robot's configurations in three threads is that of one") {
  const Problem p = problem(robots().front());
  const CollisionConstraints rows(p.kinematics, p.geometry, p.pairs);
  const CollisionChecker checker(p.kinematics, p.geometry, p.pairs);
  constexpr int kCount = 260;  // enough for pieces for all three threads
  Random random(6);
  Eigen::MatrixXd q(rows.columns(), kCount), d(rows.rows(), kCount), other = d;
  Eigen::Array<bool, Eigen::Dynamic, 1> hit(kCount), otherHit(kCount);
  for (int i = 0; i < kCount; ++i) q.col(i) = randomConfiguration(*p.kinematics, random);
  ConstraintsBatch(rows, 1).evaluate(q, Sequence::path, d);
  ConstraintsBatch(rows, 3).evaluate(q, Sequence::path, other);
  CheckerBatch(checker, 1).collides(q, Sequence::path, hit);
  CheckerBatch(checker, 3).collides(q, Sequence::path, otherHit);
  CHECK(d == other);
  CHECK((hit == otherHit).all());
}

}  // namespace fcl_stpbv::test
