// Makes a RobotModel from a URDF's text: checks the XML's names and tree, reads each element separately by
// urdfdom, resolves mimic joints and limits, and makes sure that every <collision> became a shape.
#include "fcl_stpbv/robot/robot_model.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/error_place.h"
#include "fcl_stpbv/mesh/xml_text.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/followed_range.h"
#include "fcl_stpbv/robot/mimic_chain.h"
#include "fcl_stpbv/robot/urdf_check.h"
#include "fcl_stpbv/robot/urdf_element.h"
#include "fcl_stpbv/robot/urdf_shape.h"
#include "fcl_stpbv/robot/urdf_words.h"

namespace fcl_stpbv {

template <int alignment, int byMalloc>
void detail::EigenMemory<alignment, byMalloc>::asInTheLibrary() {}
template struct detail::EigenMemory<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED>;

namespace {

using namespace detail;
using tinyxml2::XMLElement;

void readInertial(const XMLElement& element, LinkModel& link) {
  checkInertialWords(element);
  const urdf::InertialSharedPtr inertial = readInertialElement(element);
  const Eigen::Vector3d centre = toEigen(inertial->origin.position);
  if (!std::isfinite(inertial->mass) || inertial->mass < 0 || !centre.allFinite())
    throw Error("its mass must be finite and not negative, its centre of mass finite");
  link.mass = inertial->mass;
  link.centreOfMass = centre;
}

LinkModel readLink(const XMLElement& element, const std::string& path, RobotModel& robot,
                   LoadFaults& faults) {
  LinkModel link;
  link.name = element.Attribute("name");
  const std::size_t collisions = faults.shapes.size(), visuals = robot.visualFaults.size();
  link.collision = readShapes(element, "collision", path, faults.shapes);
  link.visual = readShapes(element, "visual", path, robot.visualFaults);
  link.lacksCollision = faults.shapes.size() > collisions;
  link.lacksVisual = robot.visualFaults.size() > visuals;
  if (const XMLElement* inertial = inertialOf(element)) {
    try {
      readInertial(*inertial, link);
    } catch (const Error& error) {
      const std::string named = xmlPlace(*inertial, path) + "link '" + link.name + "'";
      link.massFault = named + ": " + error.what();
      faults.warnings.push_back(named + " counts as without mass: " + error.what());
    }
  }
  return link;
}

JointType toType(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::FIXED:
      return JointType::fixed;
    case urdf::Joint::REVOLUTE:
      return JointType::revolute;
    case urdf::Joint::CONTINUOUS:
      return JointType::continuous;
    case urdf::Joint::PRISMATIC:
      return JointType::prismatic;
    case urdf::Joint::PLANAR:
      return JointType::planar;
    case urdf::Joint::FLOATING:
      return JointType::floating;
    default:
      throw Error("is of no type that URDF knows");
  }
}

void readLimits(const urdf::Joint& joint, JointModel& model) {
  if (model.type == JointType::planar) return;  // it has no range, as a floating joint has none
  if (model.type == JointType::continuous) {
    model.lower = -kPi;
    model.upper = kPi;
  } else if (joint.limits) {
    model.lower = joint.limits->lower;
    model.upper = joint.limits->upper;
  }
  if (!std::isfinite(model.lower) || !std::isfinite(model.upper) || model.lower > model.upper)
    throw Error("its limits must be finite, and the lower one not above the upper one");
  if (model.lower > kLargestValue || model.upper < -kLargestValue)
    throw Error("its limits leave nothing between -1e6 and 1e6");
  model.lower = std::max(model.lower, -kLargestValue);  // limits such as 1e16 stand for no limit
  model.upper = std::min(model.upper, kLargestValue);
}

struct ReadJoint {
  JointModel model;
  Follower follower;
};

ReadJoint readJoint(const XMLElement& element, const UrdfTree& tree) {
  checkJointWords(element);
  const std::string type = element.Attribute("type");
  if ((type == "revolute" || type == "prismatic") && !element.FirstChildElement("limit"))
    throw Error("is " + type + " and needs a <limit> with lower and upper" +
                (type == "revolute" ? "; give it one, or make it continuous" : ""));
  const urdf::JointSharedPtr read = readJointElement(element);
  ReadJoint joint;
  JointModel& model = joint.model;
  model.name = element.Attribute("name");
  model.type = toType(*read);
  model.parent = tree.index.at(element.FirstChildElement("parent")->Attribute("link"));
  model.child = tree.index.at(element.FirstChildElement("child")->Attribute("link"));
  model.origin = toEigen(read->parent_to_joint_origin_transform);
  if (model.type != JointType::fixed && model.type != JointType::floating) {
    model.axis = toEigen(read->axis);
    if (!isUsable(model.axis) || !(model.axis.norm() > 1e-9))
      throw Error("its axis has no direction; give one such as 0 0 1");
    model.axis.normalize();
    readLimits(*read, model);
  }
  joint.follower.joint = model.name;
  if (read->mimic && read->mimic->joint_name.empty())
    throw Error("its <mimic> names no joint; give one, or remove it");
  if (read->mimic)
    joint.follower = {model.name, read->mimic->joint_name, read->mimic->multiplier, read->mimic->offset};
  return joint;
}

// @throws Error without naming the joint's place.
void setMimic(const Mimic& end, int joint, RobotModel& robot) {
  JointModel& model = robot.joints[static_cast<std::size_t>(joint)];
  if (end.joint == joint || model.type == JointType::fixed) return;
  const auto single = [](const JointModel& m) {
    return m.type >= JointType::revolute && m.type <= JointType::prismatic;
  };
  const JointModel& leader = robot.joints[static_cast<std::size_t>(end.joint)];
  if (!single(leader))
    throw Error("mimics '" + leader.name + "', expected a joint that moves along or about one axis");
  if (!single(model) || !(std::abs(end.multiplier) <= kLargestValue) ||
      !(std::abs(end.offset) <= kLargestValue))
    throw Error("only a joint with one axis can mimic another one, by numbers from -1e6 to 1e6");
  model.mimic = end;
}

void readJoints(const UrdfTree& tree, RobotModel& robot, LoadFaults& faults) {
  std::vector<Follower> followers;
  std::vector<std::string> places;
  const auto gather = [&](const std::string& place, const auto& work) {
    LoadFaults::gather(faults.errors, [&] { within(place, work); });
  };
  for (const XMLElement* e : tree.joints) {
    const std::string place = xmlPlace(*e, robot.path) + "joint '" + e->Attribute("name") + "'";
    gather(place, [&] {
      const ReadJoint joint = readJoint(*e, tree);
      robot.links[static_cast<std::size_t>(joint.model.child)].parentJoint =
          static_cast<int>(robot.joints.size());
      robot.joints.push_back(joint.model);
      followers.push_back(joint.follower);
      places.push_back(place);
    });
  }
  MimicChains chains(followers);
  for (std::size_t j = 0; j < followers.size(); ++j) {
    // The faults of a joint that is not here are reported already.
    if (followers[j].mimics.empty() || tree.jointNames.count(chains.missing(j)) > 0) continue;
    gather(places[j], [&] { setMimic(chains.end(j), static_cast<int>(j), robot); });
  }
  widenFollowed(robot.joints);
}

// Counts the text's elements independently, to make sure that every element is in the model.
void checkAllThere(int collisions, const RobotModel& robot, std::size_t refused) {
  std::size_t kept = refused;
  for (const LinkModel& link : robot.links)
    for (const ShapeModel& shape : link.collision) kept += static_cast<std::size_t>(shape.elements);
  if (kept != static_cast<std::size_t>(collisions))
    throw Error(robot.path + ": has " + std::to_string(collisions) + " <collision> elements, of which " +
                std::to_string(kept) + " were read; give links and shapes names of their own");
}

template <class Items>
int indexOf(const Items& items, const std::string& name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
  return found == items.end() ? -1 : static_cast<int>(found - items.begin());
}

template <class Load>
RobotModel orRefuse(Load load) {
  LoadFaults faults;
  RobotModel robot = load(faults);
  faults.refuse();
  return robot;
}

}  // namespace

int RobotModel::link(const std::string& linkName) const { return indexOf(links, linkName); }
int RobotModel::joint(const std::string& jointName) const { return indexOf(joints, jointName); }

RobotModel parseUrdf(const std::string& text, const std::string& path, LoadFaults& faults) {
  tinyxml2::XMLDocument document;
  parseXml(text, path, document);
  const XMLElement& root = *document.RootElement();
  if (std::string(root.Name()) != "robot")
    throw Error(path + ": its root element is <" + root.Name() + ">, expected <robot>");
  RobotModel robot;
  robot.name = requiredAttribute(root, "name", path);
  robot.path = path;
  std::set<const XMLElement*> incomplete;
  const int collisions = checkPlaces(root, path, faults, incomplete);
  const UrdfTree tree = readTree(root, path, faults);
  const std::size_t errors = faults.errors.size(), refused = faults.shapes.size();
  for (const XMLElement* link : tree.links) {
    robot.links.push_back(readLink(*link, path, robot, faults));
    if (incomplete.count(link) > 0) robot.links.back().lacksCollision = robot.links.back().lacksVisual = true;
  }
  if (errors == 0) checkAllThere(collisions, robot, faults.shapes.size() - refused);
  readJoints(tree, robot, faults);
  return robot;
}

RobotModel parseUrdf(const std::string& text, const std::string& path) {
  return orRefuse([&](LoadFaults& faults) { return parseUrdf(text, path, faults); });
}

RobotModel loadUrdf(const std::string& path, LoadFaults& faults) {
  return parseUrdf(readXml(path), path, faults);
}

RobotModel loadUrdf(const std::string& path) {
  return orRefuse([&](LoadFaults& faults) { return loadUrdf(path, faults); });
}

}  // namespace fcl_stpbv
