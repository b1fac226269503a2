// Computes the distance of each mesh or primitive of one link to each of the other, minus the margins r of
// both.
#include "fcl_stpbv/robot/own_shapes.h"

#include "fcl_stpbv/adapter/fcl_distance.h"
#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/keyed_mesh.h"
#include "fcl_stpbv/robot/triangle_tree.h"

namespace fcl_stpbv::detail {
namespace {

// Least height of the surface of a body, or of its parts, over its mesh. The larger r of a reduced volume
// covers vertices that were left out, so it is no such height.
double marginOf(const Body& body) { return body.volume && !body.file.empty() ? body.radii.r : 0; }

}  // namespace

const fcl::CollisionGeometryd& OwnShapes::shape(int body) {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::shared_ptr<const fcl::CollisionGeometryd>& shape = shapes_[body];
  if (shape) return *shape;
  const Body& whole = whole_->bodies[at(body)];
  if (whole.file.empty()) {
    shape = whole.primitive ? whole.primitive : whole.geometry;
  } else {
    const TriangleMesh mesh = KeyedMesh(whole).mesh();
    shape =
        mesh.triangles.empty() ? hullGeometry(mesh.vertices) : triangleTree(mesh.vertices, mesh.triangles);
  }
  return *shape;
}

std::vector<OwnShapes::Placed> OwnShapes::placed(int link, const Eigen::Isometry3d& pose,
                                                 const Bodies* bodies) {
  std::vector<Placed> all;
  if (bodies) {
    for (const Body* body : *bodies) all.push_back({body->geometry.get(), pose * body->pose, 0});
    return all;
  }
  const auto [first, last] = whole_->of(link);
  for (int i = first; i < last; ++i) {
    const Body& body = whole_->bodies[at(i)];
    all.push_back({&shape(i), pose * body.pose, marginOf(body)});
  }
  return all;
}

bool OwnShapes::rulesOut(const SceneNeed& need, const Kinematics& kinematics,
                         const std::vector<Obstacle>& obstacles, const Bodies* bodies1,
                         const Bodies* bodies2) {
  Kinematics::State state = kinematics.makeState();
  kinematics.forward(need.q, state);
  const std::vector<Placed> first = placed(need.pair.link1, state.link[at(need.pair.link1)], bodies1);
  std::vector<Placed> second;
  if (need.pair.obstacle) {
    const Obstacle& obstacle = obstacles[at(need.pair.link2)];
    second.push_back({obstacle.geometry().get(), obstacle.pose(), 0});
  } else {
    second = placed(need.pair.link2, state.link[at(need.pair.link2)], bodies2);
  }
  for (const Placed& a : first) {
    for (const Placed& b : second) {
      const DistanceAnswer found = fcl_stpbv::distance(*a.geometry, a.pose, *b.geometry, b.pose);
      if (found.status != DistanceStatus::invalid && found.upper - a.margin - b.margin <= need.clearance)
        return true;
    }
  }
  return false;
}

}  // namespace fcl_stpbv::detail
