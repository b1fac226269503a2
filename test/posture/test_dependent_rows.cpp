// Tasks whose equalities depend on each other: arms that cannot leave their plane or tilt their tool, targets
// named twice, two frames of one link. Answers are compared with closed forms and a dense search.
#include <catch2/catch.hpp>

#include "fcl_stpbv/posture/independent_rows.h"
#include "test/posture/arms.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

using Eigen::Vector2d;

// Both solutions of links l1 and l2 from the origin to p: the angle of the first joint, and the second one's
// relative to it.
std::vector<Vector2d> elbows(const Vector2d& p, double l1, double l2) {
  const double cosine = (p.squaredNorm() - l1 * l1 - l2 * l2) / (2 * l1 * l2);
  std::vector<Vector2d> both;
  if (std::abs(cosine) > 1) return both;
  for (const double b : {std::acos(cosine), -std::acos(cosine)})
    both.emplace_back(std::atan2(p.y(), p.x()) - std::atan2(l2 * std::sin(b), l1 + l2 * std::cos(b)), b);
  return both;
}

// Many starts, because limits stop the first few in some cases.
PostureOptions manyStarts() {
  PostureOptions options;
  options.starts = 50;
  return options;
}

double wrapped(double angle) { return std::remainder(angle, 2 * M_PI); }
Vector2d along(double angle) { return {std::cos(angle), std::sin(angle)}; }

// Least cost of the planar arm's postures that hold the tip where q does, each joint within `reach` of q:
// the first joint in steps of at most 2.4e-4 rad, the others in closed form.
double leastCost(const Kinematics& kinematics, const Eigen::VectorXd& q, double reach) {
  const Eigen::VectorXd reference = quarterCost(kinematics).reference;
  const Eigen::VectorXd low = kinematics.lower().cwiseMax((q.array() - reach).matrix());
  const Eigen::VectorXd high = kinematics.upper().cwiseMin((q.array() + reach).matrix());
  const Vector2d tip = 0.6 * along(q[0]) + 0.4 * along(q[0] + q[1]) + 0.3 * along(q.sum());
  constexpr int kSteps = 20000;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    const double a = low[0] + (high[0] - low[0]) * i / kSteps;
    for (const Vector2d& bc : elbows(tip - 0.6 * along(a), 0.4, 0.3)) {
      const Eigen::Vector3d x(a, wrapped(bc.x() - a), bc.y());
      if ((x.array() >= low.array()).all() && (x.array() <= high.array()).all())
        least = std::min(least, (x - reference).squaredNorm());
    }
  }
  return least;
}

}  // namespace

TEST_CASE("independent combinations span what dependent rows move") {
  Random random(1);
  RowMatrix rows(6, 4);
  for (int i = 0; i < rows.size(); ++i) rows.data()[i] = random.uniform(-1, 1);
  CHECK(detail::independentCombinations(rows.topRows(4), 1e-6) == Eigen::MatrixXd::Identity(4, 4));
  CHECK(detail::independentCombinations(rows, 1e-6).cols() == 4);
  rows.row(1).setZero();
  rows.row(3) = rows.row(2);
  rows.row(4) = rows.row(0) - 2 * rows.row(2);
  rows.row(5) = rows.row(0) + 1e-9 * rows.row(5);
  const Eigen::MatrixXd u = detail::independentCombinations(rows, 1e-6);
  REQUIRE(u.cols() == 2);
  CHECK((u.transpose() * u - Eigen::MatrixXd::Identity(2, 2)).norm() < 1e-12);
  CHECK((u * u.transpose() * rows - rows).norm() < 1e-8);
  CHECK(detail::independentCombinations(RowMatrix::Zero(3, 2), 1e-6).cols() == 0);
  CHECK(detail::independentCombinations(RowMatrix(3, 0), 1e-6).cols() == 0);
}

TEST_CASE("a planar arm reaches points of its plane at least cost") {
  Random random(2);
  for (const std::string mount : {"rpy='0 0 0'", "xyz='0.2 -0.1 0.5' rpy='0.4 -0.8 1.9'"}) {
    const PostureScene scene = planarArm(mount);
    const Kinematics kinematics(scene.robot, BaseMotion::fixed);
    int least = 0;
    for (int trial = 0; trial < 40; ++trial) {
      const Eigen::VectorXd q = randomWithin(scene, random);
      const Eigen::Vector3d target = poseOf(scene, q, "tip").translation();
      const Posture posture = found(scene, {position("tip", target)}, manyStarts());
      INFO(mount << ", reached by " << q.transpose());
      REQUIRE(posture.feasible);
      CHECK((poseOf(scene, posture.q, "tip").translation() - target).norm() < 2e-6);
      CHECK(posture.cost < leastCost(kinematics, posture.q, 0.02) + 2e-5);
      least += posture.cost < leastCost(kinematics, q, 10) + 1e-4;
    }
    CHECK(least >= 30);  // the others are only local minima
  }
}

TEST_CASE("a row that a planar arm cannot move changes nothing") {
  Random random(3);
  const PostureScene scene = planarArm();
  int same = 0;
  for (int trial = 0; trial < 40; ++trial) {
    PostureTask::Place place =
        position("tip", poseOf(scene, randomWithin(scene, random), "tip").translation());
    const Posture with = found(scene, {place}, manyStarts());
    place.placement.free[1] = true;  // y
    const Posture without = found(scene, {place}, manyStarts());
    CHECK(with.feasible);
    CHECK(without.feasible);
    same += std::abs(with.cost - without.cost) < 1e-4;
  }
  CHECK(same >= 38);  // another local minimum may be equally near
}

TEST_CASE("a SCARA, of fewer joints than a pose has rows, takes one of its two postures") {
  const PostureScene scene = scara();
  Random random(4);
  int feasible = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const Eigen::VectorXd q = randomWithin(scene, random);
    const Eigen::Isometry3d target = poseOf(scene, q, "tool");
    const Posture posture = found(scene, {wholePose("tool", target)});
    CHECK(posture.feasible == posture.conflict.empty());
    if (!posture.feasible) continue;  // limits prevent some
    ++feasible;
    double nearest = 10;
    for (const Vector2d& ab : elbows(target.translation().head<2>(), 0.4, 0.4)) {
      const double d = q[0] + q[1] + q[3] - ab.sum();
      const Eigen::Vector4d away(wrapped(posture.q[0] - ab[0]), wrapped(posture.q[1] - ab[1]),
                                 posture.q[2] - q[2], wrapped(posture.q[3] - d));
      nearest = std::min(nearest, away.cwiseAbs().maxCoeff());
    }
    CHECK(nearest < 1e-4);
  }
  CHECK(feasible >= 50);
}

TEST_CASE("a SCARA whose tool may turn leaves the last joint at its reference") {
  PostureTask::Place place = wholePose("tool", at(0.5, 0.2, 0.05));
  place.placement.free[5] = true;
  const Posture posture = found(scara(), {place});
  REQUIRE(posture.feasible);
  CHECK(posture.starts == 1);
  CHECK(posture.q[2] == Approx(-0.05).margin(1e-5));
  CHECK(std::abs(posture.q[3]) < 1e-4);
  double least = 10;
  for (const Vector2d& ab : elbows({0.5, 0.2}, 0.4, 0.4)) least = std::min(least, ab.squaredNorm());
  CHECK(posture.cost == Approx(least + 0.05 * 0.05).margin(1e-4));
}

TEST_CASE("a constraint that is given twice is fulfilled at the least cost") {
  Random random(5);
  const PostureScene scene = planarArm("rpy='0.4 -0.8 1.9'");
  const Kinematics kinematics(scene.robot, BaseMotion::fixed);
  int poses = 0;
  for (int trial = 0; trial < 30; ++trial) {
    const Eigen::VectorXd q = randomWithin(scene, random);
    const PostureTask::Place tip = position("tip", poseOf(scene, q, "tip").translation());
    const Posture twice = found(scene, {tip, tip}, manyStarts());
    INFO("reached by " << q.transpose());
    REQUIRE(twice.feasible);
    CHECK(twice.cost < leastCost(kinematics, twice.q, 0.02) + 2e-5);
    // A frame of the same link, in addition to the link's pose.
    const Eigen::Isometry3d hand = poseOf(scene, q, "hand");
    const Posture frames = found(scene, {wholePose("hand", hand), tip}, manyStarts());
    CHECK(frames.feasible == frames.conflict.empty());
    if (!frames.feasible) continue;  // limits prevent some
    ++poses;
    CHECK((poseOf(scene, frames.q, "hand").matrix() - hand.matrix()).norm() < 1e-5);
  }
  CHECK(poses >= 27);
}

TEST_CASE("a row that only a fixed joint could move is no row of the model") {
  Random random(6);
  for (const double angle : {0.0, 0.7}) {
    const PostureScene scene = armWithFixedJoint(angle);
    int feasible = 0;
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::Isometry3d target = poseOf(scene, randomWithin(scene, random), "tip");
      const Posture posture = found(scene, {wholePose("tip", target)});
      CHECK(posture.feasible == posture.conflict.empty());
      if (!posture.feasible) continue;
      ++feasible;
      CHECK((poseOf(scene, posture.q, "tip").matrix() - target.matrix()).norm() < 1e-5);
    }
    CHECK(feasible >= 15);
  }
}
