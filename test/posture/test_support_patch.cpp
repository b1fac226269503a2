// A margin of the centre of mass from the support polygon's edges, as both are seen from above: contacts of
// any tilt against distances to their projected edges, derivatives against differences.
#include <catch2/catch.hpp>

#include "fcl_stpbv/posture/convex_polygon.h"
#include "fcl_stpbv/posture/support_patch.h"
#include "test/posture/arms.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const std::vector<Vector3d> kSole{
    {0.15, 0.1, -0.05}, {-0.15, 0.1, -0.05}, {-0.15, -0.1, -0.05}, {0.15, -0.1, -0.05}};

std::vector<Vector3d> randomPatch(Random& random) {
  std::vector<Vector3d> points;
  const Eigen::Matrix3d turn = random.rotation();
  for (int k = 3 + random.below(6); k > 0; --k)
    points.push_back(turn * Vector3d(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.03));
  return points;
}

// How far a point is inside the projection of some points; negative outside.
double depth(const Vector2d& p, const std::vector<Vector3d>& points, const Eigen::Isometry3d& link) {
  std::vector<Vector2d> seen;
  for (const Vector3d& point : points) seen.push_back((link * point).head<2>());
  const std::vector<Vector2d> hull = convexPolygon(seen);
  double least = 10;
  for (std::size_t i = 0; i < hull.size(); ++i)
    least = std::min(least, cross((hull[(i + 1) % hull.size()] - hull[i]).normalized(), p - hull[i]));
  return least;
}

bool roomy(const SupportPatch& patch) {
  for (int row = 0; row < patch.rooms(); ++row)
    if (patch.room(row) < 0) return false;
  return true;
}

// A link that is a ball of 1 kg, its centre of mass at y = 5 cm of a sole 20 cm wide, tilted about x.
Posture tilted(double angle, double margin) {
  static const PostureScene scene = bodiesOf(
      "<link name='foot'><inertial><origin xyz='0 0.05 -0.05'/><mass value='1'/>"
      "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>");
  PostureTask task;
  PostureTask::Place place =
      wholePose("foot", Eigen::Isometry3d(Eigen::AngleAxisd(angle, Vector3d::UnitX())));
  place.placement.free = {true, true, true, false, false, false};
  task.placements = {place};
  task.contacts = {{"foot", kSole}};
  task.stabilityMargin = margin;
  PostureSetup setup = setUpWithoutCollisions(task, scene);
  return findPosture(setup);
}

}  // namespace

TEST_CASE("a patch's corners keep the margin from its edges as they are seen from above, at any tilt") {
  Random random(1);
  int good = 0, narrow = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const std::vector<Vector3d> points = trial % 3 ? randomPatch(random) : kSole;
    const double margin = random.uniform(0.001, 0.05);
    try {
      SupportPatch patch(points, margin);
      const Eigen::Isometry3d link = pose(random.rotation(), random.direction());
      patch.place(link, Eigen::Matrix3d::Identity());
      Vector2d middle = Vector2d::Zero();
      for (int k = 0; k < patch.corners(); ++k) middle += patch.corner(k) / patch.corners();
      if (!roomy(patch)) {
        ++narrow;
        continue;
      }
      ++good;
      CHECK(depth(middle, points, link) >= margin - 1e-9);
      for (int k = 0; k < patch.corners(); ++k)
        CHECK(depth(patch.corner(k), points, link) == Approx(margin).margin(1e-7));
    } catch (const Error&) {  // narrower than twice the margin, lying flat
    }
  }
  CHECK(good > 500);
  CHECK(narrow > 50);
}

TEST_CASE("a rectangle has room for the margin as long as it is twice as wide from above") {
  Random random(2);
  for (int trial = 0; trial < 1000; ++trial) {
    const double margin = random.uniform(0.005, 0.05), angle = random.uniform(-M_PI, M_PI);
    SupportPatch patch(kSole, margin);
    patch.place(pose(Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix(), {1, 2, 3}),
                Eigen::AngleAxisd(random.uniform(-3, 3), Vector3d::UnitZ()).toRotationMatrix());
    const double width = 0.2 * std::abs(std::cos(angle));
    if (std::abs(width - 2 * margin) > 1e-9) CHECK(roomy(patch) == (width > 2 * margin));
  }
}

TEST_CASE("a patch's derivatives agree with differences, next to upright as well") {
  Random random(3);
  const double step = 1e-7;
  for (int trial = 0; trial < 400; ++trial) {
    const std::vector<Vector3d> points = trial % 2 ? randomPatch(random) : kSole;
    Eigen::Matrix3d turn = random.rotation();
    if (trial % 4 == 0)  // from flat to 3 degrees from upright, and beyond
      turn = Eigen::AngleAxisd(random.uniform(1.4, 1.6), Vector3d(1, 0.3, 0).normalized()).toRotationMatrix();
    const Eigen::Matrix3d world = random.rotation();
    try {
      SupportPatch patch(points, 0.01);
      const Eigen::Isometry3d link = pose(world.transpose() * turn, random.direction());
      const Twist twist{random.direction(), random.direction()};
      const auto moved = [&](double by) {
        const Eigen::AngleAxisd turned(by, twist.angular);
        return pose(turned * link.linear(), turned * link.translation() + by * twist.linear);
      };
      SupportPatch after = patch, before = patch;
      patch.place(link, world);
      after.place(moved(step), world);
      before.place(moved(-step), world);
      for (int k = 0; k < patch.corners(); ++k) {
        const Vector2d rate = patch.cornerRate(k, twist);
        CHECK(((after.corner(k) - before.corner(k)) / (2 * step) - rate).norm() < 1e-5 * (1 + rate.norm()));
      }
      for (int row = 0; row < patch.rooms(); ++row) {
        const double rate = patch.roomRate(row, twist);
        CHECK(std::abs((after.room(row) - before.room(row)) / (2 * step) - rate) <
              1e-5 * (1 + std::abs(rate)));
      }
    } catch (const Error&) {
    }
  }
}

TEST_CASE("points off one plane make the margin wider by as much") {
  std::vector<Vector3d> bent = kSole;
  bent[0].z() += 0.02;
  SupportPatch patch(bent, 0.02);
  Random random(4);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Isometry3d link = pose(random.rotation(), random.direction());
    patch.place(link, Eigen::Matrix3d::Identity());
    if (!roomy(patch)) continue;
    for (int k = 0; k < patch.corners(); ++k) CHECK(depth(patch.corner(k), bent, link) >= 0.02 - 1e-9);
  }
}

TEST_CASE("corners that the margin swallows, next to straight ones and needles") {
  // A disc of short edges, a rectangle with a corner cut off, one with a corner that hardly stands out.
  std::vector<Vector3d> disc, cut = kSole, flat = kSole;
  for (int k = 0; k < 200; ++k)
    disc.push_back(0.1 * Vector3d(std::cos(k * M_PI / 100), std::sin(k * M_PI / 100), 0));
  cut[0] = {0.15, 0.099, -0.05};
  cut.push_back({0.149, 0.1, -0.05});
  flat.push_back({0, 0.1 + 1e-12, -0.05});
  CHECK(shrunk(disc, 0.02).size() == 200);
  CHECK(shrunk(cut, 0.02).size() == 4);
  CHECK(shrunk(flat, 0.02).size() == 4);
  for (const Vector3d& p : shrunk(disc, 0.02)) CHECK(p.norm() < 0.0801);
  CHECK_THROWS_WITH(shrunk(kSole, 0.1 + 1e-9), Catch::Contains("smaller margin"));
  CHECK_THROWS_WITH(shrunk({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, 0.01), Catch::Contains("smaller margin"));
}

TEST_CASE("a foot that stands on a slope keeps the margin as it is seen from above") {
  for (const double angle : {0.0, 0.6, 1.0, 1.3, -1.0}) {
    const double left = 0.05 * std::cos(angle);  // from the centre of mass to the nearer edge
    INFO(angle);
    CHECK(tilted(angle, left - 1e-4).feasible);
    const Posture posture = tilted(angle, left + 1e-4);
    REQUIRE_FALSE(posture.feasible);
    CHECK(posture.conflict.front().name.find("stability") == 0);
  }
  // A foot that stands next to upright has no margin at all.
  CHECK(tilted(1.54, 0).feasible);
  CHECK_FALSE(tilted(1.54, 1e-6).feasible);
}

TEST_CASE("a margin's rows in a problem agree with differences") {
  Random random(5);
  const PostureScene scene = bodiesOf(ball("base") + ball("leg", 0.1) +
                                      joint("j", "revolute", "base", "leg",
                                            "<origin xyz='0 0 -0.1'/><axis xyz='0 1 0'/><limit lower='-2' "
                                            "upper='2' effort='1' velocity='1'/>"));
  PostureTask task;
  task.contacts = {{"base", kSole}, {"leg", kSole}};
  task.stabilityMargin = 0.02;
  const PostureSetup setup = setUpWithoutCollisions(task, scene);
  PostureProblem& problem = *setup.problem;
  CHECK(problem.inequalities() == 10);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::VectorXd x(problem.variables());
    for (int i = 0; i < x.size(); ++i) x[i] = random.uniform(-0.8, 0.8);
    const PostureValues at = problem.evaluate(x);
    for (int i = 0; i < x.size(); ++i) {
      const Eigen::VectorXd step = 1e-6 * Eigen::VectorXd::Unit(x.size(), i);
      const PostureValues after = problem.evaluate(x + step), before = problem.evaluate(x - step);
      CHECK(((after.equal - before.equal) / 2e-6 - at.equalJacobian.col(i)).norm() < 1e-6);
      CHECK(((after.atLeast - before.atLeast) / 2e-6 - at.atLeastJacobian.col(i)).norm() < 1e-6);
    }
  }
}
