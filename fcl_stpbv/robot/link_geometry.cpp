// See link_geometry.h.
#include "fcl_stpbv/robot/link_geometry.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/adapter/hull_geometry.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/link_volume.h"
#include "fcl_stpbv/robot/mesh_file.h"

namespace fcl_stpbv {
namespace {

class Loader {
 public:
  Loader(const RobotModel& robot, const GeometryOptions& options)
      : robot_(robot),
        options_(options),
        paths_(robot.path, options.packagePath),
        cache_(options.cacheFolder) {}

  RobotGeometry load() {
    checkNames();
    const bool visual = options_.visual || onlyVisual();
    const auto shapes = [&](const LinkModel& link) -> const std::vector<ShapeModel>& {
      return visual ? link.visual : link.collision;
    };
    std::size_t done = 0, all = 0;
    for (const LinkModel& link : robot_.links) all += shapes(link).size();
    if (all == 0)
      geometry_.warnings.push_back(robot_.path + ": no link has a " + (visual ? "visual" : "collision") +
                                   " shape, so there is nothing to check.");
    for (std::size_t l = 0; l < robot_.links.size(); ++l) {
      int number = 0;
      for (const ShapeModel& shape : shapes(robot_.links[l])) {
        if (options_.progress) options_.progress(done++, all, robot_.links[l].name);
        add(static_cast<int>(l), ++number, shape);
      }
    }
    geometry_.fromCache = cache_.hits();
    return std::move(geometry_);
  }

 private:
  void checkNames() const {
    const auto check = [&](const std::string& name) {
      if (robot_.link(name) < 0)
        throw Error(robot_.path + ": options were given for a link '" + name + "' it does not have");
    };
    for (const auto& entry : options_.links) check(entry.first);
    for (const auto& entry : options_.budgets) check(entry.first);
    for (const std::string& link : options_.flatLinks) check(link);
  }

  bool onlyVisual() {
    const auto count = [&](std::vector<ShapeModel> LinkModel::*shapes) {
      return std::count_if(robot_.links.begin(), robot_.links.end(),
                           [&](const LinkModel& link) { return !(link.*shapes).empty(); });
    };
    const auto collision = count(&LinkModel::collision), visual = count(&LinkModel::visual);
    if (collision > 0 || visual == 0) return false;
    geometry_.warnings.push_back(robot_.path + ": no link has a collision shape; the visual shapes of " +
                                 std::to_string(visual) + " links are used instead.");
    return true;
  }

  void add(int link, int number, const ShapeModel& shape) {
    const std::string& name = robot_.links[static_cast<std::size_t>(link)].name;
    Body body;
    body.link = link;
    body.name = number == 1 ? name : name + "#" + std::to_string(number);
    body.pose = shape.pose;
    try {
      if (shape.kind == ShapeModel::Kind::mesh)
        addMesh(name, shape, body);
      else
        addPrimitive(name, shape, body);
    } catch (const Error& error) {
      throw Error(robot_.path + ": link '" + name + "': " + error.what());
    }
    body.centre = body.pose * body.centre;
    geometry_.bodies.push_back(std::move(body));
  }

  void addMesh(const std::string& link, const ShapeModel& shape, Body& body) {
    body.file = paths_.resolve(shape.mesh);
    body.scale = shape.scale;
    try {
      if (options_.flat || options_.flatLinks.count(link) > 0)
        addHull(body);
      else
        makeVolume(options_, link, cache_, body);
    } catch (const Error& error) {
      const std::string message = error.what();
      const bool named = message.find(body.file) != std::string::npos;
      throw Error(named ? message : body.file + ": " + message);
    }
  }

  static void addHull(Body& body) {
    const auto hull = hullGeometry(loadPoints(body.file, body.scale));
    body.centre = hull->aabb_center;
    body.radius = 0;
    for (const Eigen::Vector3d& v : hull->getVertices())
      body.radius = std::max(body.radius, (v - body.centre).norm());
    body.geometry = hull;
  }

  void addPrimitive(const std::string& link, const ShapeModel& shape, Body& body) const {
    const Eigen::Vector3d& size = shape.size;
    BodySize own;
    body.centre.setZero();
    if (shape.kind == ShapeModel::Kind::sphere) {
      body.geometry = std::make_shared<fcl::Sphered>(size.x());
      own = {2 * size.x(), size.x()};
    } else if (shape.kind == ShapeModel::Kind::capsule) {
      body.geometry = std::make_shared<fcl::Capsuled>(size.x(), size.y());
      own = {2 * size.x(), size.x() + size.y() / 2};
    } else if (shape.kind == ShapeModel::Kind::box) {
      body.geometry = std::make_shared<fcl::Boxd>(size);
      own = {size.minCoeff(), size.norm() / 2};
    } else {
      body.geometry = std::make_shared<fcl::Cylinderd>(size.x(), size.y());
      own = {std::min(2 * size.x(), size.y()), std::hypot(size.x(), size.y() / 2)};
    }
    body.geometry->computeLocalAABB();
    body.radius = own.ball;
    body.radii = radiiFor(options_, link, [&] { return own; });
  }

  const RobotModel& robot_;
  const GeometryOptions& options_;
  PackagePath paths_;
  VolumeCache cache_;
  RobotGeometry geometry_;
};

}  // namespace

std::pair<int, int> RobotGeometry::of(int link) const {
  const auto range = std::equal_range(bodies.begin(), bodies.end(), link, [](const auto& a, const auto& b) {
    const auto value = [](const auto& x) {
      if constexpr (std::is_same_v<std::decay_t<decltype(x)>, Body>)
        return x.link;
      else
        return x;
    };
    return value(a) < value(b);
  });
  return {static_cast<int>(range.first - bodies.begin()), static_cast<int>(range.second - bodies.begin())};
}

RobotGeometry loadGeometry(const RobotModel& robot, const GeometryOptions& options) {
  return Loader(robot, options).load();
}

}  // namespace fcl_stpbv
