// What may be shared between threads is: volumes and geometries by any number, a constraint's rows by its own pool.
// Built with the thread sanitizer (preset tsan) this is what finds a race.
#include <catch2/catch.hpp>
#include <thread>

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/robot/constraints.h"
#include "test/robot/robots.h"

namespace fcl_stpbv::test {
namespace {

Eigen::Isometry3d turned(int k) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(0.1 * k, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(0.5, 0.01 * k, 0);
  return pose;
}

}  // namespace

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

TEST_CASE("constraints shared out among three threads are those of one") {
  const Problem p = problem(robots().front());
  ConstraintOptions options;
  CollisionConstraints alone(p.kinematics, p.geometry, p.pairs, options);
  options.threads = 3;
  CollisionConstraints shared(p.kinematics, p.geometry, p.pairs, options);
  Eigen::VectorXd q = p.kinematics->neutral(), d(alone.rows()), other(alone.rows());
  for (int step = 0; step < 20; ++step) {
    alone.evaluate(q, d);
    shared.evaluate(q, other);
    CHECK(d == other);
    q.array() += 0.01;
  }
}

}  // namespace fcl_stpbv::test
