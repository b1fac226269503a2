// The bodies of a robot's links: reads all shapes, reports all faults at once, then builds a volume per mesh
// (link_volume.h); primitives become FCL's shapes.
#include "fcl_stpbv/robot/link_geometry.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <tuple>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/formatted.h"
#include "fcl_stpbv/mesh/passing_error.h"
#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/robot/geometry_steps.h"
#include "fcl_stpbv/robot/link_volume.h"
#include "fcl_stpbv/robot/near_name.h"
#include "fcl_stpbv/robot/volume_cache.h"
#include "fcl_stpbv/robot/worker_pool.h"

namespace fcl_stpbv {
namespace {

using namespace detail;

bool isFlat(const GeometryOptions& options, const std::string& link) {
  return options.flat || options.flatLinks.count(link) > 0;
}

void checkNames(const RobotModel& robot, const GeometryOptions& options, LoadFaults& faults) {
  std::set<std::string> names = options.flatLinks;
  for (const auto& entry : options.links) names.insert(entry.first);
  for (const auto& entry : options.budgets) names.insert(entry.first);
  FirstProposals proposals;
  for (const std::string& name : names) {
    if (robot.link(name) < 0)
      faults.errors.push_back(robot.path + ": options were given for a link '" + name + "' it does not have" +
                              proposals.of(name, [&] { return namesOf(robot.links); }));
  }
}

void checkNumbers(const RobotModel& robot, const GeometryOptions& options, LoadFaults& faults) {
  const auto check = [&](const std::string& link, const StpBvOptions& radii, double budget) {
    try {
      requireNumber(robot.path + ": r" + link, radii.r, 0, kLargestR);
      requireNumber(robot.path + ": R" + link, radii.R, radii.r, kLargestR);
      requireNumber(robot.path + ": over-cover" + link, budget, 0, kLargestR);
    } catch (const Error& error) {
      faults.errors.push_back(error.what());
    }
  };
  check("", options.radii, options.overCoverBudget);
  for (const auto& [name, radii] : options.links) check(" of link '" + name + "'", radii, 0);
  for (const auto& [name, budget] : options.budgets) check(" of link '" + name + "'", {}, budget);
}

class Builder {
 public:
  Builder(const RobotModel& robot, const GeometryOptions& options, LoadFaults& faults)
      : robot_(robot), options_(options), faults_(faults), cache_(options.cacheFolder) {}

  RobotGeometry build(const ShapeSources& sources) {
    geometry_.warnings = sources.warnings;
    geometry_.incomplete = sources.incomplete;
    const std::vector<ShapeSource>& shapes = sources.shapes;
    std::vector<Body> bodies(shapes.size());
    std::vector<std::string> wrong(shapes.size());
    const auto build = [&](std::size_t i) {
      wrong[i] = shapeFault(shapes[i].shape->place, [&] { bodies[i] = bodyOf(shapes[i]); });
    };
    shareOut(shapes.size(), options_.threads, build, [&](std::size_t i) {
      if (options_.progress) options_.progress(i, shapes.size(), nameOf(shapes[i]));
    });
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (wrong[i].empty()) {
        geometry_.bodies.push_back(std::move(bodies[i]));
      } else {
        faults_.shapes.push_back(std::move(wrong[i]));
        geometry_.incomplete.insert(shapes[i].link);
      }
    }
    warnOfAdvice();
    warnWithoutMesh();
    geometry_.fromCache = cache_.hits();
    return std::move(geometry_);
  }

 private:
  const std::string& nameOf(const ShapeSource& source) const {
    return robot_.links[static_cast<std::size_t>(source.link)].name;
  }

  // Options for flat bodies and limits apply only to meshes. Warns if a link has no mesh, because they would
  // silently have no effect.
  void warnWithoutMesh() {
    std::set<std::string> asked = options_.flatLinks;
    for (const auto& [name, budget] : options_.budgets) asked.insert(name);
    bool any = false;
    for (const Body& body : geometry_.bodies) {
      if (body.file.empty()) continue;
      any = true;
      asked.erase(robot_.links[static_cast<std::size_t>(body.link)].name);
    }
    for (const std::string& name : asked)
      geometry_.warnings.push_back(robot_.path + ": the link '" + name +
                                   "' has no mesh that could be flat or have an over-cover budget");
    if (!any && options_.overCoverBudget > 0)
      geometry_.warnings.push_back(robot_.path + ": there is no mesh that could have an over-cover budget");
  }

  // Warns of the limits of the advice: the number of primitives, to which it does not apply, the number of
  // meshes that cannot keep both budgets, and the mesh that is furthest from it.
  void warnOfAdvice() {
    if (!options_.advice) return;
    const auto isPrimitive = [](const Body& body) { return body.file.empty(); };
    const auto primitives = std::count_if(geometry_.bodies.begin(), geometry_.bodies.end(), isPrimitive);
    if (primitives > 0)
      geometry_.warnings.push_back(robot_.path + ": " + std::to_string(primitives) +
                                   " primitives keep the general r and R: advice is for meshes");
    int all = 0, count = 0;
    const Body* worst = nullptr;
    for (const Body& body : geometry_.bodies) {
      all += body.advice.has_value();
      if (!body.advice || body.advice->meetsBoth) continue;
      ++count;
      if (!worst || body.advice->acceleration > worst->advice->acceleration) worst = &body;
    }
    if (!worst) return;
    const RadiiAdvice& advice = *worst->advice;
    std::string warning =
        robot_.path +
        formatted(
            ": no r and R keep %d of %d meshes within a clearance of %.4g m and %.4g m/s^2; the most "
            "is ",
            count, all, options_.advice->clearance, options_.advice->acceleration) +
        worst->name + formatted(", whose shape may add %.4g m/s^2", advice.acceleration);
    if (std::isfinite(advice.leastClearance))
      warning += formatted(", or needs a clearance of %.4g m", advice.leastClearance);
    geometry_.warnings.push_back(warning);
  }

  Body bodyOf(const ShapeSource& source) {
    const std::string& link = nameOf(source);
    Body body;
    body.link = source.link;
    body.name = source.number == 1 ? link : link + "#" + std::to_string(source.number);
    body.pose = source.shape->pose;
    body.file = source.file;
    body.meshKey = source.key;
    body.scale = source.shape->scale;
    if (source.shape->kind == ShapeModel::Kind::mesh)
      addMesh(link, source, body);
    else
      addPrimitive(link, *source.shape, body);
    body.centre = body.pose * body.centre;
    return body;
  }

  void addMesh(const std::string& link, const ShapeSource& source, Body& body) {
    namingFile(body.file, [&] {
      if (isFlat(options_, link))
        makeHull(source.points(), body);
      else
        makeVolume(options_, link, source, cache_, body);
    });
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
  LoadFaults& faults_;
  VolumeCache cache_;
  RobotGeometry geometry_;
};

}  // namespace

std::string defaultCacheFolder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache && std::filesystem::path(cache).is_absolute())
    return (std::filesystem::path(cache) / "fcl_stpbv").string();
  const char* home = std::getenv("HOME");
  return home && std::filesystem::path(home).is_absolute()
             ? (std::filesystem::path(home) / ".cache" / "fcl_stpbv").string()
             : "";
}

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

bool operator<(const LinkPair& a, const LinkPair& b) {
  const auto key = [](const LinkPair& p) {
    const bool swapped = !p.obstacle && p.link2 < p.link1;
    return std::tuple(p.obstacle, swapped ? p.link2 : p.link1, swapped ? p.link1 : p.link2);
  };
  return key(a) < key(b);
}

bool RobotGeometry::counts(int body, bool inParts) const {
  const Body& b = bodies[static_cast<std::size_t>(body)];
  return inParts ? b.parts == 0 : b.partOf < 0;
}

namespace detail {

ShapeSources readGeometry(const RobotModel& robot, const GeometryOptions& options, LoadFaults& faults) {
  checkNames(robot, options, faults);
  checkNumbers(robot, options, faults);
  const VolumeCache cache(options.cacheFolder);
  const IsCached isCached = [&](const std::string& link, const std::string& meshKey) {
    const VolumeKey key = volumeKey(options, link, meshKey);
    return !isFlat(options, link) && cache.has(key.content, key.radii);
  };
  return readShapes(robot, options.visual, options.packagePath, isCached, faults);
}

RobotGeometry buildGeometry(const RobotModel& robot, const GeometryOptions& options,
                            const ShapeSources& sources, LoadFaults& faults) {
  return Builder(robot, options, faults).build(sources);
}

}  // namespace detail

RobotGeometry loadGeometry(const RobotModel& robot, const GeometryOptions& options) {
  LoadFaults faults;
  const ShapeSources sources = readGeometry(robot, options, faults);
  faults.refuse();
  RobotGeometry geometry = buildGeometry(robot, options, sources, faults);
  faults.refuse();
  return geometry;
}

}  // namespace fcl_stpbv
