// The shape that a body stands for, as FCL measures it: a bounding volume hierarchy of the mesh's triangles,
// or the primitive. A mesh's volume is a sum of tetrahedra.
#include "fcl_stpbv/report/exact_body.h"

#include <fcl/geometry/bvh/BVH_model.h>

#include <cmath>
#include <limits>

#include "fcl_stpbv/adapter/hull_geometry.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/mesh_file.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

using Eigen::Vector3d;

std::shared_ptr<const fcl::CollisionGeometryd> bvhOf(const MeshPieces& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(at(t[0]), at(t[1]), at(t[2]));
  model->beginModel(static_cast<int>(mesh.triangles.size()), static_cast<int>(mesh.vertices.size()));
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  model->computeLocalAABB();
  return model;
}

// A corner of each piece.
std::vector<Vector3d> cornersOf(const MeshPieces& mesh) {
  std::vector<Vector3d> corners;
  std::vector<char> seen(mesh.closed.size(), 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    char& known = seen[at(mesh.piece[t])];
    if (!known) corners.push_back(mesh.vertices[at(mesh.triangles[t][0])]);
    known = 1;
  }
  return corners;
}

}  // namespace

ExactBody::ExactBody(const Body& body) {
  if (body.file.empty()) {
    shape_ = hull_ = body.primitive ? body.primitive : body.geometry;
    partPoints_ = {Vector3d::Zero()};  // FCL's primitives are centred on their frames
    return;
  }
  const TriangleMesh mesh = loadMesh(body.file, body.scale);
  hull_ = hullGeometry(mesh.vertices);
  if (mesh.triangles.empty()) {
    shape_ = hull_;
    partPoints_ = {mesh.vertices.front()};
    return;
  }
  solid_ = std::make_unique<const MeshSolid>(mesh);
  shape_ = bvhOf(solid_->pieces());
  partPoints_ = cornersOf(solid_->pieces());
}

double ExactBody::volume() const {
  if (!solid_ || !solid_->closed()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  const Vector3d& o = solid_->triangles().front()[0];  // near the triangles, so that no digits are lost
  for (const Triangle& t : solid_->triangles()) sum += (t[0] - o).dot((t[1] - o).cross(t[2] - o)) / 6;
  return std::abs(sum);  // inward triangles, as a mirrored mesh has them, make it negative
}

}  // namespace fcl_stpbv::report
