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
#include "fcl_stpbv/io/text_scanner.h"
#include "fcl_stpbv/robot/mesh_file.h"
#include "fcl_stpbv/volume/reduce.h"

namespace fcl_stpbv {
namespace {

using Points = std::vector<Eigen::Vector3d>;

std::string withScale(const std::string& bytes, const Eigen::Vector3d& scale) {
  std::string content;
  appendVector(content, scale);
  return content + '\n' + bytes;
}

// What the cache knows a mesh by: the file's bytes, or for glTF, which keeps its vertices in other files, the
// points.
std::string contentOf(const std::string& path, const Eigen::Vector3d& scale) {
  const bool several = path.size() > 5 && path.compare(path.size() - 5, 5, ".gltf") == 0;
  if (!several) return withScale(readText(path), scale);
  std::string points;
  for (const Eigen::Vector3d& p : loadPoints(path)) {
    appendVector(points, p);
    points += '\n';
  }
  return withScale(points, scale);
}

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
        addPrimitive(shape, body);
    } catch (const Error& error) {
      throw Error(robot_.path + ": link '" + name + "': " + error.what());
    }
    body.centre = body.pose * body.centre;
    geometry_.bodies.push_back(std::move(body));
  }

  void addMesh(const std::string& link, const ShapeModel& shape, Body& body) {
    body.file = paths_.resolve(shape.mesh);
    try {
      if (options_.flat || options_.flatLinks.count(link) > 0)
        addHull(shape, body);
      else
        addVolume(link, shape, body);
    } catch (const Error& error) {
      const std::string message = error.what();
      const bool named = message.find(body.file) != std::string::npos;
      throw Error(named ? message : body.file + ": " + message);
    }
  }

  static void addHull(const ShapeModel& shape, Body& body) {
    const auto hull = hullGeometry(loadPoints(body.file, shape.scale));
    body.centre = hull->aabb_center;
    body.radius = 0;
    for (const Eigen::Vector3d& v : hull->getVertices())
      body.radius = std::max(body.radius, (v - body.centre).norm());
    body.geometry = hull;
  }

  void addVolume(const std::string& link, const ShapeModel& shape, Body& body) {
    const auto own = options_.links.find(link);
    StpBvOptions radii = own == options_.links.end() ? options_.radii : own->second;
    const auto budgetOf = options_.budgets.find(link);
    const double budget = budgetOf == options_.budgets.end() ? options_.overCoverBudget : budgetOf->second;
    const std::string content = contentOf(body.file, shape.scale);
    const auto build = [&] {
      body.volume = cache_.volume(content, radii,
                                  [&] { return StpBv::build(loadPoints(body.file, shape.scale), radii); });
    };
    build();
    body.cover = overCover(*body.volume);
    if (budget > 0) reduceTo(budget, loadPoints(body.file, shape.scale), content, radii, build, body);
    body.geometry = std::make_shared<StpBvGeometry>(body.volume);
    body.centre = body.volume->centre();
    body.radius = body.volume->enclosingRadius();
  }

  template <class Build>
  void reduceTo(double budget, const Points& points, const std::string& content, StpBvOptions& radii,
                const Build& build, Body& body) {
    constexpr double kLargest = 1e5;  // beyond it a big sphere is flat to rounding
    body.cover = overCover(*body.volume, points);
    for (; body.cover.max > budget && radii.R < kLargest; body.cover = overCover(*body.volume, points)) {
      radii.R *= 2;  // the over-cover falls towards r
      build();
    }
    if (body.cover.max > budget)
      throw Error("no R keeps its over-cover within " + toDecimal(budget) +
                  " m with r = " + toDecimal(radii.r) + " m; give a larger budget or a smaller r");
    const StpBv::Ptr few = cache_.volume(content + "\nreduced to " + toDecimal(budget), radii,
                                         [&] { return reduce(points, radii, budget); });
    if (few->vertexCount() >= body.volume->vertexCount()) return;
    body.full = body.volume;
    body.volume = few;
    body.cover = overCover(*few, points);
  }

  static void addPrimitive(const ShapeModel& shape, Body& body) {
    const Eigen::Vector3d& size = shape.size;
    body.centre.setZero();
    if (shape.kind == ShapeModel::Kind::sphere) {
      body.geometry = std::make_shared<fcl::Sphered>(size.x());
      body.radius = size.x();
    } else if (shape.kind == ShapeModel::Kind::capsule) {
      body.geometry = std::make_shared<fcl::Capsuled>(size.x(), size.y());
      body.radius = size.x() + size.y() / 2;
    } else if (shape.kind == ShapeModel::Kind::box) {
      body.geometry = std::make_shared<fcl::Boxd>(size);
      body.radius = size.norm() / 2;
    } else {
      body.geometry = std::make_shared<fcl::Cylinderd>(size.x(), size.y());
      body.radius = std::hypot(size.x(), size.y() / 2);
    }
    body.geometry->computeLocalAABB();
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
