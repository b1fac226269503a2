// The shape that a body stands for, as FCL measures it: a bounding volume hierarchy of the mesh's triangles,
// or the primitive. A mesh's volume is a sum of tetrahedra.
#include "fcl_stpbv/report/exact_body.h"

#include <fcl/geometry/bvh/BVH_model.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "fcl_stpbv/adapter/hull_geometry.h"
#include "fcl_stpbv/robot/mesh_file.h"

namespace fcl_stpbv::report {

using namespace detail;

namespace {

using Eigen::Vector3d;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::shared_ptr<const fcl::CollisionGeometryd> bvhOf(const TriangleMesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(at(t[0]), at(t[1]), at(t[2]));
  model->beginModel(static_cast<int>(mesh.triangles.size()), static_cast<int>(mesh.vertices.size()));
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  model->computeLocalAABB();
  return model;
}

// Solid angle of a triangle seen from the origin, signed (van Oosterom and Strackee 1983), in whole turns.
double turnsAround(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  constexpr double kHalfTurns = 6.283185307179586;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb) /
         kHalfTurns;
}

}  // namespace

ExactBody::ExactBody(const Body& body) {
  if (body.file.empty()) {
    shape_ = hull_ = body.primitive ? body.primitive : body.geometry;
    partPoints_ = {Vector3d::Zero()};  // FCL's primitives are centred on their frames
    return;
  }
  mesh_ = loadMesh(body.file, body.scale);
  hull_ = hullGeometry(mesh_.vertices);
  if (mesh_.triangles.empty()) {
    shape_ = hull_;
    partPoints_ = {mesh_.vertices.front()};
    return;
  }
  shape_ = bvhOf(mesh_);
  connect();
}

// Parts by shared vertices; closed by counting each edge's triangles, +1 one way and -1 the other.
void ExactBody::connect() {
  std::vector<std::size_t> root(mesh_.vertices.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  const auto find = [&](std::size_t v) {
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  std::map<std::array<int, 2>, int> balance;
  for (const auto& t : mesh_.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int from = t[k], to = t[(k + 1) % 3];
      root[find(at(from))] = find(at(to));
      if (from < to) ++balance[{from, to}];
      if (from > to) --balance[{to, from}];
    }
  }
  for (const auto& [edge, count] : balance) closed_ = closed_ && count == 0;
  std::vector<char> used(root.size(), 0);
  for (const auto& t : mesh_.triangles) {
    char& seen = used[find(at(t[0]))];
    if (!seen) partPoints_.push_back(mesh_.vertices[at(t[0])]);
    seen = 1;
  }
}

double ExactBody::volume() const {
  if (!mesh() || !closed_) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  const Vector3d& o = mesh_.vertices.front();  // near the triangles, so that no digits are lost
  for (const auto& t : mesh_.triangles)
    sum += (mesh_.vertices[at(t[0])] - o)
               .dot((mesh_.vertices[at(t[1])] - o).cross(mesh_.vertices[at(t[2])] - o)) /
           6;
  return std::abs(sum);  // inward triangles, as a mirrored mesh has them, make it negative
}

bool ExactBody::holds(const Vector3d& point) const {
  double turns = 0;
  for (const auto& t : mesh_.triangles)
    turns += turnsAround(mesh_.vertices[at(t[0])] - point, mesh_.vertices[at(t[1])] - point,
                         mesh_.vertices[at(t[2])] - point);
  return std::abs(turns) > 0.5;
}

}  // namespace fcl_stpbv::report
