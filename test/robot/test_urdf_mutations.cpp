// No false "clear" from a damaged URDF: whatever is done to any element or attribute, the robot is refused,
// or every <collision> of the text is in the model. A misspelt word never changes the robot silently.
#include <tinyxml2.h>

#include <catch2/catch.hpp>
#include <functional>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/robot/robot_model.h"
#include "test/reference/source_folder.h"
#include "test/reference/volume_files.h"

using namespace fcl_stpbv;
using namespace fcl_stpbv::detail;
using namespace fcl_stpbv::test;
using tinyxml2::XMLElement;

namespace {

std::string printed(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  document.Print(&printer);
  return printer.CStr();
}

// Counted in the text, without a parser.
int collisionsIn(const std::string& text) {
  int count = 0;
  const std::string tag = "<collision";
  for (std::size_t at = text.find(tag); at != std::string::npos; at = text.find(tag, at + 1)) {
    const char next = text[at + tag.size()];
    count += next == '>' || next == ' ' || next == '/';
  }
  return count;
}

int collisionsIn(const RobotModel& robot) {
  int count = 0;
  for (const LinkModel& link : robot.links)
    for (const ShapeModel& shape : link.collision) count += shape.elements;
  return count;
}

// All that decides where the collision bodies are, as text.
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

std::vector<XMLElement*> elementsOf(tinyxml2::XMLDocument& document) {
  std::vector<XMLElement*> all{document.RootElement()};
  for (std::size_t i = 0; i < all.size(); ++i)
    for (XMLElement* e = all[i]->FirstChildElement(); e; e = e->NextSiblingElement()) all.push_back(e);
  return all;
}

struct Mutation {
  std::string what;
  bool misspelt;  // nothing but a name has changed
};

std::string misspelt(const std::string& name) { return name.substr(0, name.size() - 1) + "x"; }

Mutation mutateElement(XMLElement& e, int kind) {
  const std::string name = e.Name();
  tinyxml2::XMLNode* parent = e.Parent();
  switch (kind % 5) {
    case 0:
      e.SetName(misspelt(name).c_str());
      return {"misspelt <" + name + ">", true};
    case 1:
      parent->InsertAfterChild(&e, e.DeepClone(e.GetDocument()));
      return {"doubled <" + name + ">", false};
    case 2:
      e.DeleteChildren();
      return {"emptied <" + name + ">", false};
    case 3:
      for (const char* broken : {"visual", "material", "inertial", "collision"})
        e.InsertFirstChild(e.GetDocument()->NewElement(broken));
      return {"empty elements in <" + name + ">", false};
    default:
      parent->DeleteChild(&e);
      return {"deleted <" + name + ">", false};
  }
}

Mutation mutateAttribute(XMLElement& e, const std::string& name, int kind) {
  const std::string value = e.Attribute(name.c_str()), where = " of <" + std::string(e.Name()) + ">";
  const std::vector<std::string> values = {"",     "x",       "nan nan nan", "1e999",
                                           "0 0",  "1,5 0 0", "0 0 0",       "-inf",
                                           "0x10", "1 2 3 4", value + " 1",  value + "e999"};
  if (kind % 3 == 0) {
    e.DeleteAttribute(name.c_str());
    e.SetAttribute(misspelt(name).c_str(), value.c_str());
    return {"misspelt " + name + where, true};
  }
  if (kind % 3 == 1) {
    const std::string& bad = values[static_cast<std::size_t>(kind / 3) % values.size()];
    e.SetAttribute(name.c_str(), bad.c_str());
    return {name + "=\"" + bad + "\"" + where, false};
  }
  e.DeleteAttribute(name.c_str());
  return {"no " + name + where, false};
}

struct Outcome {
  int tried = 0, refused = 0;
};

void judge(const std::string& original, const std::string& text, const Mutation& mutation, Outcome& outcome) {
  ++outcome.tried;
  CAPTURE(mutation.what);
  try {
    const RobotModel robot = parseUrdf(text, "mutated.urdf");
    if (collisionsIn(robot) != collisionsIn(text)) FAIL_CHECK("a body is missing");
    if (mutation.misspelt && geometryOf(robot) != original) FAIL_CHECK("a misspelt word changed the robot");
  } catch (const Error& error) {
    ++outcome.refused;
    if (std::string(error.what()).find("mutated.urdf") == std::string::npos) FAIL_CHECK(error.what());
  }
}

// Every `step`-th element and its attributes once, the kind of mutation going round.
Outcome mutateAll(const std::string& path, int shift, std::size_t step) {
  tinyxml2::XMLDocument whole;
  REQUIRE(whole.LoadFile(path.c_str()) == tinyxml2::XML_SUCCESS);
  const std::string text = printed(whole), original = geometryOf(parseUrdf(text, path));
  Outcome outcome;
  const std::size_t count = elementsOf(whole).size();
  int kind = shift;
  for (std::size_t i = 0; i < count; i += step) {
    std::vector<std::string> attributes;
    for (const tinyxml2::XMLAttribute* a = elementsOf(whole)[i]->FirstAttribute(); a; a = a->Next())
      attributes.push_back(a->Name());
    for (std::size_t a = 0; a <= attributes.size(); ++a) {
      if (i == 0 && a == attributes.size()) continue;  // the root itself stays
      tinyxml2::XMLDocument document;
      whole.DeepCopy(&document);
      XMLElement& e = *elementsOf(document)[i];
      const Mutation mutation =
          a < attributes.size() ? mutateAttribute(e, attributes[a], ++kind) : mutateElement(e, ++kind);
      judge(original, printed(document), mutation, outcome);
    }
  }
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
