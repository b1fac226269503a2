// Checks a COLLADA document for errors that assimp ignores: a second unit, shapes and nodes that do not
// exist, and transforms that assimp does not know.
#include <tinyxml2.h>

#include <algorithm>
#include <map>
#include <set>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/collada_arrays.h"
#include "fcl_stpbv/mesh/collada_transforms.h"
#include "fcl_stpbv/mesh/collada_values.h"
#include "fcl_stpbv/mesh/mesh_checks.h"
#include "fcl_stpbv/mesh/mesh_lines.h"
#include "fcl_stpbv/mesh/xml_text.h"
#include "fcl_stpbv/words.h"

namespace fcl_stpbv::detail {
namespace {

using tinyxml2::XMLElement;

double metresOf(const XMLElement& unit, const std::string& name) {
  if (std::string_view(unit.Name()) != "unit")
    throw Error(xmlPlace(unit, name) + "<" + unit.Name() +
                "> is no element of COLLADA; is it a misspelt <unit>?");
  checkColladaAttributes(unit, {"meter", "name"}, name);
  const char* metres = unit.Attribute("meter");
  double value = 1;
  if (metres != nullptr && !(readMeshNumber(metres, value) && value > 0))
    throw Error(xmlPlace(unit, name) + "<unit> has meter=\"" + metres +
                "\", expected a length in metres above 0, with a point for decimals");
  return value;
}

// Finds a second unit: assimp applies the document's own unit to the whole document.
class OneUnit : public tinyxml2::XMLVisitor {
 public:
  OneUnit(const XMLElement& root, const std::string& name) : root_(root), name_(name) {}

  bool VisitEnter(const XMLElement& element, const tinyxml2::XMLAttribute* /*first*/) override {
    const XMLElement* asset = element.Parent()->ToElement();
    const bool named = inSmallLetters(element.Name()) == "unit";
    if (!named || asset == nullptr || std::string_view(asset->Name()) != "asset") return true;
    const double metres = metresOf(element, name_);
    const bool own = asset->Parent() == &root_;
    if (own && !isGiven_)
      unit_ = metres;
    else if (metres != unit_)
      throw Error(xmlPlace(element, name_) +
                  "<unit> differs from that of the document, which is applied to all "
                  "of it; export with one unit");
    isGiven_ = true;
    return true;
  }

  double metres() const { return unit_; }

 private:
  const XMLElement& root_;
  const std::string& name_;
  double unit_ = 1;
  bool isGiven_ = false;
};

// assimp ignores elements that it does not know, and so may lose a shape or a reference to one.
void checkKnown(const XMLElement& element, const Words& inside, const std::string& name) {
  for (const XMLElement* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    if (!holds(inside, e->Name()))
      refuseCollada(*e, "is no element of COLLADA within <" + std::string(element.Name()) + ">", name);
}

constexpr Words kInRoot{"asset",
                        "library_animations",
                        "library_animation_clips",
                        "library_articulated_systems",
                        "library_cameras",
                        "library_controllers",
                        "library_effects",
                        "library_force_fields",
                        "library_formulas",
                        "library_geometries",
                        "library_images",
                        "library_joints",
                        "library_kinematics_models",
                        "library_kinematics_scenes",
                        "library_lights",
                        "library_materials",
                        "library_nodes",
                        "library_physics_materials",
                        "library_physics_models",
                        "library_physics_scenes",
                        "library_visual_scenes",
                        "scene",
                        "extra"};
constexpr Words kInAsset{"contributor", "coverage", "created", "keywords", "modified", "revision",
                         "subject",     "title",    "unit",    "up_axis",  "extra"};
constexpr Words kInNode{"asset",
                        "lookat",
                        "matrix",
                        "rotate",
                        "scale",
                        "skew",
                        "translate",
                        "node",
                        "instance_node",
                        "extra",
                        "instance_camera",
                        "instance_light",
                        "instance_geometry",
                        "instance_controller",
                        "evaluate_scene"};
constexpr Words kInGeometry{"asset", "mesh", "convex_mesh", "spline", "brep", "extra"};
constexpr Words kInMesh{"source",   "vertices",  "lines",   "linestrips", "polygons",
                        "polylist", "triangles", "trifans", "tristrips",  "extra"};

// Finds the shapes that the nodes of a document place, and bounds the transforms that lead to them.
class ColladaNodes {
 public:
  ColladaNodes(const XMLElement& root, const std::string& name) : root_(root), name_(name) {}

  /// @returns how far the transforms within a node above a shape go, in the document's unit.
  double check() {
    checkKnown(root_, kInRoot, name_);
    for (const XMLElement* e = root_.FirstChildElement("asset"); e; e = e->NextSiblingElement("asset"))
      checkKnown(*e, kInAsset, name_);
    forEach("library_geometries", "geometry", [this](const XMLElement& e) { addGeometry(e); });
    forEach("library_nodes", "node", [this](const XMLElement& e) { addNode(e); });
    forEach("library_visual_scenes", "visual_scene", [this](const XMLElement& e) { addScene(e); });
    forEach("library_visual_scenes", "visual_scene", [this](const XMLElement& e) { checkNode(e, 1); });
    // Repeat if nodes of the library contain other nodes of it, which may have been checked before.
    constexpr int kRounds = 16;
    std::map<std::string, double> before;
    for (int round = 0; round < kRounds && (round == 0 || before != instanced_); ++round) {
      before = instanced_;
      forEach("library_nodes", "node", [this](const XMLElement& e) {
        const auto around = instanced_.find(attribute(e, "id"));
        checkNode(e, around == instanced_.end() ? 0 : around->second);
      });
    }
    return far_;
  }

 private:
  template <class Visit>
  void forEach(const char* library, const char* item, Visit visit) const {
    for (const XMLElement* l = root_.FirstChildElement(library); l; l = l->NextSiblingElement(library))
      for (const XMLElement* e = l->FirstChildElement(item); e; e = e->NextSiblingElement(item)) visit(*e);
  }

  static std::string attribute(const XMLElement& element, const char* attribute) {
    const char* value = element.Attribute(attribute);
    return value == nullptr ? "" : value;
  }

  void addGeometry(const XMLElement& geometry) {
    const std::string id = attribute(geometry, "id");
    if (!id.empty() && !shapes_.emplace(id, &geometry).second)
      refuseCollada(geometry, "has an id that another one has", name_);
  }

  void addNode(const XMLElement& node) {
    const std::string id = attribute(node, "id");
    if (!nodes_.insert(id).second && !id.empty())
      refuseCollada(node, "has an id that another one has", name_);
  }

  // assimp also finds the nodes below the shown scene by their names.
  void addScene(const XMLElement& scene) {
    const XMLElement* shown = root_.FirstChildElement("scene");
    if (shown != nullptr) shown = shown->FirstChildElement("instance_visual_scene");
    nodes_.insert(attribute(scene, "id"));
    if (shown != nullptr && attribute(*shown, "url") == "#" + attribute(scene, "id")) addNodes(scene);
  }

  void addNodes(const XMLElement& above) {
    for (const XMLElement* e = above.FirstChildElement("node"); e != nullptr;
         e = e->NextSiblingElement("node")) {
      nodes_.insert(attribute(*e, "id"));
      nodes_.insert(attribute(*e, "name"));
      addNodes(*e);
    }
  }

  // Whether the node or one below it contains a shape. `above`: the stretch of the nodes around it.
  bool checkNode(const XMLElement& node, double above) {
    checkKnown(node, kInNode, name_);
    ColladaReach reach;
    for (const XMLElement* e = node.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
      addColladaTransform(*e, name_, reach);
    bool holdsShape = false;
    for (const XMLElement* e = node.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view kind = e->Name();
      holdsShape |= kind == "instance_node" || kind == "instance_geometry";
      if (kind == "node") {
        holdsShape |= checkNode(*e, above * reach.stretch);
      } else if (kind == "instance_node") {
        const std::string target = colladaTarget(*e, "url", name_);
        instanced_[target] = std::max(instanced_[target], above * reach.stretch);
        if (nodes_.count(target) == 0)
          refuseCollada(*e,
                        "names the node '#" + target +
                            "', which is neither in the scene nor at the top of a <library_nodes>",
                        name_);
      } else if (kind == "instance_geometry") {
        checkShape(*e);
      } else if (kind == "instance_controller") {
        throw Error(xmlPlace(*e, name_) +
                    "<instance_controller> has a skin or morph targets, which move vertices and are not "
                    "read; export the mesh with them applied");
      }
    }
    if (holdsShape) far_ = std::max(far_, above * reach.far);
    return holdsShape;
  }

  void checkShape(const XMLElement& instance) const {
    const std::string target = colladaTarget(instance, "url", name_);
    const auto shape = shapes_.find(target);
    if (shape == shapes_.end())
      refuseCollada(instance, "names the geometry '#" + target + "', which does not exist", name_);
    checkKnown(*shape->second, kInGeometry, name_);
    for (const char* kind : {"convex_mesh", "brep", "spline"}) {
      if (const XMLElement* unread = shape->second->FirstChildElement(kind))
        throw Error(xmlPlace(*unread, name_) + "<" + kind + "> is not read; export the geometry as a <mesh>");
    }
    const XMLElement* mesh = shape->second->FirstChildElement("mesh");
    if (mesh == nullptr) refuseCollada(*shape->second, "is shown by a node, but holds no <mesh>", name_);
    checkKnown(*mesh, kInMesh, name_);
    if (const XMLElement* second = mesh->NextSiblingElement("mesh"))
      refuseCollada(*second, "is the second one of its <geometry>, of which one is read", name_);
  }

  const XMLElement& root_;
  const std::string& name_;
  std::map<std::string, const XMLElement*> shapes_;  // geometries
  std::set<std::string> nodes_;                      // ids that an <instance_node> may name
  std::map<std::string, double> instanced_;          // by node: the largest stretch around an instance
  double far_ = 0;                                   // the result of check()
};

}  // namespace

double checkCollada(std::string_view text, const std::string& name) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    const bool deep = document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED;
    throw Error(name + ":" + std::to_string(document.ErrorLineNum()) + ": " +
                (deep ? "elements nested more than " + std::to_string(TINYXML2_MAX_ELEMENT_DEPTH) +
                            " deep are not read"
                      : std::string("not XML (") + tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()) +
                            "); give a whole file of COLLADA"));
  }
  const XMLElement* root = document.RootElement();
  if (root == nullptr) return 0;  // assimp reports this
  if (const XMLElement* second = root->NextSiblingElement())
    throw Error(xmlPlace(*second, name) + "not XML (a second root, <" + second->Name() +
                ">); give a whole file of COLLADA");
  OneUnit units(*root, name);
  root->Accept(&units);
  checkColladaGeometries(*root, name);
  return units.metres() * ColladaNodes(*root, name).check();
}

}  // namespace fcl_stpbv::detail
