// Compares the elements and attributes of a URDF with the known ones, so that a misspelt name is an error.
#include "fcl_stpbv/robot/urdf_words.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string_view>
#include <vector>

#include "fcl_stpbv/mesh/xml_text.h"
#include "fcl_stpbv/robot/near_name.h"
#include "fcl_stpbv/words.h"

namespace fcl_stpbv::detail {
namespace {

using tinyxml2::XMLElement;

/// An element that counts, its attributes that move or shape a body, and others that several tools write,
/// which cannot stand for one of the former.
struct Known {
  std::string_view element;
  Words attributes, unused = {};
};

/// The elements that may be in an element.
class Elements {
 public:
  template <std::size_t n>
  constexpr Elements(const Known (&known)[n]) : begin_(known), end_(known + n) {}
  constexpr const Known* begin() const { return begin_; }
  constexpr const Known* end() const { return end_; }

 private:
  const Known *begin_, *end_;
};

constexpr Known kInJoint[] = {{"origin", {"xyz", "rpy"}},
                              {"parent", {"link"}},
                              {"child", {"link"}},
                              {"axis", {"xyz"}},
                              {"limit",
                               {"lower", "upper"},
                               {"effort", "velocity", "acceleration", "deceleration", "jerk", "k_velocity",
                                "k_position", "damping", "friction"}},
                              {"mimic", {"joint", "multiplier", "offset"}}};
constexpr Known kInInertial[] = {
    {"origin", {"xyz", "rpy"}}, {"mass", {"value"}}, {"inertia", {}}};  // inertia's content is not used
constexpr Known kInShape[] = {{"origin", {"xyz", "rpy"}}, {"geometry", {"name"}}};
constexpr Known kInGeometry[] = {{"box", {"size"}},
                                 {"sphere", {"radius"}},
                                 {"cylinder", {"radius", "length"}},
                                 {"capsule", {"radius", "length"}},
                                 {"mesh", {"filename", "scale"}}};

// Self filters have shapes of their own, which remove a robot from its sensors' point clouds. Drake's and
// Gazebo's self-collision checks refer to a link's shapes by name.
bool ofSelfFilter(std::string_view name) {
  return name == "self_filter" || name == "self_collision_checking";
}

bool ofOtherTools(std::string_view name) { return name.find(':') != std::string_view::npos; }

std::string listed(const Words& words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text.empty() ? "none" : text;
}

// Other tools add attributes of their own. An unknown attribute is accepted only if none of the attributes
// that move or shape a body is missing, because otherwise it could be a misspelt one.
void checkAttributes(const XMLElement& element, const Known& known) {
  const bool complete =
      std::all_of(known.attributes.begin(), known.attributes.end(),
                  [&](std::string_view name) { return element.Attribute(std::string(name).c_str()); });
  if (complete) return;
  for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a; a = a->Next()) {
    if (!holds(known.attributes, a->Name()) && !holds(known.unused, a->Name()) && !ofOtherTools(a->Name()))
      throw Error("<" + std::string(known.element) + "> has an attribute '" + a->Name() +
                  "' that URDF does not know there; it knows " + listed(known.attributes) +
                  didYouMean(a->Name(), {known.attributes.begin(), known.attributes.end()}));
  }
}

// Whether an attribute is three zeros, such as the origin of an element without an offset. It has no effect
// in any place and under any name.
bool isNowhere(std::string_view attribute, std::string_view numbers) {
  return (attribute == "xyz" || attribute == "rpy") &&
         numbers.find_first_not_of("0.+- \t\r\n") == std::string_view::npos;
}

// Accepts an element with an unknown name, because other tools add their own elements, unless it has the
// content of a known element.
void checkUnknown(const XMLElement& element, const Elements& list) {
  for (const Known& known : list) {
    for (const std::string_view attribute : known.attributes) {
      const char* value = element.Attribute(std::string(attribute).c_str());
      if (value && attribute != "name" && !isNowhere(attribute, value))
        throw Error("<" + std::string(element.Name()) + "> is no element of URDF, yet has '" +
                    std::string(attribute) + "'; is it a misspelt <" + std::string(known.element) + ">?");
    }
  }
}

// How many of the children count. The attributes of one called `free` have no effect.
int checkChildren(const XMLElement& parent, const Elements& list, std::string_view free = "") {
  int count = 0;
  std::set<std::string_view> seen;
  for (const XMLElement* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string_view name = e->Name();
    if (ofOtherTools(name)) continue;
    const auto known =
        std::find_if(list.begin(), list.end(), [&](const Known& one) { return one.element == name; });
    if (known == list.end()) {
      checkUnknown(*e, list);
      continue;
    }
    if (!seen.insert(name).second) throw Error("has two <" + std::string(name) + ">; remove one");
    if (name != free) checkAttributes(*e, *known);
    ++count;
  }
  return count;
}

bool named(const tinyxml2::XMLNode* node, std::string_view name) {
  return node && node->ToElement() && node->Value() == name;
}

bool isShape(const tinyxml2::XMLNode* node) { return named(node, "collision") || named(node, "visual"); }

// Whether the element has more than a name. Pinocchio's <collision_checking> refers to a link's shapes by
// name.
bool saysMore(const XMLElement& element) {
  const tinyxml2::XMLAttribute* first = element.FirstAttribute();
  return first && (first->Next() || std::string_view(first->Name()) != "name");
}

bool isNowhere(const XMLElement& origin) {
  for (const tinyxml2::XMLAttribute* a = origin.FirstAttribute(); a; a = a->Next())
    if (!isNowhere(a->Name(), a->Value())) return false;
  return true;
}

// Whether it is a shape such as <box> with content, outside of any <geometry>, <collision> or <visual>. It
// may belong to a link's shape whose own name is misspelt.
bool isLost(const XMLElement& element) {
  const bool known = std::any_of(std::begin(kInGeometry), std::end(kInGeometry),
                                 [&](const Known& one) { return named(&element, one.element); });
  const tinyxml2::XMLNode* holder = element.Parent();
  return known && saysMore(element) && !named(holder, "geometry") && !isShape(holder) &&
         !isShape(holder->Parent());
}

// Whether all elements around an element, up to the robot, are URDF's own. Elements of other tools have their
// own names for their contents.
bool isOwn(const XMLElement& holder, const XMLElement& robot) {
  constexpr Words kOwn{"link",    "joint", "collision", "visual", "geometry", "box",   "sphere", "cylinder",
                       "capsule", "mesh",  "origin",    "axis",   "parent",   "child", "limit",  "mimic"};
  for (const tinyxml2::XMLNode* node = &holder; node != &robot; node = node->Parent())
    if (!holds(kOwn, node->Value())) return false;
  return true;
}

// For an element that moves a body or is one, and that has no effect in its place: the place where it
// belongs. Null if its place is right, if it has no content, or if it belongs to another tool.
const char* homeOf(const XMLElement& element, const XMLElement& holder, const XMLElement& robot) {
  const std::string_view name = element.Name(), around = holder.Name();
  if (around == "joint" || !isOwn(holder, robot)) return nullptr;
  if (name == "origin" && around != "collision" && around != "visual" && !isNowhere(element))
    return "a <collision>, <visual> or <inertial> of a link, or into a <joint>";
  if (around == "link" && (name == "link" || name == "joint")) return "<robot>";
  const bool ofJoint = name == "axis" || name == "limit" || name == "mimic";
  return ofJoint && element.FirstAttribute() ? "a <joint>" : nullptr;
}

// The word ("collision" or "visual") that a name in a link misspells by up to one letter in four; "" if there
// is none. Such an element would lose a body, even if its content does not show that because it is empty or
// has more misspelt words.
std::string_view misspeltShape(std::string_view name) {
  const std::string small = inSmallLetters(name);
  for (const char* word : {"collision", "visual"})
    if (name != word && lettersApart(small, word) <= std::string_view(word).size() / 4) return word;
  return "";
}

std::string placeWithin(const std::string& name, const std::string& around) {
  return "<" + name + "> within <" + around + ">, where no robot has one; ";
}

std::string ofAnotherTool(const std::string& name) {
  return " Where it is another tool's, put a prefix before its name, as in <tool:" + name + ">";
}

std::string misspeltIn(const XMLElement& element, std::string_view word) {
  const std::string name = element.Name();
  return placeWithin(name, "link") + "is it a misspelt <" + std::string(word) + ">?" + ofAnotherTool(name);
}

std::string misplaced(const XMLElement& element, const XMLElement& holder, bool known) {
  const std::string around = holder.Name(), within = placeWithin(element.Name(), around);
  if (known) return within + "a shape stands in the <geometry> of a link's <collision> or <visual>";
  return within + "is <" + around + "> misspelt?" + ofAnotherTool(around);
}

// The link that contains an element; null if there is none.
const XMLElement* linkAround(const XMLElement& element, const XMLElement& robot) {
  const tinyxml2::XMLNode* above = element.Parent();
  while (above != &robot && above->Parent() != &robot) above = above->Parent();
  return named(above, "link") ? above->ToElement() : nullptr;
}

}  // namespace

void checkShapeWords(const XMLElement& shape) {
  checkChildren(shape, kInShape);
  const XMLElement* geometry = shape.FirstChildElement("geometry");
  if (!geometry) throw Error("has no <geometry>; give it one, or remove the element");
  const int shapes = checkChildren(*geometry, kInGeometry);
  if (shapes == 0) {
    const XMLElement* other = geometry->FirstChildElement();
    throw Error("its <geometry> holds " + (other ? "<" + std::string(other->Name()) + ">" : "nothing") +
                "; give it a <box>, <sphere>, <cylinder>, <capsule> or <mesh>");
  }
  if (shapes > 1)
    throw Error("its <geometry> holds several shapes; give each a <" + std::string(shape.Name()) +
                "> of its own");
}

void checkJointWords(const XMLElement& joint) {
  const Words types{"fixed", "revolute", "continuous", "prismatic", "planar", "floating"};
  const char* type = joint.Attribute("type");
  if (!type) throw Error("has no type; URDF knows " + listed(types));
  if (!holds(types, type)) throw Error("is of type '" + std::string(type) + "'; URDF knows " + listed(types));
  const bool hasRange = holds({"revolute", "prismatic"}, type);
  checkChildren(joint, kInJoint, hasRange ? "" : "limit");
}

const XMLElement* inertialOf(const XMLElement& link) {
  if (const XMLElement* inertial = link.FirstChildElement("inertial")) return inertial;
  for (const XMLElement* e = link.FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string_view name = e->Name();
    if (name == "gazebo" || ofOtherTools(name)) continue;
    if (e->FirstChildElement("mass") || e->FirstChildElement("inertia")) return e;
  }
  return nullptr;
}

void checkInertialWords(const XMLElement& inertial) {
  if (!named(&inertial, "inertial"))
    throw Error("<" + std::string(inertial.Name()) +
                "> is no element of URDF, yet holds a mass; is it a misspelt <inertial>?");
  checkChildren(inertial, kInInertial);
}

int checkPlaces(const XMLElement& robot, const std::string& path, LoadFaults& faults,
                std::set<const XMLElement*>& incomplete) {
  int collisions = 0;
  std::vector<const XMLElement*> open{&robot};
  while (!open.empty()) {
    const XMLElement& at = *open.back();
    open.pop_back();
    const bool link = named(&at, "link") && at.Parent() == &robot;
    const bool shape = isShape(&at) && named(at.Parent(), "link") && at.Parent()->Parent() == &robot;
    for (const XMLElement* e = at.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view name = e->Name();
      if (name == "gazebo" || ofSelfFilter(name) || ofOtherTools(name)) continue;
      if (const std::string_view word = link ? misspeltShape(name) : ""; !word.empty()) {
        faults.shapes.push_back(xmlPlace(*e, path) + misspeltIn(*e, word));
        incomplete.insert(&at);
        continue;
      }
      if ((name == "collision" && !link) || (name == "geometry" && !shape) || isLost(*e)) {
        const XMLElement* around =
            name == "collision" ? nullptr : linkAround(*e, robot);  // the link that lacks a shape
        if (around) incomplete.insert(around);
        (around ? faults.shapes : faults.errors)
            .push_back(xmlPlace(*e, path) + misplaced(*e, at, link || &at == &robot));
      }
      if (const char* home = homeOf(*e, at, robot))
        faults.errors.push_back(xmlPlace(*e, path) + placeWithin(std::string(name), at.Name()) +
                                "it belongs into " + home);
      collisions += name == "collision" && link;
      open.push_back(e);
    }
  }
  return collisions;
}

}  // namespace fcl_stpbv::detail
