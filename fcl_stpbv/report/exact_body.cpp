// The shape that a body stands for, as FCL measures it: a bounding volume hierarchy of the mesh's triangles,
// or the primitive. A mesh's volume is a sum of tetrahedra.
#include "fcl_stpbv/report/exact_body.h"

#include <cmath>
#include <limits>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/keyed_mesh.h"
#include "fcl_stpbv/robot/triangle_tree.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

using Eigen::Vector3d;

// One corner of each piece.
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
  const TriangleMesh mesh = KeyedMesh(body).mesh();
  hull_ = hullGeometry(mesh.vertices);
  if (mesh.triangles.empty()) {
    shape_ = hull_;
    partPoints_ = {mesh.vertices.front()};
    return;
  }
  solid_ = std::make_unique<const MeshSolid>(mesh);
  shape_ = triangleTree(solid_->pieces().vertices, solid_->pieces().triangles);
  partPoints_ = cornersOf(solid_->pieces());
}

double ExactBody::volume() const {
  if (!solid_ || !solid_->closed()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  const Vector3d& o = solid_->triangles().front()[0];  // near the triangles, so that no digits are lost
  for (const Triangle& t : solid_->triangles()) sum += (t[0] - o).dot((t[1] - o).cross(t[2] - o)) / 6;
  return std::abs(sum);  // the sum is negative if the triangles face inward, as in a mirrored mesh
}

}  // namespace fcl_stpbv::report
