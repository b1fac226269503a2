// The primitives that get a smooth cover: enough for every pair, none without need, the same every time.
#include <catch2/catch.hpp>
#include <set>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/constraints.h"
#include "test/reference/robots.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

std::string number(double value) { return std::to_string(value); }

std::string randomGeometry(Random& random) {
  const auto size = [&] { return number(random.uniform(0.01, 0.2)); };
  switch (random.below(4)) {
    case 0:
      return "<sphere radius=\"" + size() + "\"/>";
    case 1:
      return "<box size=\"" + size() + " " + size() + " " + size() + "\"/>";
    case 2:
      return "<cylinder radius=\"" + size() + "\" length=\"" + size() + "\"/>";
    default:
      return "<capsule radius=\"" + size() + "\" length=\"" + size() + "\"/>";
  }
}

// A tree of links with zero to three primitives each, on revolute joints.
std::string randomRobot(Random& random) {
  const int links = 2 + random.below(14);
  std::string text;
  for (int i = 0; i < links; ++i) {
    text += "<link name=\"l" + std::to_string(i) + "\">";
    for (int shapes = random.below(4); shapes > 0; --shapes)
      text += "<collision><origin xyz=\"" + number(random.uniform(-0.1, 0.1)) + " 0 0\"/><geometry>" +
              randomGeometry(random) + "</geometry></collision>";
    text += "</link>";
    if (i > 0)
      text += joint("j" + std::to_string(i), "revolute", "l" + std::to_string(random.below(i)),
                    "l" + std::to_string(i), "<origin xyz=\"0.1 0.05 0.2\"/>");
  }
  return robot(text);
}

GeometryOptions uncached(bool fit) {
  GeometryOptions options;
  options.cacheFolder.clear();
  options.fitSmallRadius = options.fitBigRadius = fit;
  return options;
}

std::set<std::string> covered(const RobotGeometry& geometry) {
  std::set<std::string> names;
  for (const Body& body : geometry.bodies)
    if (body.primitive) names.insert(body.name);
  return names;
}

}  // namespace

TEST_CASE("on robots of primitives every checked pair is continuous, and no cover is needless") {
  Random random(21);
  int pairsInAll = 0;
  for (int round = 0; round < 60; ++round) {
    const auto model = std::make_shared<const RobotModel>(parseUrdf(randomRobot(random), "random.urdf"));
    RobotGeometry geometry = loadGeometry(*model, uncached(round % 2 == 0));
    std::vector<CheckedPair> pairs = selfPairs(*model, geometry, nullptr);
    if (round % 3 == 0)  // like an SRDF that leaves out many
      for (std::size_t i = pairs.size(); i-- > 0;)
        if (random.below(3) > 0) pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(i));
    if (pairs.empty()) continue;
    RobotGeometry again = geometry;
    coverPrimitives(pairs, geometry);
    coverPrimitives(pairs, again);
    CHECK(covered(geometry) == covered(again));
    coverPrimitives(pairs, again);
    CHECK(covered(geometry) == covered(again));
    for (const Body& body : geometry.bodies) {
      if (!body.primitive || body.cover.max == 0) continue;
      CHECK(std::any_of(pairs.begin(), pairs.end(), [&](const CheckedPair& pair) {
        const Body& a = geometry.bodies[static_cast<std::size_t>(pair.body)];
        const Body& b = geometry.bodies[static_cast<std::size_t>(pair.other)];
        return (&a == &body && !b.volume) || (&b == &body && !a.volume);
      }));
      CHECK((body.pose * body.volume->centre() - body.centre).norm() < 1e-12);
    }
    const auto kinematics = std::make_shared<const Kinematics>(model);
    CollisionConstraints constraints(kinematics, std::make_shared<const RobotGeometry>(geometry), pairs);
    Eigen::VectorXd d(constraints.rows());
    constraints.evaluate(randomConfiguration(*kinematics, random), d);
    for (int row = 0; row < constraints.rows(); ++row) CHECK(constraints.answer(row).continuous);
    pairsInAll += constraints.rows();
  }
  CHECK(pairsInAll > 1500);
}

TEST_CASE("the choice loses little beside the best of all choices") {
  Random random(22);
  double chosen = 0, best = 0;
  for (int round = 0; round < 40; ++round) {
    const RobotModel model = parseUrdf(randomRobot(random), "random.urdf");
    RobotGeometry geometry = loadGeometry(model, uncached(false));
    if (geometry.bodies.size() > 14) continue;
    std::vector<CheckedPair> pairs;
    for (const CheckedPair& pair : selfPairs(model, geometry, nullptr))
      if (random.below(2) == 0) pairs.push_back(pair);
    RobotGeometry all = geometry;
    std::vector<double> loss;
    for (std::size_t i = 0; i < all.bodies.size(); ++i) {  // each in a pair of its own, so that it is covered
      RobotGeometry two;
      two.bodies = {all.bodies[i], all.bodies[i]};
      coverPrimitives({{0, 1}}, two);
      loss.push_back(std::max(two.bodies[0].cover.max, two.bodies[1].cover.max));
    }
    double least = 1e300;
    for (unsigned set = 0; set < 1u << all.bodies.size(); ++set) {
      const auto in = [&](int body) { return (set >> body & 1) != 0; };
      if (!std::all_of(pairs.begin(), pairs.end(),
                       [&](const CheckedPair& p) { return in(p.body) || in(p.other); }))
        continue;
      double sum = 0;
      for (std::size_t i = 0; i < loss.size(); ++i) sum += in(static_cast<int>(i)) ? loss[i] : 0;
      least = std::min(least, sum);
    }
    coverPrimitives(pairs, geometry);
    double sum = 0;
    for (const Body& body : geometry.bodies) sum += body.primitive ? body.cover.max : 0;
    CHECK(sum >= least - 1e-12);
    chosen += sum;
    best += least;
  }
  CHECK(chosen <= 1.1 * best);
}

TEST_CASE("a pair with an obstacle is covered on the cheaper side, and flat meshes stay flat") {
  const auto model = std::make_shared<const RobotModel>(
      parseUrdf(robot(link("a", "<capsule radius=\"0.05\" length=\"0.1\"/>")), "a.urdf"));
  const auto scene = std::make_shared<const RobotModel>(
      parseUrdf(robot(link("table", "<box size=\"2 1 0.03\"/>")), "t.urdf"));
  RobotGeometry geometry = loadGeometry(*model, uncached(false)),
                things = loadGeometry(*scene, uncached(false));
  coverPrimitives({{0, 0, true}}, geometry, &things);
  CHECK(covered(geometry).size() == 1);
  CHECK(covered(things).empty());
  CHECK(geometry.bodies[0].cover.max < 2e-4);  // 0.1 m long under a ball of 10 m
  for (const CheckedPair& none :
       {CheckedPair{0, 1}, CheckedPair{-1, 0}, CheckedPair{0, 1, true}, CheckedPair{0, -1, true}})
    for (RobotGeometry* around : {&things, static_cast<RobotGeometry*>(nullptr)})
      CHECK_THROWS_WITH(coverPrimitives({none}, geometry, around),
                        "coverPrimitives: a pair names a body or an obstacle that does not exist");
  CHECK_THROWS_AS(coverPrimitives({{0, 0, true}}, geometry), Error);
}
