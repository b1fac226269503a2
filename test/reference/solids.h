// Triangle meshes that are not convex: closed ones, and open ones as robots have them. In metres.
#pragma once

#include <vector>

#include "fcl_stpbv/volume/tessellate.h"
#include "test/reference/shapes.h"

namespace fcl_stpbv::test {

/// A box from `low` to `high`, facing outward.
TriangleMesh boxMesh(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
/// Two arms of 20 cm, 5 cm thick and wide, as one closed mesh.
TriangleMesh lShape();
/// A ring about z.
TriangleMesh torusMesh(double radius, double tube, int around, int across);
/// Half a sphere without a lid, which encloses nothing.
TriangleMesh bowl(double radius, int rings);
/// All meshes in one, without shared vertices.
TriangleMesh together(const std::vector<TriangleMesh>& meshes);
/// The same faces turned inside out.
TriangleMesh turned(TriangleMesh mesh);
/// The mesh with every triangle cut in four, `times` times.
TriangleMesh finer(TriangleMesh mesh, int times = 1);
/// The mesh with all vertices moved by up to `size` along each axis.
TriangleMesh shaken(TriangleMesh mesh, double size, Random& random);

/// A point of the surface, uniform by area over any number of calls.
Eigen::Vector3d pointOn(const TriangleMesh& mesh, Random& random);

}  // namespace fcl_stpbv::test
