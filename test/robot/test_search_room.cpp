// The search range of coordinates whose limits are far beyond the size of the robot, and descents of tiny
// robots.
#include <fcl/geometry/shape/cylinder.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <iomanip>
#include <sstream>

#include "fcl_stpbv/robot/pair_list.h"
#include "fcl_stpbv/robot/pair_search.h"
#include "fcl_stpbv/robot/search_room.h"
#include "test/reference/shapes.h"
#include "test/robot/arm.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

Arm loaded(const std::string& body, const StpBvOptions& radii, BaseMotion base = BaseMotion::fixed) {
  GeometryOptions options;
  options.radii = radii;
  return armFrom(parsed(robot(body), options), base);
}

const StpBvOptions kRounding{0.01, 1000};

std::string rail(const std::string& name, const std::string& parent, const std::string& child,
                 const std::string& axis, const std::string& lower, const std::string& upper) {
  return "<joint name=\"" + name + "\" type=\"prismatic\"><parent link=\"" + parent + "\"/><child link=\"" +
         child + "\"/><axis xyz=\"" + axis + "\"/><limit lower=\"" + lower + "\" upper=\"" + upper +
         "\" effort=\"1\" velocity=\"1\"/></joint>";
}

// A cart 1 m from a post, with an arm on it.
std::string cart(const std::string& post, const std::string& lower, const std::string& upper) {
  return link("post", post) + link("x") + link("y") + link("cart") +
         link("arm", "<box size=\"0.6 0.06 0.06\"/>") + rail("px", "post", "x", "1 0 0", lower, upper) +
         rail("py", "x", "y", "0 1 0", lower, upper) +
         joint("yaw", "continuous", "y", "cart", "<origin xyz=\"1 0 0.1\"/><axis xyz=\"0 0 1\"/>") +
         joint("lift", "revolute", "cart", "arm", "<origin xyz=\"0.2 0 0.2\"/><axis xyz=\"0 1 0\"/>");
}

PairReason searched(const Arm& arm, const std::vector<Obstacle>& obstacles = {}) {
  PairListOptions options;
  options.obstacles = obstacles;
  const std::vector<PairEntry> list = pairList(arm.kinematics, arm.geometry, nullptr, options);
  const auto entry = std::find_if(list.begin(), list.end(),
                                  [&](const PairEntry& e) { return e.obstacle == !obstacles.empty(); });
  REQUIRE(entry != list.end());
  CAPTURE(entry->minDistance);
  CHECK(entry->closest.cwiseAbs().maxCoeff() < 1e4);
  return entry->reason;
}

Obstacle pillarAt(double x) {
  const auto shape = std::make_shared<fcl::Cylinderd>(0.1, 1);
  const fcl::CollisionObjectd object(shape, Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0.5)));
  return obstacleOf(object, "pillar");
}

}  // namespace

TEST_CASE("joints whose limits stand for no limit are searched where bodies can meet") {
  const std::string post = "<cylinder radius=\"0.1\" length=\"1\"/>";
  for (const auto& [lower, upper] :
       {std::pair("-1e4", "1e4"), std::pair("-1e6", "1e6"), std::pair("-1e16", "1e16"),
        std::pair("-1e16", "0"), std::pair("-1e16", "2"), std::pair("-3", "1e16")}) {
    CAPTURE(lower, upper);
    CHECK(searched(loaded(cart(post, lower, upper), kRounding)) == PairReason::sometimes);
    const Arm alone = loaded(cart("", lower, upper), kRounding);
    CHECK(searched(alone, {pillarAt(0)}) == PairReason::sometimes);
    const bool reached = std::string(lower) != "-3";
    CHECK((searched(alone, {pillarAt(-2000)}) == PairReason::sometimes) == reached);
  }
}

TEST_CASE("a joint without an end does not make the room of the others larger") {
  const std::string text = link("base") + link("arm", "<box size=\"0.2 0.2 0.2\"/>") +
                           rail("lift", "base", "arm", "0 0 1", "-1e16", "1e16");
  const Arm floating = loaded(text, kRounding, BaseMotion::floating);
  const SearchRoom room = searchRoom(*floating.kinematics, *floating.geometry, {pillarAt(3)});
  CHECK((room.upper.array() < 8).all());
  CHECK((room.lower.array() > -8).all());
  CHECK(searched(floating, {pillarAt(3)}) == PairReason::sometimes);
}

TEST_CASE("rails of the usual lengths are searched from end to end") {
  for (const char* length : {"1", "20", "100"}) {
    const Arm arm = loaded(cart("<sphere radius=\"0.1\"/>", "-0.5", length), kRounding);
    const SearchRoom room = searchRoom(*arm.kinematics, *arm.geometry, {});
    CHECK(room.lower == arm.kinematics->lower());
    CHECK(room.upper == arm.kinematics->upper());
    CHECK(room.unit == Eigen::VectorXd::Ones(room.unit.size()));
    CHECK((room.scale == 1 && room.narrowed.empty()));
  }
  // The whole range of a long rail is searched too, if rarely, and never beyond its limits.
  const Arm arm = loaded(cart("<sphere radius=\"0.1\"/>", "-2", "1e16"), kRounding);
  const SearchRoom room = searchRoom(*arm.kinematics, *arm.geometry, {});
  std::mt19937_64 random(1);
  double farthest = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::VectorXd q = randomConfiguration(*arm.kinematics, room, random);
    CHECK(((q - arm.kinematics->lower()).array() >= 0 && (arm.kinematics->upper() - q).array() >= 0).all());
    farthest = std::max(farthest, q.maxCoeff());
  }
  CHECK(farthest > 1e5);
}

TEST_CASE("a screw is searched as far as its nut goes, whatever else it turns") {
  const auto ball = [](const std::string& at) {
    return "<collision><origin xyz=\"" + at + "\"/><geometry><sphere radius=\"0.1\"/></geometry></collision>";
  };
  for (const char* limits : {"lower=\"0\" upper=\"0.6\"", "lower=\"-1e16\" upper=\"1e16\""}) {
    CAPTURE(limits);
    const Arm arm =
        loaded("<link name=\"base\">" + ball("-0.2 -1.0 -0.8") + "</link>" + link("motor") + link("gear") +
                   link("arm") + "<link name=\"slide\">" + ball("0 0 0") + "</link>" +
                   joint("m", "continuous", "base", "motor", "<axis xyz=\"0 0 1\"/>") +
                   joint("g", "continuous", "base", "gear",
                         "<axis xyz=\"0 0 1\"/><mimic joint=\"m\" multiplier=\"1.2391\"/>") +
                   "<joint name=\"a\" type=\"revolute\"><parent link=\"motor\"/><child link=\"arm\"/>"
                   "<origin xyz=\"-0.1 -0.1 -0.3\"/><axis xyz=\"0 1 0\"/>"
                   "<limit lower=\"-1.5\" upper=\"1.5\" effort=\"1\" velocity=\"1\"/></joint>"
                   "<joint name=\"s\" type=\"prismatic\"><parent link=\"arm\"/><child link=\"slide\"/>"
                   "<origin xyz=\"0 -0.2 -0.9\"/><axis xyz=\"1 0 0\"/><limit " +
                   limits +
                   " effort=\"1\" velocity=\"1\"/>"
                   "<mimic joint=\"m\" multiplier=\"0.05\"/></joint>",
               kRounding);
    CHECK(searched(arm) == PairReason::sometimes);
  }
}

TEST_CASE("descents of small and large robots do not depend on their size") {
  // A block on an arm beside one on a rail, `metre` m for a metre.
  const auto robotOf = [](double metre) {
    const auto length = [&](double x) {
      std::ostringstream text;
      text << std::setprecision(17) << x * metre;
      return text.str();
    };
    const auto three = [&](double x, double y, double z) {
      return length(x) + " " + length(y) + " " + length(z);
    };
    const auto turn = [&](const std::string& name, const std::string& parent, const std::string& child,
                          const std::string& axis, const std::string& origin) {
      return joint(name, "revolute", parent, child,
                   "<origin xyz=\"" + origin + "\"/><axis xyz=\"" + axis + "\"/>", 2);
    };
    return loaded(
        link("base") + link("upper") + link("hand", "<box size=\"" + three(0.1, 0.02, 0.05) + "\"/>") +
            link("block", "<box size=\"" + three(0.05, 0.04, 0.08) + "\"/>") +
            turn("j1", "base", "upper", "0.3 0.2 1", three(0.05, 0.1, 0)) +
            turn("j2", "upper", "hand", "1 0.5 0", three(0.2, 0.1, 0.05)) +
            "<joint name=\"rail\" type=\"prismatic\"><parent link=\"base\"/><child link=\"block\"/>"
            "<origin xyz=\"" +
            three(-0.1, -0.2, 0.3) +
            "\" rpy=\"0.4 0.3 0.2\"/><axis xyz=\"1 0 0\"/>"
            "<limit lower=\"" +
            length(-0.1) + "\" upper=\"" + length(0.15) + "\" effort=\"1\" velocity=\"1\"/></joint>",
        {0.005 * metre, 2 * metre});
  };
  struct Sizes {
    double metre, factor;
  };
  for (const auto& [metre, factor] : {Sizes{1, 1.0 / 1024}, Sizes{64, 1024}}) {
    CAPTURE(metre);
    const Arm usual = robotOf(metre), scaled = robotOf(metre * factor);
    const int hand = usual.kinematics->robot().link("hand"), block = usual.kinematics->robot().link("block");
    PairSearch one(usual.kinematics, usual.geometry, {hand, block}),
        other(scaled.kinematics, scaled.geometry, {hand, block});
    const SearchRoom room = searchRoom(*usual.kinematics, *usual.geometry, {});
    std::mt19937_64 random(1);
    for (int i = 0; i < 50; ++i) {
      Eigen::VectorXd q = randomConfiguration(*usual.kinematics, room, random), p = q;
      p[usual.kinematics->coordinate("rail")] *= factor;
      const bool down = i % 2 == 0;
      const double reached = down ? one.descend(q, -1) : one.climb(q, 1);
      const double there = down ? other.descend(p, -1) : other.climb(p, 1);
      CHECK(there / factor == Approx(reached).margin(1e-5 * metre));
    }
  }
}
