// Which links count as adjacent or rigidly joined, on a skeleton in which most links have no body.
#include <catch2/catch.hpp>

#include "fcl_stpbv/robot/adjacency.h"
#include "fcl_stpbv/robot/geometry_steps.h"
#include "fcl_stpbv/robot/pair_list.h"
#include "test/reference/robots.h"
#include "test/robot/urdf_texts.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

const std::string kBall = "<sphere radius=\"0.05\"/>";

std::string at(const std::string& xyz) { return "<origin xyz=\"" + xyz + "\"/>"; }

// Pelvis, thighs, feet, head and hands have bodies. A hip is three joints with one origin. A spine of three
// joints with different origins carries the head. A foot is attached to a knee and an ankle 0.4 m below it.
std::string skeleton() {
  std::string text =
      link("pelvis", kBall) + link("imu", kBall) + joint("imu_fix", "fixed", "pelvis", "imu", at("0 0 0.3"));
  for (const std::string side : {"l_", "r_"}) {
    const std::string y = side == "l_" ? "0.1" : "-0.1";
    text += link(side + "hip1") + link(side + "hip2") + link(side + "thigh", kBall) + link(side + "shin") +
            link(side + "foot", kBall);
    text += joint(side + "yaw", "revolute", "pelvis", side + "hip1", at("0 " + y + " -0.1"));
    text += joint(side + "roll", "revolute", side + "hip1", side + "hip2", at("0 0.000001 0"));
    text += joint(side + "pitch", "revolute", side + "hip2", side + "thigh");
    text += joint(side + "knee", "revolute", side + "thigh", side + "shin", at("0 0 -0.4"));
    text += joint(side + "ankle", "revolute", side + "shin", side + "foot", at("0 0 -0.4"));
  }
  text += link("spine1") + link("spine2") + link("head", kBall);
  text += joint("bend1", "revolute", "pelvis", "spine1", at("0 0 0.1"));
  text += joint("bend2", "revolute", "spine1", "spine2", at("0 0 0.2"));
  text += joint("neck", "revolute", "spine2", "head", at("0 0 0.2"));
  text += link("l_hand", kBall) + link("r_hand", kBall);
  text += joint("l_arm", "revolute", "spine2", "l_hand", at("0 0.3 0"));
  text += joint("r_arm", "revolute", "spine2", "r_hand", at("0 -0.3 0"));
  return robot(text);
}

struct Scene {
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const RobotGeometry> geometry;
  Joining of(const std::string& a, const std::string& b) const {
    return Adjacency(*model, *geometry).of(model->link(a), model->link(b));
  }
};

Scene sceneOf(const std::string& text) {
  LoadedRobot loaded = parsed(text);
  return {loaded.model, std::make_shared<const RobotGeometry>(std::move(loaded.geometry))};
}

}  // namespace

TEST_CASE("links without bodies are bridged where their joints' origins coincide, and nowhere else") {
  const Scene scene = sceneOf(skeleton());
  CHECK(scene.of("pelvis", "l_thigh") == Joining::adjacent);  // the three joints of a hip
  CHECK(scene.of("l_thigh", "pelvis") == Joining::adjacent);
  CHECK(scene.of("l_thigh", "l_foot") == Joining::separate);  // knee and ankle are 0.4 m apart
  CHECK(scene.of("pelvis", "head") == Joining::separate);     // a spine bends
  CHECK(scene.of("l_hand", "r_hand") == Joining::separate);   // two arms at one chest that has no body
  CHECK(scene.of("head", "l_hand") == Joining::separate);
  CHECK(scene.of("l_thigh", "r_thigh") == Joining::separate);
  CHECK(scene.of("pelvis", "imu") == Joining::rigid);
  CHECK(scene.of("imu", "l_thigh") == Joining::separate);  // the pelvis lies between them
}

TEST_CASE(
    "one joint makes links adjacent through fixed links without bodies, two apart or of another kind do "
    "not") {
  const auto chain = [](const std::string& more) {
    return sceneOf(robot(link("a", kBall) + link("b", kBall) + more));
  };
  const std::string far = at("0.5 0 0");
  CHECK(chain(joint("j", "prismatic", "a", "b", far)).of("a", "b") == Joining::adjacent);
  CHECK(
      chain(link("x") + joint("f", "fixed", "a", "x", far) + joint("j", "revolute", "x", "b")).of("a", "b") ==
      Joining::adjacent);
  CHECK(chain(link("x") + joint("j", "revolute", "a", "x") +
              joint("k", "revolute", "x", "b", at("0.00002 0 0")))
            .of("a", "b") == Joining::separate);
  CHECK(
      chain(link("x") + joint("j", "prismatic", "a", "x") + joint("k", "revolute", "x", "b")).of("a", "b") ==
      Joining::separate);
  // Another body fixed to the link between them, as near to the joint as `a`, or nearer.
  const std::string bodyOnX = link("x") + link("y", kBall) + joint("f", "fixed", "a", "x", far) +
                              joint("g", "fixed", "x", "y") + joint("j", "revolute", "x", "b");
  CHECK(chain(bodyOnX).of("a", "b") == Joining::separate);
  CHECK(chain(bodyOnX).of("y", "b") == Joining::separate);
  CHECK(chain(bodyOnX).of("b", "a") == Joining::separate);
  const std::string nearer = link("w") + link("x") + link("y", kBall) + joint("e", "fixed", "a", "w", far) +
                             joint("f", "fixed", "w", "x") + joint("g", "fixed", "x", "y");
  CHECK(chain(nearer + joint("j", "revolute", "x", "b")).of("a", "b") == Joining::separate);
  CHECK(chain(nearer + joint("j", "revolute", "x", "b")).of("y", "b") == Joining::adjacent);
  CHECK(chain(nearer + joint("j", "revolute", "w", "b")).of("a", "b") == Joining::adjacent);
  CHECK(chain(nearer + joint("j", "revolute", "w", "b")).of("b", "y") == Joining::separate);
  // A body fixed to the link between them is one that the two move about.
  CHECK(chain(link("x") + link("y", kBall) + joint("j", "revolute", "a", "x") +
              joint("f", "fixed", "x", "y", far) + joint("k", "revolute", "x", "b"))
            .of("a", "b") == Joining::separate);
  // Origins that coincide although a fixed joint and a joint's offset are between them.
  CHECK(chain(link("x") + link("y") + joint("j", "revolute", "a", "x", far) +
              joint("f", "fixed", "x", "y", at("0 0 0.1")) + joint("k", "revolute", "y", "b", at("0 0 -0.1")))
            .of("a", "b") == Joining::adjacent);
}

TEST_CASE("a link with a shape that was left out counts as having a body, for any fault of the shape") {
  const std::string box = "<geometry><box size=\"1 1 1\"/></geometry>";
  const auto between = [&](const std::string& middle, bool visual) {
    std::string text = robot(link("a", kBall) + "<link name=\"m\">" + middle + "</link>" + link("b", kBall) +
                             joint("f", "fixed", "a", "m") + joint("j", "revolute", "m", "b"));
    if (visual) {
      for (std::size_t at = 0; (at = text.find("collision>", at)) != std::string::npos;)
        text.replace(at, 10, "visual>");
    }
    LoadFaults faults;
    const auto model = std::make_shared<const RobotModel>(parseUrdf(text, "small.urdf", faults));
    GeometryOptions options;
    options.cacheFolder.clear();
    options.visual = visual;
    const ShapeSources shapes = readGeometry(*model, options, faults);
    const RobotGeometry geometry = buildGeometry(*model, options, shapes, faults);
    CHECK(geometry.bodies.size() == 2);
    CHECK(faults.shapes.empty() == geometry.incomplete.empty());
    auto whole = std::make_shared<const RobotGeometry>(geometry);
    CHECK(LinkParts(whole, "").geometry({}, {}).incomplete == geometry.incomplete);
    return Adjacency(*model, geometry).of(model->link("a"), model->link("b"));
  };
  for (const bool visual : {false, true}) {
    CAPTURE(visual);
    CHECK(between("", visual) == Joining::adjacent);
    for (const char* wrong :
         {"<mesh filename=\"missing.stl\"/>", "<sphere radius=\"0\"/>", "<bx size=\"1 1 1\"/>"})
      CHECK(between(std::string("<collision><geometry>") + wrong + "</geometry></collision>", visual) ==
            Joining::separate);
    CHECK(between("<colision>" + box + "</colision>", visual) == Joining::separate);
    CHECK(between("<shape>" + box + "</shape>", visual) == Joining::separate);
  }
  // Faults of shapes that are not used do not matter.
  CHECK(between("<visual><geometry><sphere radius=\"0\"/></geometry></visual>", false) == Joining::adjacent);
}

TEST_CASE("a planar or floating joint holds its links nowhere near each other") {
  for (const char* type : {"planar", "floating"}) {
    const Scene scene = sceneOf(robot(link("a", kBall) + link("x") + link("b", kBall) + link("c", kBall) +
                                      joint("f", "fixed", "a", "x") + joint("j", type, "x", "b") +
                                      joint("k", "revolute", "b", "c", at("0.5 0 0"))));
    CHECK(scene.of("a", "b") == Joining::separate);
    CHECK(scene.of("b", "a") == Joining::separate);
    CHECK(scene.of("b", "c") == Joining::adjacent);
  }
}

TEST_CASE("a skeleton of few bodies has pairs to check, and its rigid ones are said to be") {
  const Scene scene = sceneOf(skeleton());
  PairListOptions options;
  options.samples = 50;
  const std::vector<PairEntry> list =
      pairList(std::make_shared<const Kinematics>(scene.model), scene.geometry, nullptr, options);
  const auto count = [&](PairReason reason) {
    return std::count_if(list.begin(), list.end(), [&](const PairEntry& e) { return e.reason == reason; });
  };
  REQUIRE(list.size() == 9 * 8 / 2);
  CHECK(count(PairReason::adjacent) == 2);
  CHECK(count(PairReason::rigid) == 1);
  CHECK(checkedPairs(*scene.geometry, list).size() == 33);
  CHECK(selfPairs(*scene.model, *scene.geometry, nullptr).size() == 33);
  for (const Srdf::Pair& pair : toSrdf(*scene.model, list))
    if (pair.link1 == "imu" && pair.link2 == "pelvis") CHECK(pair.reason == "Never");  // always 0.2 m apart
}
