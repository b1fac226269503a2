// 1. Read all shapes again: primitives as FCL's shapes, meshes as its trees of triangles.
// 2. Place them by the library's kinematics.
// 3. Call fcl::collide for each given pair of links, and for every link with every obstacle that it must not
// touch.
#include "test/reference/mesh_check.h"

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/collision.h>

#include <algorithm>
#include <set>

#include "fcl_stpbv/mesh/mesh_file.h"
#include "fcl_stpbv/robot/package_path.h"

namespace fcl_stpbv::test {
namespace {

using namespace detail;

std::shared_ptr<fcl::CollisionGeometryd> trianglesOf(const TriangleMesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  model->beginModel();
  for (const auto& t : mesh.triangles)
    model->addTriangle(mesh.vertices[static_cast<std::size_t>(t[0])],
                       mesh.vertices[static_cast<std::size_t>(t[1])],
                       mesh.vertices[static_cast<std::size_t>(t[2])]);
  model->endModel();
  return model;
}

std::shared_ptr<fcl::CollisionGeometryd> geometryOf(const ShapeModel& shape, const PackagePath& paths) {
  switch (shape.kind) {
    case ShapeModel::Kind::sphere:
      return std::make_shared<fcl::Sphered>(shape.size.x());
    case ShapeModel::Kind::box:
      return std::make_shared<fcl::Boxd>(shape.size);
    case ShapeModel::Kind::cylinder:
      return std::make_shared<fcl::Cylinderd>(shape.size.x(), shape.size.y());
    case ShapeModel::Kind::capsule:
      return std::make_shared<fcl::Capsuled>(shape.size.x(), shape.size.y());
    default:
      return trianglesOf(loadMesh(paths.resolve(shape.mesh), shape.scale));
  }
}

bool collide(const fcl::CollisionGeometryd& a, const Eigen::Isometry3d& poseA,
             const fcl::CollisionGeometryd& b, const Eigen::Isometry3d& poseB) {
  fcl::CollisionResultd result;
  return fcl::collide(&a, poseA, &b, poseB, fcl::CollisionRequestd(), result) > 0;
}

}  // namespace

std::vector<MeshCheck::Part> MeshCheck::partsOf(const RobotModel& model,
                                                const std::vector<std::string>& packagePath) {
  const PackagePath paths(model.path, packagePath);
  const bool visual = std::all_of(model.links.begin(), model.links.end(),
                                  [](const LinkModel& link) { return link.collision.empty(); });
  std::vector<Part> parts;
  for (std::size_t i = 0; i < model.links.size(); ++i)
    for (const ShapeModel& shape : visual ? model.links[i].visual : model.links[i].collision)
      parts.push_back({static_cast<int>(i), model.links[i].name, geometryOf(shape, paths), shape.pose});
  return parts;
}

MeshCheck::MeshCheck(std::shared_ptr<const RobotModel> robot, std::shared_ptr<const RobotModel> scene,
                     const std::vector<std::string>& packagePath,
                     std::vector<std::pair<std::string, std::string>> allowed)
    : robot_(partsOf(*robot, packagePath)), allowed_(std::move(allowed)) {
  if (!scene) return;
  scene_ = partsOf(*scene, packagePath);
  const Kinematics kinematics(scene);
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(kinematics.neutral(), state);
  for (const Part& part : scene_)
    scenePoses_.push_back(state.link[static_cast<std::size_t>(part.link)] * part.pose);
}

void MeshCheck::setObstacles(const std::vector<Obstacle>& obstacles) {
  scene_.clear();
  scenePoses_.clear();
  for (const Obstacle& obstacle : obstacles) {
    scene_.push_back({0, obstacle.name, std::const_pointer_cast<fcl::CollisionGeometryd>(obstacle.geometry()),
                      Eigen::Isometry3d::Identity()});
    scenePoses_.push_back(obstacle.pose());
  }
}

std::vector<std::string> MeshCheck::collisions(const Kinematics& kinematics, const Eigen::VectorXd& q,
                                               const std::vector<std::pair<int, int>>& links) {
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(q, state);
  const auto poseOf = [&](const Part& part) {
    return state.link[static_cast<std::size_t>(part.link)] * part.pose;
  };
  const std::set<std::pair<int, int>> wanted(links.begin(), links.end());
  std::vector<std::string> found;
  for (const Part& a : robot_) {
    for (const Part& b : robot_)
      if (wanted.count({a.link, b.link}) && collide(*a.geometry, poseOf(a), *b.geometry, poseOf(b)))
        found.push_back(a.name + " - " + b.name);
    for (std::size_t i = 0; i < scene_.size(); ++i) {
      const std::pair<std::string, std::string> names{a.name, scene_[i].name};
      if (std::find(allowed_.begin(), allowed_.end(), names) != allowed_.end()) continue;
      if (collide(*a.geometry, poseOf(a), *scene_[i].geometry, scenePoses_[i]))
        found.push_back(names.first + " - " + names.second);
    }
  }
  return found;
}

std::vector<std::pair<int, int>> linksOf(const std::vector<CheckedPair>& pairs,
                                         const RobotGeometry& geometry) {
  std::set<std::pair<int, int>> links;
  for (const CheckedPair& pair : pairs)
    if (!pair.obstacle)
      links.emplace(geometry.bodies[static_cast<std::size_t>(pair.body)].link,
                    geometry.bodies[static_cast<std::size_t>(pair.other)].link);
  return {links.begin(), links.end()};
}

}  // namespace fcl_stpbv::test
