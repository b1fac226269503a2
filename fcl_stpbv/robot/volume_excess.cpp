// How far each body's surface is from the mesh or primitive that it stands for: the excess of the hull over
// the mesh's triangles (parts/mesh_solid.h), plus the over-cover of the volume over the hull.
#include "fcl_stpbv/parts/mesh_solid.h"
#include "fcl_stpbv/robot/keyed_mesh.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/worker_pool.h"

namespace fcl_stpbv {
namespace {

double hullExcessOf(const Body& body) {
  if (body.partOf >= 0) return body.openExcess;
  if (body.file.empty()) return 0;
  const TriangleMesh mesh = detail::KeyedMesh(body).mesh();
  if (mesh.triangles.empty()) return 0;  // the body of a cloud is its hull
  const MeshSolid solid(mesh);
  return hullExcess(solid.pieces().vertices, solid, quickExcess(false)).upper;
}

}  // namespace

void measureExcess(RobotGeometry& geometry, int threads) {
  detail::shareOut(geometry.bodies.size(), threads, [&](std::size_t i) {
    Body& body = geometry.bodies[i];
    body.volumeExcess = hullExcessOf(body) + body.cover.max;
  });
}

}  // namespace fcl_stpbv
