// Reads a link's shapes element by element. What urdfdom would pass over, such as a second geometry or a size
// that is no number, is a fault with a message.
#include "fcl_stpbv/robot/urdf_shape.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/error_place.h"
#include "fcl_stpbv/robot/urdf_element.h"
#include "fcl_stpbv/robot/urdf_words.h"

namespace fcl_stpbv::detail {
namespace {

using tinyxml2::XMLElement;

ShapeModel toShape(const urdf::Geometry& geometry, const urdf::Pose& origin, bool capsule) {
  ShapeModel shape;
  shape.pose = toEigen(origin);
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
    if (shape.mesh.empty()) throw Error("its mesh has an empty file name");
    if (!shape.scale.allFinite() || (shape.scale.array() == 0).any())
      throw Error("the scale of " + shape.mesh + " is 0 or not finite; give three other numbers");
    return shape;
  }
  const bool box = shape.kind == ShapeModel::Kind::box;  // may be a plate or a bar
  if (!isUsable(shape.size) || (shape.size.array() < 0).any() ||
      !((box ? shape.size.maxCoeff() : shape.size.x()) > 0))
    throw Error("a shape's sizes must be finite and larger than 0, and at most 1e6 m");
  return shape;
}

ShapeModel readShape(const XMLElement& element, const std::string& place) {
  return within(place, [&] {
    checkShapeWords(element);
    const urdf::CollisionSharedPtr read = readShapeElement(element);
    const bool capsule = element.FirstChildElement("geometry")->FirstChildElement("capsule") != nullptr;
    ShapeModel shape = toShape(*read->geometry, read->origin, capsule);
    shape.place = place;
    return shape;
  });
}

// Numbers may differ by this, because writers of URDF keep about six digits (m).
constexpr double kAlike = 1e-6;

int sphereAt(const std::vector<ShapeModel>& shapes, const Eigen::Vector3d& centre, double radius) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].kind == ShapeModel::Kind::sphere && std::abs(shapes[i].size.x() - radius) < kAlike &&
        (shapes[i].pose.translation() - centre).norm() < kAlike)
      return static_cast<int>(i);
  }
  return -1;
}

// URDF has no capsule of its own: each cylinder that has a sphere of its radius centred on both ends, to a
// micrometre, becomes one capsule that contains all three. The spheres are removed.
void joinCapsules(std::vector<ShapeModel>& shapes) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].kind != ShapeModel::Kind::cylinder) continue;
    const Eigen::Vector3d half(0, 0, shapes[i].size.y() / 2);
    const Eigen::Vector3d topAt = shapes[i].pose * half, bottomAt = shapes[i].pose * -half;
    const int top = sphereAt(shapes, topAt, shapes[i].size.x());
    const int bottom = sphereAt(shapes, bottomAt, shapes[i].size.x());
    if (top < 0 || bottom < 0 || top == bottom) continue;
    shapes[i].kind = ShapeModel::Kind::capsule;
    // The capsule is wide enough for spheres that are off by their last digit.
    const auto take = [&](const ShapeModel& sphere, const Eigen::Vector3d& centre) {
      const double off = (sphere.pose.translation() - centre).norm();
      shapes[i].size.x() = std::max(shapes[i].size.x(), sphere.size.x() + off);
      shapes[i].elements += sphere.elements;
    };
    take(shapes[static_cast<std::size_t>(top)], topAt);
    take(shapes[static_cast<std::size_t>(bottom)], bottomAt);
    shapes.erase(shapes.begin() + std::max(top, bottom));
    shapes.erase(shapes.begin() + std::min(top, bottom));
    i = static_cast<std::size_t>(-1);  // the indices have changed: search again from the start
  }
}

}  // namespace

std::vector<ShapeModel> readShapes(const XMLElement& link, const char* use, const std::string& path,
                                   std::vector<std::string>& faults) {
  std::vector<ShapeModel> shapes;
  int number = 0;
  for (const XMLElement* e = link.FirstChildElement(use); e; e = e->NextSiblingElement(use)) {
    const std::string place = shapePlace(*e, path, link.Attribute("name"), use, ++number);
    LoadFaults::gather(faults, [&] { shapes.push_back(readShape(*e, place)); });
  }
  joinCapsules(shapes);
  return shapes;
}

}  // namespace fcl_stpbv::detail
