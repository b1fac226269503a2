// The shapes of a robot before volumes are built: selects them, and finds and reads each mesh file once.
#include "fcl_stpbv/robot/shape_source.h"

#include <algorithm>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/mesh/passing_error.h"
#include "fcl_stpbv/robot/keyed_mesh.h"
#include "fcl_stpbv/robot/package_path.h"

namespace fcl_stpbv::detail {
namespace {

using Shapes = std::vector<ShapeModel> LinkModel::*;

std::size_t linksWith(const RobotModel& robot, Shapes shapes) {
  return static_cast<std::size_t>(
      std::count_if(robot.links.begin(), robot.links.end(),
                    [&](const LinkModel& link) { return !(link.*shapes).empty(); }));
}

class Reader {
 public:
  Reader(const RobotModel& robot, const std::vector<std::string>& packagePath, LoadFaults& faults)
      : robot_(robot), paths_(robot.path, packagePath), faults_(faults) {}

  ShapeSources read(bool visual, const IsCached& isCached) {
    const Shapes shapes = choose(visual);
    for (std::size_t l = 0; l < robot_.links.size(); ++l) {
      const LinkModel& link = robot_.links[l];
      if (shapes == &LinkModel::visual ? link.lacksVisual : link.lacksCollision)
        sources_.incomplete.insert(static_cast<int>(l));
      int number = 0;
      for (const ShapeModel& shape : link.*shapes) {
        ShapeSource source;
        source.link = static_cast<int>(l);
        source.number = ++number;
        source.shape = &shape;
        add(std::move(source), isCached);
      }
    }
    return std::move(sources_);
  }

 private:
  Shapes choose(bool visual) {
    const std::size_t collision = linksWith(robot_, &LinkModel::collision);
    const std::size_t visuals = linksWith(robot_, &LinkModel::visual);
    // A robot whose collision shapes are all faulty does not count as a robot without collision shapes.
    const bool instead = !visual && collision == 0 && faults_.shapes.empty() && visuals > 0;
    if (instead)
      warn("no link has a collision shape; the visual shapes of " + std::to_string(visuals) +
           " links are used instead.");
    const bool visible = visual || instead;
    if (visible)
      faults_.shapes.insert(faults_.shapes.end(), robot_.visualFaults.begin(), robot_.visualFaults.end());
    if ((visible ? visuals : collision) == 0)
      warn(std::string("no link has a ") + (visible ? "visual" : "collision") +
           " shape, so there is nothing to check.");
    const Shapes used = visible ? &LinkModel::visual : &LinkModel::collision;
    if (linksWith(robot_, used) > 0) warnOfOthers(used, visible ? &LinkModel::collision : &LinkModel::visual);
    return used;
  }

  // Warns of links that have visual shapes but no collision shapes, since they are drawn but not checked.
  void warnOfOthers(Shapes used, Shapes other) {
    constexpr std::size_t kNamed = 5;
    std::vector<std::string> names;
    for (const LinkModel& link : robot_.links)
      if ((link.*used).empty() && !(link.*other).empty()) names.push_back(link.name);
    if (names.empty()) return;
    const bool visible = used == &LinkModel::visual;
    std::string list;
    for (std::size_t i = 0; i < std::min(kNamed, names.size()); ++i)
      list += (i == 0 ? "" : ", ") + ("\"" + names[i] + '"');
    if (names.size() > kNamed) list += " and " + std::to_string(names.size() - kNamed) + " more";
    warn(std::to_string(names.size()) + (names.size() == 1 ? " link has " : " links have ") +
         (visible ? "collision shapes but no visual one" : "visual shapes but no collision shape") +
         ", so nothing checks " + (names.size() == 1 ? "it: " : "them: ") + list + ".");
  }

  void warn(const std::string& message) { sources_.warnings.push_back(robot_.path + ": " + message); }

  void add(ShapeSource source, const IsCached& isCached) {
    std::string fault = shapeFault(source.shape->place, [&] {
      if (source.shape->kind != ShapeModel::Kind::mesh) return;
      source.file = paths_.resolve(source.shape->mesh);
      const KeyedMesh mesh(source.file, source.shape->scale);
      source.key = mesh.key();
      if (!isCached(robot_.links[static_cast<std::size_t>(source.link)].name, source.key)) source.keep(mesh);
    });
    if (fault.empty()) {
      sources_.shapes.push_back(std::move(source));
    } else {
      faults_.shapes.push_back(std::move(fault));
      sources_.incomplete.insert(source.link);
    }
  }

  const RobotModel& robot_;
  PackagePath paths_;
  LoadFaults& faults_;
  ShapeSources sources_;
};

}  // namespace

const std::vector<Eigen::Vector3d>& ShapeSource::points() const {
  if (points_.empty()) keep(KeyedMesh(file, shape->scale, key));
  return points_;
}

void ShapeSource::keep(const KeyedMesh& mesh) const {
  points_ = mesh.mesh().vertices;
  constexpr double kMost = 1e6;  // larger than any robot (m)
  for (const Eigen::Vector3d& p : points_)
    if (!(p.lpNorm<Eigen::Infinity>() <= kMost))
      throw Error(file + ": its scaled coordinates must be finite, and within 1e6 m");
}

ShapeSources readShapes(const RobotModel& robot, bool visual, const std::vector<std::string>& packagePath,
                        const IsCached& isCached, LoadFaults& faults) {
  return Reader(robot, packagePath, faults).read(visual, isCached);
}

}  // namespace fcl_stpbv::detail
