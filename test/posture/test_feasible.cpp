// A posture reported as feasible is feasible, and an infeasible one has constraints that contradict each
// other.
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "test/posture/arms.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

double amountOf(const std::vector<Violation>& list, const std::string& name) {
  for (const Violation& v : list)
    if (v.name == name) return v.amount;
  return 0;
}

// For each coordinate, the row's violation is at least 5 cm except within 0.3 of `room`, and it has a local
// minimum at 0.
class Pockets : public PostureRows {
 public:
  Pockets(int coordinates, double room) : coordinates_(coordinates), room_(room) {}

  Kind kind() const override { return Kind::atLeast; }
  int size() const override { return coordinates_; }
  std::string name(int row) const override { return "pocket " + std::to_string(row); }
  void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values,
                Eigen::Ref<RowMatrix> jacobian) override {
    for (int i = 0; i < coordinates_; ++i) {
      const auto hill = [&](double height, double centre, double width) {
        const double u = (at.x[i] - centre) / width, value = height * std::exp(-u * u);
        values[i] += value;
        jacobian(i, i) -= 2 * u / width * value;
      };
      values[i] = -0.15;
      hill(0.1, 0, 0.5);
      hill(0.3, room_, 0.3);
    }
  }

 private:
  int coordinates_;
  double room_;
};

// Balls l0, l1, ... in a row by the joints j0, j1, ..., with `more(i)` in each.
template <class More>
std::string chain(int joints, More more) {
  std::string links = ball("l0");
  for (int i = 0; i < joints; ++i) {
    const std::string parent = std::to_string(i), child = std::to_string(i + 1);
    links += ball("l" + child) + joint("j" + parent, "revolute", "l" + parent, "l" + child, more(i));
  }
  return links;
}

Posture amongPockets(double room, std::uint64_t seed) {
  constexpr int kJoints = 8;
  const std::string arm = chain(kJoints, [](int) {
    return "<origin xyz='0.3 0 0'/><axis xyz='0 0 1'/>"
           "<limit lower='-3' upper='3' effort='1' velocity='1'/>";
  });
  PostureTask task;
  task.base = BaseMotion::fixed;
  PostureSetup setup = setUpWithoutCollisions(task, bodiesOf(arm));
  setup.problem->add(std::make_shared<Pockets>(kJoints, room));
  PostureOptions options;
  options.seed = seed;
  return findPosture(setup, options);
}

// Two or three joints between small balls, most of them at a limit before they reach far.
PostureScene smallArm(Random& random, int joints, double size) {
  const auto three = [&](double most) {
    std::string text;
    for (int i = 0; i < 3; ++i) text += std::to_string(random.uniform(-most, most)) + " ";
    return text;
  };
  const char* const axes[] = {"1 0 0", "0 1 0", "0 0 1"};
  std::string links = ball("l0");
  for (int i = 0; i < joints; ++i) {
    const bool slides = random.uniform(0, 3) < 1;
    const double unit = slides ? size : 1, lower = random.uniform(-0.6, 0.1) * unit;
    const double upper = lower + random.uniform(0.3, 2) * unit;
    const std::string parent = std::to_string(i), child = std::to_string(i + 1);
    links +=
        ball("l" + child) +
        joint("j" + parent, slides ? "prismatic" : "revolute", "l" + parent, "l" + child,
              "<origin xyz='" + three(size / 2) + "' rpy='" + three(3) + "'/><axis xyz='" +
                  axes[static_cast<int>(random.uniform(0, 3))] + "'/><limit lower='" + std::to_string(lower) +
                  "' upper='" + std::to_string(upper) + "' effort='1' velocity='1'/>");
  }
  return bodiesOf(links);
}

}  // namespace

TEST_CASE("a point off a planar arm's plane is told by its row across the plane") {
  const PostureScene scene = planarArm();
  for (const double off : {1e-5, 1e-3, 0.05}) {
    const Posture posture = found(scene, {position("tip", {0.5, off, 0.6})});
    INFO(off);
    CHECK_FALSE(posture.feasible);
    REQUIRE(posture.conflict.size() == 1);
    CHECK(posture.conflict[0].name == "tip y");
    CHECK(posture.conflict[0].amount == Approx(off));
    // The constraints that can be fulfilled are fulfilled.
    REQUIRE(posture.violations.size() == 1);
    CHECK(posture.violations[0].name == "tip y");
  }
}

TEST_CASE("a tilt that a SCARA cannot reach is reported, and the rest of its pose holds") {
  Eigen::Isometry3d target = at(0.5, 0.2, 0.05);
  target.linear() =
      (Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  const Posture posture = found(scara(), {wholePose("tool", target)});
  CHECK_FALSE(posture.feasible);
  CHECK(amountOf(posture.conflict, "tool rx") == Approx(0.02).epsilon(1e-3));
  CHECK(posture.violations[0].name == "tool rx");
  for (const char* row : {"tool x", "tool y", "tool z"}) CHECK(amountOf(posture.violations, row) < 1e-4);
}

TEST_CASE("two targets of one frame are reported, each violated by half of their distance") {
  const PostureScene scene = planarArm();
  for (const double apart : {1e-4, 0.01, 0.05}) {
    const Posture posture =
        found(scene, {position("tip", {0.5, 0, 0.6}), position("tip", {0.5 + apart, 0, 0.6}, "again")});
    INFO(apart);
    CHECK_FALSE(posture.feasible);
    REQUIRE(posture.conflict.size() == 2);
    CHECK(amountOf(posture.conflict, "tip x") == Approx(apart / 2).epsilon(1e-3));
    CHECK(amountOf(posture.conflict, "again x") == Approx(apart / 2).epsilon(1e-3));
  }
}

TEST_CASE("a point out of reach is reported") {
  const Posture posture = found(planarArm(), {position("tip", {0, 0, 1.31})});
  CHECK_FALSE(posture.feasible);
  CHECK(amountOf(posture.conflict, "tip z") == Approx(0.01).epsilon(1e-3));
}

TEST_CASE("the search ends by itself, also where the solver's line search would not") {
  Random random(3);
  PostureOptions options;
  options.starts = 1;
  options.repairs = options.anywhere = 0;
  options.solver.maxSeconds = 2;  // it takes a thousandth of this
  int missed = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const int joints = 2 + trial % 2;
    const double size = trial % 3 ? 0.05 : 1;
    const PostureScene scene = smallArm(random, joints, size);
    const Eigen::Vector3d target =
        0.6 * size * Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Posture posture = found(scene, {position("l" + std::to_string(joints), target)}, options);
    CAPTURE(trial);
    CHECK(posture.status != "out of time");
    CHECK(posture.seconds < options.solver.maxSeconds);
    missed += !posture.feasible;
  }
  CHECK(missed > 20);
}

TEST_CASE("where the arm is stretched its Jacobian is singular, and the point reached all the same") {
  const PostureScene scene = planarArm();
  for (const double height : {1.3, 1.299, 1.25, 1.0}) {
    const Posture posture = found(scene, {position("tip", {0, 0, height})});
    INFO(height);
    CHECK(posture.feasible);
    CHECK((poseOf(scene, posture.q, "tip").translation() - Eigen::Vector3d(0, 0, height)).norm() < 2e-6);
  }
}

TEST_CASE("where nothing is violated the posture is feasible, however early the solver stops") {
  Random random(7);
  const PostureScene scene = planarArm("rpy='0.4 -0.8 1.9'");
  PostureOptions options;
  options.starts = 1;
  int feasible = 0;
  for (const int iterations : {1, 2, 4}) {
    options.solver.maxIterations = iterations;
    for (int trial = 0; trial < 40; ++trial) {
      const Eigen::Vector3d target = poseOf(scene, randomWithin(scene, random), "tip").translation();
      const Posture posture = found(scene, {position("tip", target)}, options);
      CHECK(posture.feasible == posture.conflict.empty());
      CHECK(posture.feasible == posture.violations.empty());
      if (!posture.feasible) continue;
      ++feasible;
      CHECK((poseOf(scene, posture.q, "tip").translation() - target).norm() < 2e-6);
    }
  }
  CHECK(feasible >= 80);
}

TEST_CASE("a search that is stopped ends there, and tells of no conflict") {
  Random random(9);
  const PostureScene scene = planarArm();
  const Eigen::Vector3d near = poseOf(scene, randomWithin(scene, random), "tip").translation();
  for (const Eigen::Vector3d& target : {near, Eigen::Vector3d(9, 0, 9)})
    for (const int models : {0, 1, 2, 5, 20, 100}) {
      int asked = 0;
      PostureOptions options;
      options.starts = 100000;
      options.solver.stop = [&] { return ++asked > models; };
      const Posture posture = found(scene, {position("tip", target)}, options);
      CAPTURE(target, models, asked, posture.status);
      CHECK(asked <= models + 10);  // each part of the search evaluates once more
      CHECK(posture.feasible == posture.violations.empty());
      CHECK(posture.conflict.empty());
      CHECK((posture.feasible || posture.status == "stopped"));
    }
}

TEST_CASE("what a constraint or the call to stop throws reaches the caller, whenever it happens") {
  // Throws at its n-th evaluation.
  class Failing : public PostureRows {
   public:
    Failing(Kind kind, int after) : kind_(kind), left_(after) {}
    Kind kind() const override { return kind_; }
    int size() const override { return 1; }
    std::string name(int) const override { return "failing"; }
    void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values,
                  Eigen::Ref<RowMatrix> jacobian) override {
      if (left_-- == 0) throw std::domain_error("no value there");
      values[0] = at.x[0] - 0.1;
      jacobian(0, 0) = 1;
    }

   private:
    Kind kind_;
    int left_;
  };
  Random random(4);
  const PostureScene scene = planarArm();
  const PostureTask::Place place =
      position("tip", poseOf(scene, randomWithin(scene, random), "tip").translation());
  PostureTask task;
  task.base = BaseMotion::fixed;
  task.placements = {place};
  for (const PostureRows::Kind kind : {PostureRows::Kind::equal, PostureRows::Kind::atLeast}) {
    int thrown = 0;
    for (int after = 0; after < 60; ++after) {
      PostureSetup setup = setUpWithoutCollisions(task, scene);
      setup.problem->add(std::make_shared<Failing>(kind, after));
      PostureOptions options;
      options.starts = 1;
      options.repairs = options.anywhere = 0;
      try {
        findPosture(setup, options);
      } catch (const std::domain_error& error) {
        CHECK(std::string(error.what()) == "no value there");
        ++thrown;
        CHECK_NOTHROW(findPosture(setup, options));  // it throws once
      }
    }
    CHECK(thrown > 10);
  }
  PostureOptions options;
  options.solver.stop = []() -> bool { throw std::domain_error("enough"); };
  CHECK_THROWS_AS(found(scene, {place}, options), std::domain_error);
}

TEST_CASE("constraints of one joint each are freed one by one, where no random posture frees all at once") {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    CAPTURE(seed);
    const Posture posture = amongPockets(2, seed);
    CHECK(posture.feasible);
    for (const double q : posture.q) CHECK(std::abs(q - 2) < 0.3);
    CHECK(posture.conflict.empty());
  }
  const Posture none = amongPockets(9, 1);  // beyond the limits
  CHECK_FALSE(none.feasible);
  CHECK(none.conflict.size() == 8);
  CHECK(amountOf(none.conflict, "pocket 3") == Approx(0.05));
}

TEST_CASE("a robot without joints is where it is") {
  CHECK(found(block(), {position("base", {0, 0, 0})}).feasible);
  const Posture posture = found(block(), {position("base", {0, 0, 0.5})});
  CHECK_FALSE(posture.feasible);
  CHECK(amountOf(posture.conflict, "base z") == Approx(0.5));
  CHECK(posture.q.size() == 0);
}

TEST_CASE("the reported violation is the least one: no step within the limits reduces it") {
  const char* const axes[] = {"0 0 1", "0 1 0", "0.6 0 0.8", "0 1 0", "0.8 0.6 0"};
  const std::string arm = chain(5, [&](int i) {
    return "<origin xyz='0.3 0.1 0'/><axis xyz='" + std::string(axes[i]) +
           "'/><limit lower='-0.6' upper='0.4' effort='1' velocity='1'/>";
  });
  const PostureScene scene = bodiesOf(arm);
  const Kinematics kinematics(scene.robot, BaseMotion::fixed);
  Random random(5);
  int told = 0;
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::Isometry3d target = poseOf(scene, randomWithin(scene, random), "l5");
    target.linear() = random.rotation();
    const Posture posture = found(scene, {wholePose("l5", target)});
    if (posture.feasible) continue;
    ++told;
    const auto missed = [&](const Eigen::VectorXd& q) {
      const Eigen::Isometry3d off = target.inverse() * poseOf(scene, q, "l5");
      const double angle = Eigen::AngleAxisd(off.linear()).angle();
      return off.translation().squaredNorm() + angle * angle;
    };
    double sum = 0;
    for (const Violation& v : posture.conflict) sum += v.amount * v.amount;
    for (int step = 0; step < 200; ++step) {
      Eigen::VectorXd q = posture.q;
      for (Eigen::Index i = 0; i < q.size(); ++i) q[i] += random.uniform(-0.02, 0.02);
      q = q.cwiseMax(kinematics.lower()).cwiseMin(kinematics.upper());
      INFO(trial << ' ' << step);
      CHECK(missed(q) > sum * (1 - 1e-3));
    }
  }
  CHECK(told > 50);
}

TEST_CASE("the descent to what is least goes on to its end, along a way that is long and narrow") {
  const auto link = [](const std::string& name, const std::string& centre, const std::string& mass) {
    return "<link name='" + name + "'><inertial><origin xyz='" + centre + "'/><mass value='" + mass +
           "'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>";
  };
  const auto limits = [](const std::string& lower, const std::string& upper) {
    return "<limit lower='" + lower + "' upper='" + upper + "' effort='1' velocity='1'/>";
  };
  const PostureScene scene =
      bodiesOf(link("l0", "0.06 0.01 0.03", "3.2") + link("l1", "-0.056 0.06 -0.072", "4.5") +
               joint("j1", "revolute", "l0", "l1",
                     "<origin xyz='-0.1887 0.0289 -0.2484' rpy='-0.1 0 0.6'/><axis xyz='0 0 1'/>" +
                         limits("-1.6", "-1")) +
               "<link name='l2'/>" +
               joint("j2", "continuous", "l1", "l2",
                     "<origin xyz='0.06 0.27 -0.27' rpy='-0.8 0.06 0.36'/><axis xyz='-0.282 0.27 0.921'/>") +
               "<link name='l3'/>" +
               joint("j3", "revolute", "l2", "l3",
                     "<origin xyz='-0.145 0.193 0.213' rpy='-0.24 0.93 0.66'/><axis xyz='1 0 0'/>" +
                         limits("-0.3", "2")) +
               link("l4", "0.092 0.096 -0.073", "5") +
               joint("j4", "revolute", "l3", "l4",
                     "<origin xyz='0.29 0.25 -0.21' rpy='-0.33 -0.74 -0.95'/><axis xyz='1 0 0'/>" +
                         limits("-1", "1.5") + "<mimic joint='j2' multiplier='0.5' offset='-0.15'/>"));
  PostureSetup setup = setUpWithoutCollisions(parseTask(R"({"base": "fixed",
      "start": {"base": {"position": [0.06, -0.6876, -0.6083], "rpy": [-2.887, -0.213, 1.206]}},
      "placements": [{"link": "l1", "frame": {"position": [-0.0656, -0.0265, 0.04], "rpy": [-2, -2, 0]},
                      "target": {"position": [0.062, -0.9998, -0.472], "rpy": [0.4, 1.37, 1.88]},
                      "free": ["x", "y", "rx", "ry", "rz"]}],
      "stability": {"contacts": [
        {"link": "l1", "points": [[0.25, 0.06, -0.4], [0.42, 0.12, -0.3], [0.3, 0.11, -0.36], [0.49, 0, -0.3]]},
        {"link": "l4", "points": [[-0.002, -0.41, -0.06], [0.0743, -0.41, -0.13], [0.01, -0.4, -0.1],
            [0.03, -0.4, -0.12], [0.04, -0.413, -0.078], [0.2, -0.5, 0], [0.065, -0.4, -0.143]]}]}})",
                                                        "task.json"),
                                              scene);
  const Posture posture = findPosture(setup);
  for (const Violation& v : posture.conflict) UNSCOPED_INFO(v.name << ' ' << v.amount);
  CHECK(posture.feasible);
}

TEST_CASE("whole poses that an arm of six joints can take are found from one start of its own") {
  const PostureScene scene = bodiesOf(chain(6, [](int i) {
    const char* axis[] = {"0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0"};
    return "<origin xyz='" + std::string(i < 4 ? "0.3" : "0.05") + " 0 0.02'/><axis xyz='" + axis[i] +
           "'/><limit lower='-2.5' upper='2.5' effort='1' velocity='1'/>";
  }));
  constexpr int kPoses = 200;
  Random random(5);
  int nearby = 0, anywhere = 0;
  for (int i = 0; i < kPoses; ++i) {
    const Eigen::Isometry3d target = poseOf(scene, randomWithin(scene, random), "l6");
    PostureOptions options;
    anywhere += found(scene, {wholePose("l6", target)}, options).feasible;
    options.anywhere = 0;
    nearby += found(scene, {wholePose("l6", target)}, options).feasible;
  }
  CAPTURE(nearby, anywhere);
  CHECK(anywhere >= 0.99 * kPoses);
  CHECK(nearby < anywhere);  // each pose has few solutions, far apart
}
