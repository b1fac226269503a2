// Reading through urdfdom; see robot_model.h.
#include "fcl_stpbv/robot/robot_model.h"

#include <console_bridge/console.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>
#include <unordered_map>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/robot/capsule_fit.h"
#include "fcl_stpbv/robot/urdf_check.h"
#include "fcl_stpbv/robot/xml_text.h"

namespace fcl_stpbv {
namespace {

using Names = std::unordered_map<std::string, int>;

// urdfdom says what is wrong with a file on the console only. This keeps it for the exception's message.
class Listener : public console_bridge::OutputHandler {
 public:
  Listener() : guard_(mutex()) { console_bridge::useOutputHandler(this); }
  ~Listener() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && heard_.size() < 1000)
      heard_ += (heard_.empty() ? "" : "; ") + text;
  }
  const std::string& heard() const { return heard_; }

 private:
  static std::mutex& mutex() {
    static std::mutex one;  // the console's handler is one for the whole process
    return one;
  }
  std::lock_guard<std::mutex> guard_;
  std::string heard_;
};

// urdfdom's links own their children: a chain of thousands would be destroyed recursively, a loop never.
class Parsed {
 public:
  explicit Parsed(urdf::ModelInterfaceSharedPtr model) : model_(std::move(model)) {}
  ~Parsed() {
    for (auto& [name, link] : model_->links_) {
      link->child_links.clear();
      link->child_joints.clear();
    }
  }
  Parsed(const Parsed&) = delete;
  Parsed& operator=(const Parsed&) = delete;
  const urdf::ModelInterface* operator->() const { return model_.get(); }

 private:
  urdf::ModelInterfaceSharedPtr model_;
};

urdf::ModelInterfaceSharedPtr readUrdf(const std::string& xml, const std::string& path) {
  Listener listener;
  std::string reason;
  try {
    urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(xml);
    if (model) return model;
  } catch (const std::exception& error) {
    reason = error.what();
  }
  const std::string& heard = listener.heard().empty() ? reason : listener.heard();
  throw Error(path + ": not a URDF that can be read" + (heard.empty() ? "" : " (" + heard + ")"));
}

Eigen::Vector3d toEigen(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Eigen::Isometry3d toEigen(const urdf::Pose& pose, const std::string& where) {
  const Eigen::Quaterniond rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  const Eigen::Vector3d position = toEigen(pose.position);
  if (!position.allFinite() || !rotation.coeffs().allFinite() || !(rotation.norm() > 0.5))
    throw Error(where + ": its origin is not finite");
  return Eigen::Translation3d(position) * rotation.normalized();
}

ShapeModel toShape(const urdf::Geometry& geometry, const urdf::Pose& origin, bool capsule,
                   const std::string& where) {
  ShapeModel shape;
  shape.pose = toEigen(origin, where);
  if (geometry.type == urdf::Geometry::SPHERE) {
    shape.kind = ShapeModel::Kind::sphere;
    shape.size.x() = static_cast<const urdf::Sphere&>(geometry).radius;
  } else if (geometry.type == urdf::Geometry::BOX) {
    shape.kind = ShapeModel::Kind::box;
    shape.size = toEigen(static_cast<const urdf::Box&>(geometry).dim);
  } else if (geometry.type == urdf::Geometry::CYLINDER) {
    const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
    shape.kind = capsule ? ShapeModel::Kind::capsule : ShapeModel::Kind::cylinder;
    shape.size = {cylinder.radius, cylinder.length, 0};
  } else {
    const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
    shape.mesh = mesh.filename;
    shape.scale = toEigen(mesh.scale);
    if (!shape.scale.allFinite() || (shape.scale.array() == 0).any())
      throw Error(where + ": the scale of " + shape.mesh + " is 0 or not finite; give three other numbers");
    return shape;
  }
  if (!shape.size.allFinite() || (shape.size.array() < 0).any() || !(shape.size.x() > 0))
    throw Error(where + ": a shape's sizes must be finite and larger than 0");
  return shape;
}

LinkModel toLink(const urdf::Link& link, const CapsuleNames& capsules, const std::string& path) {
  const std::string where = path + ": link '" + link.name + "'";
  LinkModel model;
  model.name = link.name;
  int index = 0;
  for (const auto& collision : link.collision_array) {
    const bool capsule = capsules.count({link.name, index++}) > 0;
    if (collision && collision->geometry)
      model.collision.push_back(toShape(*collision->geometry, collision->origin, capsule, where));
  }
  for (const auto& visual : link.visual_array) {
    if (visual && visual->geometry)
      model.visual.push_back(toShape(*visual->geometry, visual->origin, false, where));
  }
  joinCapsules(model.collision);
  joinCapsules(model.visual);
  if (link.inertial) {
    model.mass = link.inertial->mass;
    model.centreOfMass = toEigen(link.inertial->origin.position);
    if (!std::isfinite(model.mass) || model.mass < 0 || !model.centreOfMass.allFinite())
      throw Error(where + ": its mass must be finite and not negative, its centre of mass finite");
  }
  return model;
}

JointType toType(const urdf::Joint& joint, const std::string& where) {
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
      throw Error(where + ": is of no type that URDF knows");
  }
}

void readLimits(const urdf::Joint& joint, JointModel& model, const std::string& where) {
  if (model.type == JointType::continuous) {
    model.lower = -M_PI;
    model.upper = M_PI;
  } else if (joint.limits) {
    model.lower = joint.limits->lower;
    model.upper = joint.limits->upper;
  }
  if (!std::isfinite(model.lower) || !std::isfinite(model.upper) || model.lower > model.upper)
    throw Error(where + ": its limits must be finite, and the lower one not above the upper one");
}

JointModel toJoint(const urdf::Joint& joint, const Names& links, const std::string& path) {
  const std::string where = path + ": joint '" + joint.name + "'";
  JointModel model;
  model.name = joint.name;
  model.type = toType(joint, where);
  model.parent = links.at(joint.parent_link_name);
  model.child = links.at(joint.child_link_name);
  model.origin = toEigen(joint.parent_to_joint_origin_transform, where);
  if (model.type != JointType::fixed && model.type != JointType::floating) {
    model.axis = toEigen(joint.axis);
    if (!model.axis.allFinite() || !(model.axis.norm() > 1e-9))
      throw Error(where + ": its axis has no direction; give one such as 0 0 1");
    model.axis.normalize();
    readLimits(joint, model, where);
  }
  return model;
}

// Each follower is tied to the joint at the end of its chain.
void resolveMimics(const std::vector<const urdf::Joint*>& parsed, RobotModel& robot) {
  for (std::size_t j = 0; j < parsed.size(); ++j) {
    double multiplier = 1, offset = 0;
    const urdf::Joint* at = parsed[j];
    for (std::size_t steps = 0; at->mimic; ++steps) {
      const std::string where = robot.path + ": joint '" + parsed[j]->name + "'";
      const int next = robot.joint(at->mimic->joint_name);
      if (next < 0) throw Error(where + ": mimics '" + at->mimic->joint_name + "', which does not exist");
      if (steps > parsed.size()) throw Error(where + ": mimics itself through others; break the loop");
      offset += multiplier * at->mimic->offset;
      multiplier *= at->mimic->multiplier;
      at = parsed[static_cast<std::size_t>(next)];
    }
    if (at == parsed[j] || robot.joints[j].type == JointType::fixed) continue;
    JointModel& joint = robot.joints[j];
    const int master = robot.joint(at->name);
    const auto single = [](JointType t) { return t >= JointType::revolute && t <= JointType::prismatic; };
    if (!single(joint.type) || !single(robot.joints[static_cast<std::size_t>(master)].type) ||
        !std::isfinite(multiplier) || !std::isfinite(offset)) {
      throw Error(robot.path + ": joint '" + joint.name + "': only a joint with one axis can mimic another " +
                  "one, by finite numbers");
    }
    joint.mimic = Mimic{master, multiplier, offset};
  }
}

template <class Items>
int indexOf(const Items& items, const std::string& name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const auto& item) { return item.name == name; });
  return found == items.end() ? -1 : static_cast<int>(found - items.begin());
}

}  // namespace

int RobotModel::link(const std::string& linkName) const { return indexOf(links, linkName); }
int RobotModel::joint(const std::string& jointName) const { return indexOf(joints, jointName); }

RobotModel parseUrdf(const std::string& text, const std::string& path) {
  const CheckedUrdf checked = checkUrdf(text, path);
  const Parsed parsed(readUrdf(checked.xml, path));
  RobotModel robot;
  robot.name = parsed->getName();
  robot.path = path;
  Names index;
  for (const std::string& name : checked.links) {
    index[name] = static_cast<int>(robot.links.size());
    robot.links.push_back(toLink(*parsed->links_.at(name), checked.capsules, path));
  }
  std::vector<const urdf::Joint*> joints;
  for (const std::string& name : checked.joints) {
    joints.push_back(parsed->joints_.at(name).get());
    robot.joints.push_back(toJoint(*joints.back(), index, path));
    robot.links[static_cast<std::size_t>(robot.joints.back().child)].parentJoint =
        static_cast<int>(robot.joints.size()) - 1;
  }
  resolveMimics(joints, robot);
  return robot;
}

RobotModel loadUrdf(const std::string& path) {
  tinyxml2::XMLDocument refused;
  loadXml(path, refused);  // names the file's own lines in messages
  return parseUrdf(readText(path), path);
}

}  // namespace fcl_stpbv
