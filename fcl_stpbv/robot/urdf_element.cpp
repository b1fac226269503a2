// Reads one shape, inertial or joint by urdfdom: wraps it in a small robot of its own, so that a fault does
// not affect other elements.
#include "fcl_stpbv/robot/urdf_element.h"

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <mutex>
#include <string>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/xml_text.h"
#include "fcl_stpbv/robot/followed_range.h"

namespace fcl_stpbv::detail {
namespace {

using tinyxml2::XMLElement;

// urdfdom reports errors only on the console. This captures them for the exception's message.
class Listener : public console_bridge::OutputHandler {
 public:
  Listener() : guard_(mutex()) { console_bridge::useOutputHandler(this); }
  ~Listener() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && heard_.empty()) heard_ = text.substr(0, 1000);
  }
  const std::string& heard() const { return heard_; }

 private:
  static std::mutex& mutex() {
    static std::mutex one;  // one, because the whole process has only one console handler
    return one;
  }
  std::lock_guard<std::mutex> guard_;
  std::string heard_;  // the first error; later errors are its consequences
};

// XML treats tabs and line ends in attributes as spaces, but urdfdom accepts only spaces between numbers.
void spaceOut(XMLElement& element) {
  for (const char* vector : {"xyz", "rpy", "size", "scale"}) {
    const char* numbers = element.Attribute(vector);
    if (!numbers) continue;
    std::string spaced = numbers;
    for (const char blank : {'\t', '\n', '\r'}) std::replace(spaced.begin(), spaced.end(), blank, ' ');
    element.SetAttribute(vector, spaced.c_str());
  }
  for (XMLElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) spaceOut(*e);
}

// A robot that contains only the given element.
class SmallRobot {
 public:
  SmallRobot() : robot_(add(document_, "robot")) { robot_->SetAttribute("name", "r"); }

  XMLElement* add(const char* element, const char* name) {
    XMLElement* made = add(*robot_, element);
    made->SetAttribute("name", name);
    return made;
  }
  XMLElement* add(tinyxml2::XMLNode& parent, const char* element) {
    return parent.InsertEndChild(document_.NewElement(element))->ToElement();
  }
  XMLElement* copy(XMLElement& parent, const XMLElement* element) {
    if (!element) return nullptr;
    XMLElement* made = parent.InsertEndChild(element->DeepClone(&document_))->ToElement();
    spaceOut(*made);
    return made;
  }

  // Parses the robot. Null if urdfdom refuses it; `reason` receives its error.
  urdf::ModelInterfaceSharedPtr parse(std::string& reason) const {
    tinyxml2::XMLPrinter printer(nullptr, true);
    robot_->Accept(&printer);
    const Listener listener;
    urdf::ModelInterfaceSharedPtr model;
    try {
      model = urdf::parseURDF(printer.CStr());
      reason = listener.heard();
    } catch (const std::exception& error) {
      reason = error.what();
    }
    return model;
  }

 private:
  tinyxml2::XMLDocument document_;
  XMLElement* robot_;
};

[[noreturn]] void refuse(const std::string& reason) {
  throw Error(reason.empty() ? "urdfdom cannot read it" : reason);
}

// urdfdom requires an effort and a velocity, which are not used here.
void copyLimit(SmallRobot& robot, XMLElement& joint, const XMLElement* limit) {
  XMLElement* copy = robot.copy(joint, limit);
  if (!copy) return;
  for (const char* unused : {"effort", "velocity"}) copy->SetAttribute(unused, "0");
}

}  // namespace

urdf::CollisionSharedPtr readShapeElement(const XMLElement& shape) {
  SmallRobot robot;
  XMLElement* link = robot.add("link", "l");
  XMLElement* collision = robot.add(*link, "collision");
  robot.copy(*collision, shape.FirstChildElement("origin"));
  XMLElement* geometry = robot.copy(*collision, shape.FirstChildElement("geometry"));
  XMLElement* capsule = geometry ? geometry->FirstChildElement("capsule") : nullptr;
  if (capsule) capsule->SetName("cylinder");
  std::string reason;
  const urdf::ModelInterfaceSharedPtr model = robot.parse(reason);
  const auto read = model ? model->getLink("l") : nullptr;
  if (!read || read->collision_array.size() != 1 || !read->collision_array[0]->geometry) refuse(reason);
  return read->collision_array[0];
}

urdf::InertialSharedPtr readInertialElement(const XMLElement& inertial) {
  SmallRobot robot;
  XMLElement* copy = robot.add(*robot.add("link", "l"), "inertial");
  for (const char* part : {"origin", "mass"}) robot.copy(*copy, inertial.FirstChildElement(part));
  XMLElement* inertia = robot.add(*copy, "inertia");  // urdfdom requires one, which is not used here
  for (const char* entry : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}) inertia->SetAttribute(entry, "0");
  std::string reason;
  const urdf::ModelInterfaceSharedPtr model = robot.parse(reason);
  const auto read = model ? model->getLink("l") : nullptr;
  // If the mass is wrong, urdfdom leaves it 0 and reports an error.
  if (!reason.empty() || !read || !read->inertial) refuse(reason);
  return read->inertial;
}

urdf::JointSharedPtr readJointElement(const XMLElement& joint) {
  SmallRobot robot;
  robot.add("link", "a");
  robot.add("link", "b");
  XMLElement* copy = robot.add("joint", "j");
  const char* type = joint.Attribute("type");
  if (type) copy->SetAttribute("type", type);
  robot.add(*copy, "parent")->SetAttribute("link", "a");
  robot.add(*copy, "child")->SetAttribute("link", "b");
  for (const char* part : {"origin", "axis", "mimic"}) robot.copy(*copy, joint.FirstChildElement(part));
  copyLimit(robot, *copy, joint.FirstChildElement("limit"));
  std::string reason;
  const urdf::ModelInterfaceSharedPtr model = robot.parse(reason);
  const auto read =
      model ? model->joints_.find("j") : std::map<std::string, urdf::JointSharedPtr>::iterator();
  if (!model || read == model->joints_.end()) refuse(reason);
  return read->second;
}

bool isUsable(const Eigen::Vector3d& v) {
  return v.allFinite() && v.lpNorm<Eigen::Infinity>() <= kLargestValue;
}

Eigen::Vector3d toEigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Eigen::Isometry3d toEigen(const urdf::Pose& pose) {
  const Eigen::Quaterniond rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  const Eigen::Vector3d position = toEigen(pose.position);
  if (!isUsable(position) || !rotation.coeffs().allFinite() || !(rotation.norm() > 0.5))
    throw Error("its origin must be finite, and within 1e6 m");
  return Eigen::Translation3d(position) * rotation.normalized();
}

std::string shapePlace(const tinyxml2::XMLElement& shape, const std::string& path, const std::string& link,
                       const char* use, int number) {
  return xmlPlace(shape, path) + "link '" + link + "', " + use + " " + std::to_string(number);
}

}  // namespace fcl_stpbv::detail
