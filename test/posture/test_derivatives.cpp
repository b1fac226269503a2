// The Jacobian of every kind of constraint and the cost's gradient against central differences.
#include <catch2/catch.hpp>
#include <functional>
#include <string>
#include <tuple>
#include <utility>

#include "fcl_stpbv/posture/task.h"
#include "test/posture/scenes.h"
#include "test/reference/shapes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

// Differences with step h are accurate to about h^2 + 1e-16/h, which is 1e-9 here, with a margin for the
// rows' size.
constexpr double kStep = 1e-6, kAgree = 1e-7;

Eigen::Vector3d randomPoint(Random& random, double size) {
  return random.uniform(0, size) * random.direction();
}
Eigen::Isometry3d randomPose(Random& random, double size) {
  return pose(random.rotation(), randomPoint(random, size));
}

// A user's own constraint: a function of one coordinate, with its slope.
class OwnRow : public PostureRows {
 public:
  using Function = std::function<std::pair<double, double>(double)>;
  OwnRow(std::string name, int coordinate, Function function)
      : name_(std::move(name)), coordinate_(coordinate), function_(std::move(function)) {}

  Kind kind() const override { return Kind::atLeast; }
  int size() const override { return 1; }
  std::string name(int) const override { return name_; }
  void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values,
                Eigen::Ref<RowMatrix> jacobian) override {
    std::tie(values[0], jacobian(0, coordinate_)) = function_(at.x[coordinate_]);
  }

 private:
  std::string name_;
  int coordinate_;
  Function function_;
};

Eigen::VectorXd randomVariables(const PostureProblem& problem, Random& random) {
  Eigen::VectorXd x(problem.variables());
  for (int i = 0; i < problem.variables(); ++i)
    x[i] = random.uniform(std::max(problem.lower()[i], -1.0), std::min(problem.upper()[i], 1.0));
  return x;
}

// Largest difference of one derivative from its central difference.
double worstEquality(PostureProblem& problem, const Eigen::VectorXd& x) {
  const PostureValues at = problem.evaluate(x);
  double worst = 0;
  for (int i = 0; i < problem.variables(); ++i) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(problem.variables(), i);
    const PostureValues after = problem.evaluate(x + step);
    const PostureValues before = problem.evaluate(x - step);
    if (at.equal.size() > 0)
      worst = std::max(
          worst,
          ((after.equal - before.equal) / (2 * kStep) - at.equalJacobian.col(i)).cwiseAbs().maxCoeff());
    worst = std::max(worst, std::abs((after.cost - before.cost) / (2 * kStep) - at.costGradient[i]));
  }
  return worst;
}

std::shared_ptr<PostureProblem> problemOf(const std::shared_ptr<const Kinematics>& kinematics) {
  return std::make_shared<PostureProblem>(kinematics, quarterCost(*kinematics), kinematics->neutral());
}

Placement placementOf(const Kinematics& kinematics, Random& random) {
  Placement placement;
  placement.name = "hand";
  placement.link = kinematics.robot().link("LARM_LINK5");
  placement.frame = randomPose(random, 0.2);
  placement.target = randomPose(random, 0.5);
  return placement;
}

}  // namespace

TEST_CASE("a placement's derivatives agree with differences, whatever is free") {
  Random random(1);
  const auto kinematics = std::make_shared<const Kinematics>(hrp2Scene().robot, BaseMotion::floating);
  const std::array<std::array<bool, 6>, 5> cases{{{},
                                                  {true, false, true, false, false, false},
                                                  {false, false, false, true, false, false},
                                                  {false, true, false, false, false, true},
                                                  {false, false, false, true, true, true}}};
  for (const auto& isFree : cases) {
    for (int trial = 0; trial < 20; ++trial) {
      Placement placement = placementOf(*kinematics, random);
      placement.free = isFree;
      const auto problem = problemOf(kinematics);
      problem->add(std::make_shared<PlacementRows>(*kinematics, placement));
      CHECK(problem->equalities() == 6 - std::count(isFree.begin(), isFree.end(), true));
      CHECK(worstEquality(*problem, randomVariables(*problem, random)) < 10 * kAgree);
    }
  }
}

TEST_CASE("a placement's derivatives agree with differences next to where its rows vanish") {
  Random random(2);
  const auto kinematics = std::make_shared<const Kinematics>(hrp2Scene().robot, BaseMotion::floating);
  for (const double away : {0.0, 1e-9, 1e-5, 5e-3, 2e-2}) {  // around the ends of the series
    for (const bool axisOnly : {false, true}) {
      Placement placement = placementOf(*kinematics, random);
      placement.free[5] = axisOnly;
      const auto problem = problemOf(kinematics);
      const Eigen::VectorXd x = randomVariables(*problem, random);
      Kinematics::State state = kinematics->makeState();
      kinematics->forward(x, state);
      placement.target = state.link[static_cast<std::size_t>(placement.link)] * placement.frame *
                         Eigen::AngleAxisd(away, Eigen::Vector3d(1, 2, 3).normalized());
      problem->add(std::make_shared<PlacementRows>(*kinematics, placement));
      CHECK(worstEquality(*problem, x) < kAgree);
      CHECK(problem->evaluate(x).equal.norm() ==
            Approx(axisOnly ? away * std::sqrt(5.0 / 14) : away).margin(1e-9));
    }
  }
}

TEST_CASE("a placement vanishes for no other rotation, half turns included") {
  const auto kinematics = std::make_shared<const Kinematics>(hrp2Scene().robot, BaseMotion::floating);
  for (const double turn : {M_PI, M_PI - 1e-7, 3.0}) {
    for (const bool axisOnly : {false, true}) {
      Placement placement;
      placement.free[5] = axisOnly;
      placement.target.linear() = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitX()).toRotationMatrix();
      const auto problem = problemOf(kinematics);
      problem->add(std::make_shared<PlacementRows>(*kinematics, placement));
      const PostureValues& values = problem->evaluate(Eigen::VectorXd::Zero(problem->variables()));
      CHECK(values.equalJacobian.allFinite());
      CHECK(values.equal.norm() >= (axisOnly && turn == M_PI ? 0.1 : 2.9));
    }
  }
  Placement two;
  two.name = "two";
  two.free = {false, false, false, true, true, false};
  CHECK_THROWS_WITH(PlacementRows(*kinematics, two), Catch::Contains("two rotations are free"));
}

TEST_CASE("static stability's derivatives agree with differences") {
  Random random(3);
  const PostureScene scene = hrp2Scene();
  const auto kinematics = std::make_shared<const Kinematics>(scene.robot, BaseMotion::floating);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Contact> contacts;
    for (const char* link : {"LLEG_LINK5", "RLEG_LINK5", "RARM_LINK5"})
      contacts.push_back({scene.robot->link(link),
                          {randomPoint(random, 0.1), randomPoint(random, 0.1), randomPoint(random, 0.1)}});
    const auto problem = problemOf(kinematics);
    const auto rows = std::make_shared<StaticStability>(kinematics, contacts, 0.0, problem->variables());
    CHECK(problem->addVariables(rows->weights()) == kinematics->size());
    problem->add(rows);
    CHECK(worstEquality(*problem, randomVariables(*problem, random)) < kAgree);
  }
}

TEST_CASE("static stability and its room keep the robot that they need") {
  const PostureScene scene = hrp2Scene();
  const int foot = scene.robot->link("LLEG_LINK5");
  auto kinematics = std::make_shared<const Kinematics>(scene.robot, BaseMotion::floating);
  const std::weak_ptr<const Kinematics> watched = kinematics;
  const std::vector<Eigen::Vector3d> sole{{0, 0, 0}, {0.2, 0, 0}, {0.2, 0.1, 0}, {0, 0.1, 0}};
  auto stability = std::make_shared<StaticStability>(kinematics, std::vector<Contact>{{foot, sole}}, 0.01, 0);
  CHECK(stability->unit(1) == "m");
  CHECK(stability->unit(2) == "");  // of the weights
  const std::shared_ptr<PostureRows> room = stability->room();
  kinematics.reset();
  CHECK_FALSE(watched.expired());
  stability.reset();
  CHECK(room->name(0) == "stability margin within LLEG_LINK5");
  CHECK(room->unit(0) == "m");
  CHECK(room->name(1) == "steepness of the contact of LLEG_LINK5");
  CHECK(room->unit(1) == "");
}

TEST_CASE("the centre of mass is that of the links, and of the whole mass") {
  Random random(4);
  const PostureScene scene = hrp2Scene();
  const Kinematics kinematics(scene.robot, BaseMotion::floating);
  CentreOfMass centre(kinematics);
  CHECK(centre.mass() == Approx(58));  // data/hrp2_style: 58 kg with batteries
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(kinematics.neutral(), state);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < scene.robot->links.size(); ++i)
    sum += scene.robot->links[i].mass * (state.link[i] * scene.robot->links[i].centreOfMass);
  Eigen::Matrix3Xd jacobian(3, kinematics.size());
  CHECK((centre.evaluate(state, jacobian) - sum / 58).norm() < 1e-12);
}

TEST_CASE("a shrunk contact keeps the margin from every edge") {
  const std::vector<Eigen::Vector3d> sole{
      {0.1, 0.05, 0}, {-0.1, 0.05, 0}, {0, 0.05, 0}, {-0.1, -0.05, 0}, {0.1, -0.05, 0}};
  const std::vector<Eigen::Vector3d> inside = shrunk(sole, 0.02);
  REQUIRE(inside.size() == 4);
  for (const Eigen::Vector3d& p : inside) {
    CHECK(std::abs(p.x()) == Approx(0.08));
    CHECK(std::abs(p.y()) == Approx(0.03));
  }
  CHECK(shrunk(sole, 0).size() == sole.size());
  CHECK_THROWS_WITH(shrunk(sole, 0.06), Catch::Contains("smaller margin"));
  CHECK_THROWS_WITH(shrunk({{0, 0, 0}}, 0.01), Catch::Contains("smaller margin"));
}

TEST_CASE("sizes, links and margins that are wrong are refused by name") {
  const auto kinematics = std::make_shared<const Kinematics>(hrp2Scene().robot);
  const int n = kinematics->size();
  const Eigen::VectorXd q = kinematics->neutral(), other = q.head(n - 1);
  const auto refused = [](const auto& act, const std::string& message) {
    INFO(message);
    CHECK_THROWS_WITH(act(), Catch::Contains(message));
  };
  const std::string sizes = " has the size " + std::to_string(n - 1) + ", expected " + std::to_string(n);
  const auto make = [&](const PostureCost& cost, const Eigen::VectorXd& start) {
    return PostureProblem(kinematics, cost, start);
  };
  const PostureCost cost = quarterCost(*kinematics);
  refused([&] { make(cost, other); }, "PostureProblem: start" + sizes);
  refused([&] { make({other, cost.reference}, q); }, "PostureProblem: the cost's weights" + sizes);
  refused([&] { make({cost.weights, other}, q); }, "PostureProblem: the cost's reference" + sizes);
  PostureProblem problem = make(cost, q);
  refused([&] { problem.evaluate(other); }, "PostureProblem: x" + sizes);
  refused([&] { problem.violations(other, 1e-6); }, "PostureProblem: x" + sizes);
  refused([&] { problem.variablesAt(other); }, "PostureProblem: q" + sizes);
  refused([&] { solveBySlsqp(problem, other, {}); }, "solveBySlsqp: start" + sizes);
  CentreOfMass centre(*kinematics);
  Eigen::Matrix3Xd narrow(3, n - 1), moved(3, n);
  const Kinematics::State state = kinematics->makeState();
  refused([&] { centre.evaluate(state, narrow); }, "CentreOfMass: the Jacobian" + sizes);
  refused([&] { centre.evaluate({}, moved); }, "CentreOfMass: state.link has the size 0");
  const int links = static_cast<int>(kinematics->robot().links.size());
  const std::vector<Eigen::Vector3d> sole{{0.1, 0.05, 0}, {-0.1, 0.05, 0}, {0, -0.05, 0}};
  for (const int link : {-1, links}) {
    const std::string none = "there is no link " + std::to_string(link) + " of " + std::to_string(links);
    Placement placement;
    placement.name = "hand";
    placement.link = link;
    refused([&] { PlacementRows(*kinematics, placement); }, "placement 'hand': " + none);
    refused([&] { StaticStability(kinematics, {{link, sole}}, 0, n); }, "StaticStability: " + none);
  }
  for (const double margin : {-0.01, std::nan("")}) {
    refused([&] { shrunk(sole, margin); }, "a contact's margin: got");
    refused([&] { StaticStability(kinematics, {{0, sole}}, margin, n); }, "a contact's margin: got");
  }
}

TEST_CASE("collisions' derivatives agree with differences away from deep penetration") {
  Random random(5);
  const PostureScene scene = hrp2Scene();
  const PostureSetup setup = setUp(pickCan(), scene);
  PostureProblem& problem = *setup.problem;
  const Eigen::VectorXd start = problem.variablesAt(setup.start);
  long compared = 0;
  for (int trial = 0; trial < 10; ++trial) {
    Eigen::VectorXd x = start;
    for (int i = 0; i < setup.start.size(); ++i) x[i] += random.uniform(-0.3, 0.3);
    const PostureValues at = problem.evaluate(x);
    for (int i = 0; i < setup.start.size(); ++i) {
      const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(problem.variables(), i);
      const PostureValues after = problem.evaluate(x + step);
      const PostureValues before = problem.evaluate(x - step);
      for (int row = 0; row < problem.inequalities(); ++row) {
        if (at.atLeast[row] < -0.005) continue;  // deeper than the margins, the way out may change
        const double difference = (after.atLeast[row] - before.atLeast[row]) / (2 * kStep);
        // A difference across a region boundary is off by half a step times the jump of the curvature, up to
        // 1/r.
        CHECK(std::abs(difference - at.atLeastJacobian(row, i)) < 1e-4);
        ++compared;
      }
    }
  }
  CHECK(compared > 30000);
}

TEST_CASE("after a constraint threw, the problem does not take half of its values for all") {
  const auto kinematics = std::make_shared<const Kinematics>(hrp2Scene().robot, BaseMotion::fixed);
  const auto problem = problemOf(kinematics);
  bool broken = false;
  problem->add(std::make_shared<OwnRow>("touchy", 0, [&broken](double q) {
    if (broken) throw Error("no value");
    return std::pair(2 * q + 1, 2.0);
  }));
  Eigen::VectorXd x = problem->variablesAt(kinematics->neutral());
  problem->evaluate(x);
  x[0] = 0.125;
  broken = true;
  CHECK_THROWS_WITH(problem->evaluate(x), "no value");
  broken = false;
  CHECK(problem->evaluate(x).atLeast[0] == 1.25);
  CHECK(problem->evaluate(x).atLeastJacobian(0, 0) == 2);
}

TEST_CASE("a user's own constraint is a row like any other") {
  const auto kinematics = std::make_shared<const Kinematics>(hrp2Scene().robot, BaseMotion::floating);
  const auto problem = problemOf(kinematics);
  const int knee = kinematics->coordinate("LLEG_JOINT3");
  problem->add(
      std::make_shared<OwnRow>("knee bent", knee, [](double q) { return std::pair(q * q - 0.25, 2 * q); }));
  Eigen::VectorXd x = problem->variablesAt(kinematics->neutral());
  x[knee] = 0.3;
  const PostureValues& values = problem->evaluate(x);
  CHECK(values.atLeast[0] == Approx(0.09 - 0.25));
  CHECK(values.atLeastJacobian(0, knee) == Approx(0.6));
  const auto violations = problem->violations(x, 1e-6);
  REQUIRE(violations.size() == 1);
  CHECK(violations[0].name == "knee bent");
}
