// Poses and motions of links, compared with differences and known positions.
#include <catch2/catch.hpp>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "test/reference/robots.h"
#include "test/reference/shapes.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

// Velocity of a point of a link per unit of each coordinate, from the motions.
Eigen::MatrixXd velocities(const Kinematics& kinematics, const Kinematics::State& state, int link,
                           const Eigen::Vector3d& x) {
  Eigen::MatrixXd v = Eigen::MatrixXd::Zero(3, kinematics.size());
  for (const Kinematics::Dependence& d : kinematics.dependence(link)) {
    const Twist& twist = state.motion[static_cast<std::size_t>(d.motion)];
    v.col(kinematics.motions()[static_cast<std::size_t>(d.motion)].coordinate) +=
        twist.linear + twist.angular.cross(x);
  }
  return v;
}

void checkMotions(const Kinematics& kinematics, int count) {
  Random random(1);
  Kinematics::State state = kinematics.makeState(), moved = kinematics.makeState();
  constexpr double step = 1e-6;  // differences are accurate to about step^2 + 1e-16 / step
  double worst = 0;
  for (int trial = 0; trial < count; ++trial) {
    const Eigen::VectorXd q = randomConfiguration(kinematics, random);
    kinematics.forward(q, state);
    const int link = random.below(static_cast<int>(state.link.size()));
    const Eigen::Vector3d local(0.1, -0.2, 0.3);
    const std::size_t l = static_cast<std::size_t>(link);
    const Eigen::MatrixXd v = velocities(kinematics, state, link, state.link[l] * local);
    for (int i = 0; i < kinematics.size(); ++i) {
      Eigen::VectorXd near = q;
      near[i] = q[i] + step;
      kinematics.forward(near, moved);
      const Eigen::Vector3d after = moved.link[l] * local;
      near[i] = q[i] - step;
      kinematics.forward(near, moved);
      worst = std::max(worst, ((after - moved.link[l] * local) / (2 * step) - v.col(i)).norm());
    }
  }
  CHECK(worst < 1e-8);
}

double difference(const Twist& a, const Twist& b, const Twist& rate, double step) {
  return ((a.linear - b.linear) / (2 * step) - rate.linear).norm() +
         ((a.angular - b.angular) / (2 * step) - rate.angular).norm();
}

void checkRates(const Kinematics& kinematics, int count) {
  Random random(2);
  Kinematics::State state = kinematics.makeState(), after = state, before = state;
  Kinematics::Rate rate = kinematics.makeRate();
  constexpr double step = 1e-6;  // as above
  double motions = 0, links = 0;
  for (int trial = 0; trial < count; ++trial) {
    Eigen::VectorXd q = randomConfiguration(kinematics, random), v(q.size());
    if (trial % 3 == 0) q *= 1e-3;  // rotation vectors near 0
    for (Eigen::Index i = 0; i < v.size(); ++i) v[i] = random.uniform(-1, 1);
    kinematics.forward(q, state);
    kinematics.differentiate(q, v, state, rate);
    kinematics.forward(q + step * v, after);
    kinematics.forward(q - step * v, before);
    for (std::size_t m = 0; m < rate.motion.size(); ++m)
      motions = std::max(motions, difference(after.motion[m], before.motion[m], rate.motion[m], step));
    for (std::size_t l = 0; l < rate.link.size(); ++l) {
      const Eigen::Vector3d local(0.1, -0.2, 0.3), x = state.link[l] * local;
      const Eigen::Vector3d moved = after.link[l] * local - before.link[l] * local;
      links =
          std::max(links, (moved / (2 * step) - rate.link[l].linear - rate.link[l].angular.cross(x)).norm());
    }
  }
  CHECK(motions < 1e-8);
  CHECK(links < 1e-8);
}

}  // namespace

TEST_CASE("motions of every kind of joint agree with differences of poses") {
  const std::string axis = "<origin xyz=\"0.1 0.2 0.3\" rpy=\"0.3 -0.4 0.5\"/><axis xyz=\"1 2 -0.5\"/>";
  const RobotModel model = parseUrdf(
      robot(link("a") + link("b") + link("c") + link("d") + link("e") + link("f") + link("g") + link("h") +
            joint("j1", "revolute", "a", "b", axis) + joint("j2", "prismatic", "b", "c", axis) +
            joint("j3", "continuous", "c", "d", axis) + joint("j4", "planar", "d", "e", axis) +
            joint("j5", "floating", "e", "f", axis) + joint("j6", "fixed", "f", "g", axis) +
            joint("j7", "revolute", "g", "h",
                  axis + "<mimic joint=\"j1\" multiplier=\"-1.5\" offset=\"0.2\"/>")),
      "all.urdf");
  const auto shared = std::make_shared<const RobotModel>(model);
  for (const BaseMotion base : {BaseMotion::fixed, BaseMotion::planar, BaseMotion::floating}) {
    const Kinematics kinematics(shared, base);
    const int extra = base == BaseMotion::fixed ? 0 : base == BaseMotion::planar ? 3 : 6;
    CHECK(kinematics.size() == extra + 3 + 3 + 6);
    checkMotions(kinematics, 20);
    checkRates(kinematics, 30);
  }
}

TEST_CASE("motions of real robots agree with differences of poses") {
  for (const TestRobot& robot : robots()) {
    INFO(robot.name);
    checkMotions(Kinematics(std::make_shared<const RobotModel>(loadUrdf(robot.urdf))), 10);
  }
}

TEST_CASE("the humanoid's coordinates are those of its table, its feet 105 mm below the ankles") {
  const TestRobot robot = robots()[0];
  const auto model = std::make_shared<const RobotModel>(loadUrdf(robot.urdf));
  const Kinematics kinematics(model);
  CHECK(kinematics.size() == 30);
  CHECK(kinematics.names().front() == "RLEG_JOINT0");
  CHECK(kinematics.names().back() == "LARM_JOINT6");
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(kinematics.neutral(), state);
  const Eigen::Vector3d ankle = state.link[static_cast<std::size_t>(model->link("LLEG_LINK5"))].translation();
  CHECK((ankle - Eigen::Vector3d(0, 0.095, -0.6)).norm() < 1e-12);
  const Srdf srdf = loadSrdf(robot.srdf, *model);
  const Eigen::VectorXd q = kinematics.configuration(srdf.state("half_sitting"));
  CHECK(q[kinematics.coordinate("RLEG_JOINT3")] == Approx(0.872665));
}

TEST_CASE("a pair depends on the joints between its links only") {
  const RobotModel model =
      parseUrdf(robot(link("a") + link("b") + link("c") + link("d") + joint("j1", "revolute", "a", "b") +
                      joint("j2", "revolute", "b", "c") + joint("j3", "revolute", "b", "d")),
                "fork.urdf");
  const Kinematics kinematics(std::make_shared<const RobotModel>(model));
  const auto list = kinematics.dependence(model.link("c"), model.link("d"));
  REQUIRE(list.size() == 2);
  CHECK(list[0].sign == -1);
  CHECK(list[1].sign == 1);
  CHECK(kinematics.dependence(model.link("c"), model.link("c")).empty());
  CHECK_THROWS_WITH(kinematics.dependence(4), "Kinematics: there is no link 4 of 4");
  CHECK_THROWS_WITH(kinematics.dependence(0, -1), "Kinematics: there is no link -1 of 4");
  CHECK_THROWS_WITH(moves(model, 999), "moves: there is no link 999 of 4");
  PairEntry foreign;
  foreign.link1 = 0, foreign.link2 = 4, foreign.reason = PairReason::adjacent;
  CHECK_THROWS_WITH(toSrdf(model, {foreign}), "toSrdf: there is no link 4 of 4");
}

TEST_CASE("a subtree has all that carries its links, as the whole robot has, and nothing else") {
  const auto model = std::make_shared<const RobotModel>(loadUrdf(robots()[0].urdf));
  const Kinematics kinematics(model, BaseMotion::floating);
  Random random(3);
  const Eigen::VectorXd q = randomConfiguration(kinematics, random),
                        v = randomConfiguration(kinematics, random);
  const int hand = model->link("RARM_LINK6"), head = model->link("HEAD_LINK1");
  REQUIRE((hand >= 0 && head >= 0));
  const Kinematics::Subtree arm = kinematics.subtree({hand, head, hand});
  Kinematics::State all = kinematics.makeState(), some = all, poses = all;
  Kinematics::Rate allRates = kinematics.makeRate(), rates = allRates;
  kinematics.forward(q, all);
  kinematics.differentiate(q, v, all, allRates);
  kinematics.forward(q, some, arm);
  kinematics.forwardPoses(q, poses, arm);
  kinematics.differentiate(q, v, some, rates, arm);
  std::size_t placed = 0;
  for (std::size_t l = 0; l < all.link.size(); ++l) {
    const auto carries = [&](int link) {
      while (link > static_cast<int>(l)) {
        const int joint = model->links[static_cast<std::size_t>(link)].parentJoint;
        link = joint < 0 ? -1 : model->joints[static_cast<std::size_t>(joint)].parent;
      }
      return link == static_cast<int>(l);
    };
    const bool isOn = carries(hand) || carries(head);
    placed += isOn;
    const Eigen::Matrix4d expected = isOn ? all.link[l].matrix() : Eigen::Matrix4d::Identity();
    CHECK(some.link[l].matrix() == expected);
    CHECK(poses.link[l].matrix() == expected);
    CHECK(rates.link[l].linear == (isOn ? allRates.link[l].linear : Eigen::Vector3d(0, 0, 0)));
  }
  CHECK(placed > 8);
  CHECK(placed < all.link.size() - 8);
  for (const int link : {hand, head})
    for (const Kinematics::Dependence& d : kinematics.dependence(link)) {
      const auto m = static_cast<std::size_t>(d.motion);
      CHECK(some.motion[m].linear == all.motion[m].linear);
      CHECK(rates.motion[m].angular == allRates.motion[m].angular);
    }
  CHECK_THROWS_WITH(kinematics.subtree({0, 99}), Catch::Contains("there is no link 99"));
}

TEST_CASE("two coordinates of one name are refused, with the name and the file") {
  const std::string links = link("a") + link("b") + link("c");
  const auto said = [&](const std::string& joints, BaseMotion base) {
    const auto make = [base](const std::string& text) {
      Kinematics(std::make_shared<const RobotModel>(parseUrdf(text, "small.urdf")), base);
    };
    return refusal(make, robot(links + joints));
  };
  const std::string planar = joint("p", "planar", "a", "b") + joint("p/x", "prismatic", "b", "c"),
                    base = joint("j", "revolute", "a", "b") + joint("base/x", "prismatic", "b", "c");
  const auto names = [](const char* which) {
    return Catch::Matchers::StartsWith(std::string("small.urdf: two coordinates are named '") + which + "'");
  };
  CHECK_THAT(said(planar, BaseMotion::fixed), names("p/x"));
  CHECK_THAT(said(base, BaseMotion::planar), names("base/x"));
  CHECK_THAT(
      said(joint("base", "floating", "a", "b") + joint("j", "revolute", "b", "c"), BaseMotion::floating),
      names("base/x"));
  const auto alone = std::make_shared<const RobotModel>(parseUrdf(robot(links + base), "small.urdf"));
  CHECK(Kinematics(alone).names() == std::vector<std::string>{"j", "base/x"});
}
