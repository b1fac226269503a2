// The tree of links and joints by name: one root, one parent each, no loop; returned in tree order.
#include "fcl_stpbv/robot/urdf_check.h"

#include "fcl_stpbv/mesh/xml_text.h"
#include "fcl_stpbv/robot/near_name.h"

namespace fcl_stpbv::detail {
namespace {

using tinyxml2::XMLElement;

// Time and memory grow with the square of the number of bodies; the largest
// published robots have some hundreds.
constexpr std::size_t kMostLinks = 20000;

struct Tree {
  std::vector<std::string> links;  // in the order of the file
  std::unordered_map<std::string, const XMLElement*> known;
  std::unordered_set<std::string> jointNames;
  std::vector<const XMLElement*> joints;
  std::unordered_map<std::string, std::string> jointOf, parentOf;        // by the name of a child link
  std::unordered_map<std::string, std::vector<std::string>> childrenOf;  // in the order of the file
  FirstProposals proposals;
};

void addLink(Tree& tree, const XMLElement& element, const std::string& path) {
  const std::string name = requiredAttribute(element, "name", path);
  if (!tree.known.emplace(name, &element).second)
    throw Error(xmlPlace(element, path) + "two links are named '" + name + "'; rename one");
  tree.links.push_back(name);
}

std::string linkOf(const XMLElement& joint, const char* end, const std::string& where) {
  const XMLElement* element = joint.FirstChildElement(end);
  const char* link = element ? element->Attribute("link") : nullptr;
  if (!link || !*link) throw Error(where + ": names no " + end + " link; add <" + end + " link=\"...\"/>");
  return link;
}

void addJoint(Tree& tree, const XMLElement& element, const std::string& path) {
  const std::string joint = requiredAttribute(element, "name", path);
  const std::string where = xmlPlace(element, path) + "joint '" + joint + "'";
  if (!tree.jointNames.insert(joint).second)
    throw Error(xmlPlace(element, path) + "two joints are named '" + joint + "'; rename one");
  const std::string parent = linkOf(element, "parent", where), child = linkOf(element, "child", where);
  for (const std::string& link : {parent, child}) {
    if (!tree.known.count(link))
      throw Error(where + ": there is no link '" + link + "'; add it or correct the name" +
                  tree.proposals.of(link, [&] { return tree.links; }));
  }
  const auto [other, isNew] = tree.jointOf.emplace(child, joint);
  if (!isNew) {
    throw Error(xmlPlace(element, path) + "link '" + child + "' is the child of two joints, '" +
                other->second + "' and '" + joint + "'; a URDF is a tree, remove one");
  }
  tree.joints.push_back(&element);
  tree.parentOf[child] = parent;
  tree.childrenOf[parent].push_back(child);
}

Tree readNames(const XMLElement& robot, const std::string& path, LoadFaults& faults) {
  Tree tree;
  for (const XMLElement* e = robot.FirstChildElement("link"); e; e = e->NextSiblingElement("link"))
    LoadFaults::gather(faults.errors, [&] { addLink(tree, *e, path); });
  if (tree.links.empty())
    faults.errors.push_back(path + ": has no links; give a URDF with at least one <link>");
  if (tree.links.size() > kMostLinks)
    faults.errors.push_back(path + ": has " + std::to_string(tree.links.size()) + " links, more than the " +
                            std::to_string(kMostLinks) + " that are read");
  if (tree.links.empty() || tree.links.size() > kMostLinks) faults.refuse();
  for (const XMLElement* e = robot.FirstChildElement("joint"); e; e = e->NextSiblingElement("joint"))
    LoadFaults::gather(faults.errors, [&] { addJoint(tree, *e, path); });
  return tree;
}

// The loop that one gets into upwards from `link`, which is not below the root.
std::string loopAbove(const Tree& tree, std::string link) {
  // After so many steps upwards, `link` is in the loop.
  for (std::size_t i = 0; i < tree.links.size(); ++i) link = tree.parentOf.at(link);
  std::string text = "'" + link + "'";
  constexpr int kShown = 20;
  int shown = 0;
  for (std::string at = tree.parentOf.at(link);; at = tree.parentOf.at(at)) {
    text += ++shown > kShown ? "" : " <- '" + at + "'";
    if (at == link) return text + (shown > kShown ? " <- ..." : "");
  }
}

// "; is ... a misspelt <joint>?" with the first element that leads to the link but is not a joint; "" if
// there is none.
std::string likeJoint(const Tree& tree, const std::string& link) {
  const tinyxml2::XMLNode* robot = tree.known.at(link)->Parent();
  for (const XMLElement* e = robot->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const XMLElement* child = e->FirstChildElement("child");
    if (child && child->Attribute("link", link.c_str()))
      return "; is <" + std::string(e->Name()) + "> in line " + std::to_string(e->GetLineNum()) +
             " a misspelt <joint>?";
  }
  return "";
}

std::vector<std::string> inTreeOrder(const Tree& tree, const std::string& path) {
  std::string root;
  for (const std::string& link : tree.links) {
    if (tree.parentOf.count(link)) continue;
    if (!root.empty())
      throw Error(path + ": both '" + root + "' and '" + link + "' have no parent; join them by a joint" +
                  likeJoint(tree, link));
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

}  // namespace

UrdfTree readTree(const XMLElement& robot, const std::string& path, LoadFaults& faults) {
  const std::size_t before = faults.errors.size();
  const Tree tree = readNames(robot, path, faults);
  std::vector<std::string> order = tree.links;
  if (faults.errors.size() == before)
    LoadFaults::gather(faults.errors, [&] { order = inTreeOrder(tree, path); });
  UrdfTree checked;
  checked.joints = tree.joints;
  checked.jointNames = tree.jointNames;
  for (const std::string& link : order) {
    checked.index[link] = static_cast<int>(checked.links.size());
    checked.links.push_back(tree.known.at(link));
  }
  return checked;
}

}  // namespace fcl_stpbv::detail
