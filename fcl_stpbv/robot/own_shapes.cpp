// The distance of each mesh or primitive of one link to each of the other, less the margins r of both.
#include "fcl_stpbv/robot/own_shapes.h"

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/hull_geometry.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/mesh_file.h"
#include "fcl_stpbv/robot/triangle_tree.h"

namespace fcl_stpbv::detail {
namespace {

// How far a body's surface is outside its mesh at least.
double marginOf(const Body& body) { return body.volume && !body.file.empty() ? body.volume->radii().r : 0; }

}  // namespace

const fcl::CollisionGeometryd& OwnShapes::shape(int body) {
  std::shared_ptr<const fcl::CollisionGeometryd>& shape = shapes_[body];
  if (shape) return *shape;
  const Body& whole = whole_->bodies[at(body)];
  shape = whole.primitive ? whole.primitive : whole.geometry;
  if (whole.file.empty()) return *shape;
  const TriangleMesh mesh = loadMesh(whole.file, whole.scale);
  shape = mesh.triangles.empty() ? hullGeometry(mesh.vertices) : triangleTree(mesh.vertices, mesh.triangles);
  return *shape;
}

bool OwnShapes::rulesOut(const SceneNeed& need, const Kinematics& kinematics,
                         const std::vector<Obstacle>& obstacles) {
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(need.q, state);
  const auto poseOf = [&](const Body& body) -> Eigen::Isometry3d {
    return state.link[at(body.link)] * body.pose;
  };
  const auto isNear = [&](int body, const fcl::CollisionGeometryd& other, const Eigen::Isometry3d& pose,
                          double margin) {
    const Body& a = whole_->bodies[at(body)];
    const DistanceAnswer found = fcl_stpbv::distance(shape(body), poseOf(a), other, pose);
    return found.status != DistanceStatus::invalid && found.upper - marginOf(a) - margin <= need.clearance;
  };
  const auto [first, last] = whole_->of(need.pair.link1);
  for (int i = first; i < last; ++i) {
    if (need.pair.obstacle) {
      const Obstacle& obstacle = obstacles[at(need.pair.link2)];
      if (isNear(i, *obstacle.geometry(), obstacle.pose(), 0)) return true;
      continue;
    }
    const auto [begin, end] = whole_->of(need.pair.link2);
    for (int j = begin; j < end; ++j) {
      const Body& b = whole_->bodies[at(j)];
      if (isNear(i, shape(j), poseOf(b), marginOf(b))) return true;
    }
  }
  return false;
}

}  // namespace fcl_stpbv::detail
