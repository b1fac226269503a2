// A margin of the centre of mass from the support polygon's edges, both seen from above. Contacts of any tilt
// are compared with distances to their projected edges, and derivatives with differences.
#include <catch2/catch.hpp>

#include "fcl_stpbv/posture/support_patch.h"
#include "fcl_stpbv/volume/convex_polygon.h"
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

// The convex polygon of some points' projections.
std::vector<Vector2d> projected(const std::vector<Vector3d>& points, const Eigen::Isometry3d& link) {
  std::vector<Vector2d> seen, hull;
  for (const Vector3d& point : points) seen.push_back((link * point).head<2>());
  for (const int i : convexPolygon(seen)) hull.push_back(seen[static_cast<std::size_t>(i)]);
  return hull;
}

// How far a point is inside that polygon; negative outside.
double depth(const Vector2d& p, const std::vector<Vector3d>& points, const Eigen::Isometry3d& link) {
  const std::vector<Vector2d> hull = projected(points, link);
  double least = 10;
  for (std::size_t i = 0; i < hull.size(); ++i)
    least = std::min(least, cross((hull[(i + 1) % hull.size()] - hull[i]).normalized(), p - hull[i]));
  return least;
}

// Radius of the largest circle in the projection of some points. Circles that touch three of its edges are
// tried.
double largestCircle(const std::vector<Vector3d>& points, const Eigen::Isometry3d& link) {
  const std::vector<Vector2d> hull = projected(points, link);
  const auto edge = [&](std::size_t i) {
    const Vector2d along = (hull[(i + 1) % hull.size()] - hull[i]).normalized();
    return Vector3d(-along.y(), along.x(), -cross(along, hull[i]));  // of (p, 1): the distance of p
  };
  double most = -1;
  for (std::size_t i = 0; i < hull.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < j; ++k) {
        Eigen::Matrix3d lines;
        lines << edge(i).transpose(), edge(j).transpose(), edge(k).transpose();
        const Vector3d offsets = lines.col(2);
        lines.col(2).setConstant(-1);
        if (std::abs(lines.determinant()) < 1e-12) continue;
        const Vector2d centre = lines.inverse().topRows<2>() * -offsets;
        most = std::max(most, depth(centre, points, link));
      }
  return most;
}

bool roomy(const SupportPatch& patch) {
  for (int row = 0; row < patch.rooms(); ++row)
    if (patch.room(row) < 0) return false;
  return true;
}

// A link that is a ball of 1 kg, its centre of mass at y = 5 cm of a sole 20 cm wide, tilted about x.
Posture tilted(double angle, double margin, const std::vector<Vector3d>& sole = kSole) {
  static const PostureScene scene = bodiesOf(
      "<link name='foot'><inertial><origin xyz='0 0.05 -0.05'/><mass value='1'/>"
      "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>");
  PostureTask task;
  PostureTask::Place place =
      wholePose("foot", Eigen::Isometry3d(Eigen::AngleAxisd(angle, Vector3d::UnitX())));
  place.placement.free = {true, true, true, false, false, false};
  task.placements = {place};
  task.contacts = {{"foot", sole}};
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
    } catch (const Error&) {  // narrower than twice the margin when lying flat
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

TEST_CASE("a patch has room for the margin where a circle of it has, whichever edges the tilt leaves") {
  Random random(6);
  std::vector<Vector3d> chamfered{{0.12, 0.05, 0},   {0.11, 0.06, 0},  {-0.12, 0.06, 0},
                                  {-0.12, -0.06, 0}, {0.11, -0.06, 0}, {0.12, -0.05, 0}};
  int roomyOnes = 0, others = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const std::vector<Vector3d> points = trial % 2 ? randomPatch(random) : chamfered;
    const double margin = random.uniform(0.005, 0.05);
    const Eigen::Isometry3d link = pose(random.rotation(), random.direction());
    const double radius = largestCircle(points, link);
    if (std::abs(radius - margin) < 1e-7) continue;
    try {
      SupportPatch patch(points, margin);
      patch.place(link, Eigen::Matrix3d::Identity());
      if (patch.room(1) < 0) continue;  // almost upright
      INFO(trial << ' ' << radius << ' ' << margin);
      CHECK(patch.room(0) == Approx(radius - margin).margin(1e-7));
      ++(radius > margin ? roomyOnes : others);
      if (radius < margin) continue;
      for (int k = 0; k < patch.corners(); ++k)
        CHECK(depth(patch.corner(k), points, link) == Approx(margin).margin(1e-7));
    } catch (const Error&) {  // narrower than twice the margin when lying flat
    }
  }
  CHECK(roomyOnes > 500);
  CHECK(others > 50);
}

TEST_CASE("corners move on steadily where a tilt makes edges vanish and appear") {
  Random random(7);
  for (int trial = 0; trial < 40; ++trial) {
    const std::vector<Vector3d> points = randomPatch(random);
    const Vector3d axis = random.direction();
    try {
      SupportPatch patch(points, 0.01);
      SupportPatch before = patch;
      for (int step = 0; step <= 1000; ++step, before = patch) {
        patch.place(Eigen::Isometry3d(Eigen::AngleAxisd(step * 1.2 / 1000, axis)),
                    Eigen::Matrix3d::Identity());
        if (step == 0 || before.room(0) < 1e-3 || before.room(1) < 0.01) continue;
        CHECK(std::abs(patch.room(0) - before.room(0)) < 1e-3);
        for (int k = 0; k < patch.corners(); ++k) CHECK((patch.corner(k) - before.corner(k)).norm() < 0.01);
      }
    } catch (const Error&) {
    }
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
  // A disc with short edges, a rectangle with a corner cut off, and one with a corner that hardly protrudes.
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
    const double left = 0.05 * std::cos(angle);  // distance of the centre of mass from the nearer edge
    INFO(angle);
    CHECK(tilted(angle, left - 1e-4).feasible);
    const Posture posture = tilted(angle, left + 1e-4);
    REQUIRE_FALSE(posture.feasible);
    CHECK(posture.conflict.front().name.find("stability") == 0);
  }
  // Corners cut off by 1 cm are smaller than the margin when flat, but larger on a slope, or the other way
  // round.
  std::vector<Vector3d> cut;
  for (const double y : {0.1, -0.1}) {
    cut.emplace_back(std::copysign(0.15, y), y * 0.9, -0.05);
    cut.emplace_back(std::copysign(0.14, y), y, -0.05);
    cut.emplace_back(std::copysign(0.14, -y), y, -0.05);
    cut.emplace_back(std::copysign(0.15, -y), y * 0.9, -0.05);
  }
  for (const double margin : {0.014, 0.0155, 0.0165, 0.0175, 0.02}) {
    INFO(margin);
    CHECK(tilted(0.64, margin, cut).feasible);
    CHECK(tilted(-0.9, margin, cut).feasible);
  }
  // A foot that is almost upright has no margin.
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
  CHECK(problem.inequalities() == 4);
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
