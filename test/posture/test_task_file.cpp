// Task files: each mistake gives one message that names the file and the key.
#include <catch2/catch.hpp>

#include "fcl_stpbv/error.h"
#include "test/posture/scenes.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::test;

namespace {

std::string refusal(const std::string& text) {
  try {
    setUp(parseTask(text, "task.json"), hrp2Scene());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a task file's mistakes are named with their key") {
  const auto refused = [](const std::string& text, const std::string& where, const std::string& what) {
    const std::string message = refusal(text);
    INFO(text << " -> " << message);
    CHECK(message.compare(0, 10, "task.json:") == 0);
    CHECK(message.find(where) != std::string::npos);
    CHECK(message.find(what) != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
  };
  refused("{", "task.json", "no JSON");
  refused("[]", "task.json", "expected an object");
  refused("{}", "placements", "missing");
  refused(R"({"placements": [], "colisions": {}})", "colisions", "known are base, collisions");
  refused(R"({"placement": []})", "task.json", "unknown key 'placement'");
  refused(R"({"placement": []})", "task.json", "; did you mean 'placements'?");
  refused(R"({"placements": [{"link": "BODY", "traget": {}}]})", "placements[0]", "; did you mean 'target'?");
  refused(R"({"placements": 3})", "placements", "expected a list");
  refused(R"({"placements": [{"link": "NO", "target": {"position": [0, 0, 0]}}]})", "placements[0].link",
          "no link 'NO'");
  refused(R"({"placements": [{"link": "BODY"}]})", "placements[0]", "'target' is missing");
  refused(R"({"placements": [{"link": "BODY", "target": {"position": [1, 2]}}]})",
          "placements[0].target.position", "three numbers");
  refused(R"({"placements": [{"link": "BODY", "target": {"position": [1, 2, "x"]}}]})",
          "placements[0].target.position[2]", "a number");
  refused(R"({"placements": [{"link": "BODY", "target": {"rpy": [0, 0, 0]}, "free": ["w"]}]})",
          "placements[0].free[0]", "one of x, y");
  refused(R"({"placements": [{"link": "BODY", "target": {"rpy": [0, 0, 0]}, "free": ["rx", "ry"]}]})",
          "placement 'BODY'", "two rotations");
  refused(R"({"placements": [{"link": "BODY", "target": {}}]})", "placements[0].target",
          "expected a position, an rpy or both");
  refused(R"({"placements": [], "collisions": {"ignore": [{}]}})", "collisions.ignore[0]",
          "expected names in links");
  refused(R"({"placements": [], "collisions": {"ignore": [{"links": []}]}})", "collisions.ignore[0]",
          "all pairs with obstacles go");
  const std::string near = R"("cost": {"towards": "start"})";  // the message recommends this
  refused(R"({"placements": []})", "task.json",
          R"(asks for nothing; give a placement, contacts in "stability", or a "start" with )" + near);
  CHECK(parseTask(R"({"placements": [], "start": {"joints": {"LLEG_JOINT3": 1}}, )" + near + "}", "task.json")
            .towardsStart);
  refused(R"({"placements": [], "base": "flying"})", "base", "one of floating, planar, fixed");
  refused(R"({"placements": [], "start": {"state": "NO"}})", "start.state", "NO");
  refused(R"({"placements": [], "start": {"joints": {"NO": 1}}})", "start.joints", "no joint 'NO'");
  refused(R"({"placements": [], "start": {"joints": {"LLEG_JOINT3": "x"}}})", "start.joints.LLEG_JOINT3",
          "a number");
  refused(R"({"placements": [], "cost": {"weights": {"LLEG_JOINT3": -1}}})", "cost.weights.LLEG_JOINT3",
          "from 0");
  refused(R"({"placements": [], "stability": {}})", "stability", "'contacts' is missing");
  refused(R"({"placements": [], "stability": {"contacts": []}})", "stability.contacts", "at least one");
  refused(R"({"placements": [], "stability": {"contacts": [{"link": "BODY", "points": []}]}})",
          "stability.contacts[0].points", "at least one");
  refused(R"({"placements": [], "stability": {"contacts": [{"link": "NO", "points": [[0, 0, 0]]}]}})",
          "stability.contacts[0].link", "no link 'NO'");
  refused(
      R"({"placements": [], "stability": {"margin": 0.1, "contacts": [{"link": "BODY", "points": [[0, 0, 0]]}]}})",
      "stability: contacts[0]", "smaller margin");
  refused(R"({"placements": [], "collisions": {"pairs": [{"links": ["NO"]}]}})", "collisions.pairs[0].links",
          "no link 'NO'");
  refused(R"({"placements": [], "collisions": {"pairs": [{"links": ["CHEST_LNK0"]}]}})",
          "collisions.pairs[0].links", "no link 'CHEST_LNK0'; did you mean 'CHEST_LINK0'?");
  refused(R"({"placements": [], "start": {"joints": {"LLEG_JOINT33": 1}}})", "start.joints",
          "'LLEG_JOINT33' of its own; did you mean 'LLEG_JOINT3'?");
  refused(R"({"placements": [], "collisions": {"ignore": [{"obstacles": ["NO"]}]}})",
          "collisions.ignore[0].obstacles", "no obstacle 'NO'");
  refused(R"({"placements": [], "collisions": {"ignore": [{"obstacles": ["cam"]}]}})",
          "collisions.ignore[0].obstacles", "no obstacle 'cam'; did you mean 'can'?");
  refused(R"({"placements": [], "collisions": {"margin": 2}})", "collisions.margin", "from -1 to 1");
}

TEST_CASE("pairs are what the task names, less what it ignores") {
  const PostureScene scene = hrp2Scene();
  const auto count = [&](const std::string& collisions) {
    return pairsOf(parseTask(R"({"placements": [], "collisions": )" + collisions + "}", "task.json"), scene)
        .size();
  };
  const std::size_t bodies = scene.geometry->bodies.size(), obstacles = scene.obstacles.size();
  CHECK(count("{}") == 130 + bodies * obstacles);
  CHECK(count(R"({"self": false})") == bodies * obstacles);
  CHECK(count(R"({"self": false, "pairs": [{"links": ["BODY"]}, {"obstacles": ["can"]}]})") ==
        bodies + obstacles - 1);
  CHECK(count(R"({"self": false, "ignore": [{"links": ["BODY"], "obstacles": ["can"]}]})") ==
        bodies * obstacles - 1);
}

TEST_CASE("an obstacle's other shapes are named with it, and other links whose names begin so are not") {
  PostureScene scene = hrp2Scene();
  std::vector<std::string> names = {"can", "can#2", "can#left"};
  for (std::size_t i = 0; i < names.size(); ++i) scene.obstacles[i].name = names[i];
  for (std::size_t i = names.size(); i < scene.obstacles.size(); ++i) scene.obstacles[i].name = "other";
  const auto pairs = [&](const std::string& obstacle) {
    const std::string collisions =
        R"({"self": false, "pairs": [{"links": ["BODY"], "obstacles": [")" + obstacle + R"("]}]})";
    return pairsOf(parseTask(R"({"placements": [], "collisions": )" + collisions + "}", "task.json"), scene)
        .size();
  };
  CHECK(pairs("can") == 2);
  CHECK(pairs("can#left") == 1);
}

TEST_CASE("placements with one name are numbered") {
  const std::string origin = R"("target": {"position": [0, 0, 0]}})";
  const PostureTask task =
      parseTask(R"({"placements": [{"link": "BODY", )" + origin + R"(, {"link": "HEAD_LINK1", )" + origin +
                    R"(, {"link": "BODY", )" + origin + "]}",
                "task.json");
  CHECK(task.placements[0].placement.name == "BODY#1");
  CHECK(task.placements[1].placement.name == "HEAD_LINK1");
  CHECK(task.placements[2].placement.name == "BODY#2");
}
