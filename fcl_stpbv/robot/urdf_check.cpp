// See urdf_check.h.
#include "fcl_stpbv/robot/urdf_check.h"

#include <string>
#include <unordered_map>
#include <unordered_set>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/xml_text.h"

namespace fcl_stpbv {
namespace {

using tinyxml2::XMLElement;

struct Tree {
  std::vector<std::string> links;  // in the order of the file
  std::unordered_set<std::string> known;
  std::vector<std::string> joints;
  std::unordered_map<std::string, std::string> jointOf, parentOf;        // of a child link
  std::unordered_map<std::string, std::vector<std::string>> childrenOf;  // in the order of the file
};

std::string linkOf(const XMLElement& joint, const char* end, const std::string& where) {
  const XMLElement* element = joint.FirstChildElement(end);
  const char* link = element ? element->Attribute("link") : nullptr;
  if (!link || !*link) throw Error(where + ": names no " + end + " link; add <" + end + " link=\"...\"/>");
  return link;
}

void addJoint(Tree& tree, const XMLElement& element, const std::string& path) {
  const std::string joint = requiredAttribute(element, "name", path);
  const std::string where = path + ": joint '" + joint + "'";
  const std::string parent = linkOf(element, "parent", where), child = linkOf(element, "child", where);
  for (const std::string& link : {parent, child}) {
    if (!tree.known.count(link))
      throw Error(where + ": there is no link '" + link + "'; add it or correct the name");
  }
  const auto [other, isNew] = tree.jointOf.emplace(child, joint);
  if (!isNew) {
    throw Error(path + ": link '" + child + "' is the child of two joints, '" + other->second + "' and '" +
                joint + "'; a URDF is a tree, remove one");
  }
  tree.joints.push_back(joint);
  tree.parentOf[child] = parent;
  tree.childrenOf[parent].push_back(child);
}

Tree readTree(const XMLElement& robot, const std::string& path) {
  Tree tree;
  for (const XMLElement* e = robot.FirstChildElement("link"); e; e = e->NextSiblingElement("link")) {
    const std::string name = requiredAttribute(*e, "name", path);
    if (!tree.known.insert(name).second)
      throw Error(path + ": two links are named '" + name + "'; rename one");
    tree.links.push_back(name);
  }
  if (tree.links.empty()) throw Error(path + ": has no links; give a URDF with at least one <link>");
  std::unordered_set<std::string> joints;
  for (const XMLElement* e = robot.FirstChildElement("joint"); e; e = e->NextSiblingElement("joint")) {
    addJoint(tree, *e, path);
    if (!joints.insert(tree.joints.back()).second)
      throw Error(path + ": two joints are named '" + tree.joints.back() + "'; rename one");
  }
  return tree;
}

// The loop that `link`, which is not below the root, leads up into.
std::string loopAbove(const Tree& tree, std::string link) {
  for (std::size_t i = 0; i < tree.links.size(); ++i) link = tree.parentOf.at(link);  // now surely in it
  std::string text = "'" + link + "'";
  constexpr int kShown = 20;
  int shown = 0;
  for (std::string at = tree.parentOf.at(link);; at = tree.parentOf.at(at)) {
    text += ++shown > kShown ? "" : " <- '" + at + "'";
    if (at == link) return text + (shown > kShown ? " <- ..." : "");
  }
}

std::vector<std::string> inTreeOrder(const Tree& tree, const std::string& path) {
  std::string root;
  for (const std::string& link : tree.links) {
    if (tree.parentOf.count(link)) continue;
    if (!root.empty())
      throw Error(path + ": both '" + root + "' and '" + link + "' have no parent; join them by a joint");
    root = link;
  }
  if (root.empty()) throw Error(path + ": its links form a loop, " + loopAbove(tree, tree.links[0]));
  std::vector<std::string> order, open{root};
  while (!open.empty()) {  // depth first, so that a limb's links stay together
    order.push_back(open.back());
    open.pop_back();
    const auto children = tree.childrenOf.find(order.back());
    if (children != tree.childrenOf.end())
      open.insert(open.end(), children->second.rbegin(), children->second.rend());
  }
  if (order.size() < tree.links.size()) {
    const std::unordered_set<std::string> reached(order.begin(), order.end());
    for (const std::string& link : tree.links)
      if (!reached.count(link)) throw Error(path + ": links form a loop, " + loopAbove(tree, link));
  }
  return order;
}

CapsuleNames capsulesToCylinders(XMLElement& robot) {
  CapsuleNames capsules;
  for (XMLElement* link = robot.FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
    for (const char* use : {"collision", "visual"}) {
      int index = 0;
      for (XMLElement* e = link->FirstChildElement(use); e; e = e->NextSiblingElement(use), ++index) {
        XMLElement* geometry = e->FirstChildElement("geometry");
        XMLElement* capsule = geometry ? geometry->FirstChildElement("capsule") : nullptr;
        if (!capsule) continue;
        capsule->SetName("cylinder");
        if (std::string(use) == "collision") capsules.emplace(link->Attribute("name"), index);
      }
    }
  }
  return capsules;
}

}  // namespace

CheckedUrdf checkUrdf(const std::string& text, const std::string& path) {
  tinyxml2::XMLDocument document;
  parseXml(text, path, document);
  XMLElement& robot = *document.RootElement();
  if (std::string(robot.Name()) != "robot")
    throw Error(path + ": its root element is <" + robot.Name() + ">, expected <robot>");
  const Tree tree = readTree(robot, path);
  CheckedUrdf checked;
  checked.links = inTreeOrder(tree, path);
  checked.joints = tree.joints;
  checked.capsules = capsulesToCylinders(robot);
  tinyxml2::XMLPrinter printer(nullptr, true);
  robot.Accept(&printer);
  checked.xml = printer.CStr();
  return checked;
}

}  // namespace fcl_stpbv
