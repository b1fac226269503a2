// A damaged URDF must not give a false "clear". For every damage to an element or attribute, either the robot
// is refused, or every <collision> of the text is in the model. A misspelt word never changes the robot
// silently.
#include <catch2/catch.hpp>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/robot/robot_model.h"
#include "test/reference/source_folder.h"
#include "test/reference/volume_files.h"
#include "test/robot/urdf_texts.h"
#include "test/robot/xml_mutations.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;

namespace {

int collisionsOf(const RobotModel& robot) {
  int count = 0;
  for (const LinkModel& link : robot.links)
    for (const ShapeModel& shape : link.collision) count += shape.elements;
  return count;
}

// Everything that decides where the collision bodies are, as text.
std::string geometryOf(const RobotModel& robot) {
  std::string text;
  const auto pose = [&](const Eigen::Isometry3d& p) {
    for (int i = 0; i < 4; ++i) appendVector(text += ' ', p.matrix().col(i).head<3>());
  };
  for (const LinkModel& link : robot.links) {
    for (const ShapeModel& shape : link.collision) {
      text += link.name + " " + std::to_string(static_cast<int>(shape.kind)) + shape.mesh + " ";
      appendVector(text, shape.size);
      appendVector(text += ' ', shape.scale);
      pose(shape.pose);
    }
  }
  for (const JointModel& joint : robot.joints) {
    text += "\n" + joint.name + " " + std::to_string(static_cast<int>(joint.type)) + " " +
            std::to_string(joint.parent) + " " + std::to_string(joint.child) + " " + toDecimal(joint.lower) +
            " " + toDecimal(joint.upper) + " ";
    appendVector(text, joint.axis);
    pose(joint.origin);
    if (joint.mimic)
      text += " " + std::to_string(joint.mimic->joint) + " " + toDecimal(joint.mimic->multiplier) + " " +
              toDecimal(joint.mimic->offset);
  }
  return text;
}

struct Outcome {
  int tried = 0, refused = 0;
};

void judge(const std::string& original, const std::string& text, const Mutation& mutation, Outcome& outcome) {
  ++outcome.tried;
  CAPTURE(mutation.what);
  try {
    const RobotModel robot = parseUrdf(text, "mutated.urdf");
    if (collisionsOf(robot) != collisionsIn(text)) FAIL_CHECK("a body is missing");
    if (mutation.misspelt && geometryOf(robot) != original) FAIL_CHECK("a misspelt word changed the robot");
  } catch (const Error& error) {
    ++outcome.refused;
    if (std::string(error.what()).find("mutated.urdf") == std::string::npos) FAIL_CHECK(error.what());
  }
}

Outcome mutateAll(const std::string& path, int shift, std::size_t step) {
  const std::string text = readText(path), original = geometryOf(parseUrdf(text, path));
  Outcome outcome;
  forEachMutation(text, shift, step, [&](const std::string& mutated, const Mutation& mutation) {
    judge(original, mutated, mutation, outcome);
  });
  return outcome;
}

}  // namespace

TEST_CASE("a URDF mutated in any element or attribute is refused or keeps all its bodies") {
  std::vector<std::string> paths{sourceFolder() + "/data/hrp2_style/hrp2_style.urdf"};
  const std::string shared = sharedFolder("robots");
  if (shared.empty())
    WARN("JVRC-1 and Panda skipped: no ../shared/robots");
  else
    for (const char* robot : {"/jvrc_description/urdf/jvrc1.urdf", "/panda_description/urdf/panda.urdf",
                              "/panda_description/urdf/panda_collision.urdf"})
      paths.push_back(shared + robot);
  int shift = 0;
  for (const std::string& path : paths) {
    const Outcome outcome = mutateAll(path, shift += 7, path == paths[0] ? 1 : 3);
    CAPTURE(path, outcome.tried, outcome.refused);
    CHECK(outcome.tried > 100);
    CHECK(outcome.refused > outcome.tried / 4);
  }
}
