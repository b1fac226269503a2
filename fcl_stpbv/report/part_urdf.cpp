// Each element is found by its place (ShapeModel::place) and copied once for each part.
#include "fcl_stpbv/report/part_urdf.h"

#include <filesystem>
#include <optional>

#include "fcl_stpbv/mesh/uri_text.h"
#include "fcl_stpbv/mesh/xml_text.h"
#include "fcl_stpbv/robot/package_path.h"
#include "fcl_stpbv/robot/urdf_element.h"

namespace fcl_stpbv::report {
namespace {

using namespace detail;
using tinyxml2::XMLElement;
namespace fs = std::filesystem;

XMLElement* meshOf(XMLElement& shape) {
  XMLElement* geometry = shape.FirstChildElement("geometry");
  return geometry ? geometry->FirstChildElement("mesh") : nullptr;
}

class Writer {
 public:
  explicit Writer(const PartUrdf& parts) : parts_(parts), names_(parts.robot->path) {
    loadXml(parts.robot->path, document_);
  }

  std::string write() {
    redirectTextures(*document_.RootElement());
    for (XMLElement* link = document_.RootElement()->FirstChildElement("link"); link;
         link = link->NextSiblingElement("link")) {
      for (const char* use : {"collision", "visual"})
        for (XMLElement* e = link->FirstChildElement(use); e; e = e->NextSiblingElement(use)) {
          redirect(meshOf(*e));
          redirectTextures(*e);
        }
      replace(*link);
    }
    return printed(document_);
  }

 private:
  // Changes a name relative to the old URDF to one relative to the new URDF.
  void redirect(XMLElement* file) const {
    const char* attribute = file ? file->Attribute("filename") : nullptr;
    if (!attribute) return;
    const std::optional<std::string> path = filePathIn(attribute);
    const std::string name = path.value_or(attribute);
    if (name.find("://") != std::string::npos || fs::path(name).is_absolute()) return;
    const fs::path old = fs::path(names_.folderOf(attribute)) / name;
    // The file:// stays, because after it a %20 stands for a space.
    const std::string moved =
        (path ? "file://" : "") + fs::relative(old, fs::absolute(parts_.folder)).string();
    file->SetAttribute("filename", moved.c_str());
  }

  void redirectTextures(XMLElement& parent) const {
    for (XMLElement* m = parent.FirstChildElement("material"); m; m = m->NextSiblingElement("material"))
      redirect(m->FirstChildElement("texture"));
  }

  void replace(XMLElement& link) {
    const char* use = parts_.visual ? "visual" : "collision";
    std::vector<XMLElement*> shapes;
    for (XMLElement* e = link.FirstChildElement(use); e; e = e->NextSiblingElement(use)) shapes.push_back(e);
    if (parts_.visual)
      while (XMLElement* old = link.FirstChildElement("collision")) link.DeleteChild(old);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const auto found = parts_.meshes.find(
          shapePlace(*shapes[i], parts_.robot->path, link.Attribute("name"), use, static_cast<int>(i) + 1));
      if (found != parts_.meshes.end())
        insertParts(link, *shapes[i], found->second);
      else if (parts_.visual)
        link.InsertAfterChild(shapes[i], collisionLike(*shapes[i]));
      if (found != parts_.meshes.end() && !parts_.visual) link.DeleteChild(shapes[i]);
    }
  }

  XMLElement* collisionLike(const XMLElement& shape) {
    XMLElement* copy = shape.DeepClone(&document_)->ToElement();
    copy->SetName("collision");
    if (XMLElement* material = copy->FirstChildElement("material")) copy->DeleteChild(material);
    return copy;
  }

  void insertParts(XMLElement& link, XMLElement& shape, const std::vector<std::string>& files) {
    XMLElement* after = &shape;
    for (std::size_t k = 0; k < files.size(); ++k) {
      XMLElement* copy = collisionLike(shape);
      if (const char* name = copy->Attribute("name"); name && files.size() > 1)
        copy->SetAttribute("name", (name + ("_" + std::to_string(k))).c_str());
      XMLElement* mesh = meshOf(*copy);
      mesh->SetAttribute("filename", files[k].c_str());
      mesh->DeleteAttribute("scale");
      link.InsertAfterChild(after, copy);
      after = copy;
    }
  }

  const PartUrdf& parts_;
  PackagePath names_;
  tinyxml2::XMLDocument document_;
};

}  // namespace

std::string urdfWithParts(const PartUrdf& parts) { return Writer(parts).write(); }

}  // namespace fcl_stpbv::report
