// Triangle meshes that are not convex, closed ones and such as robots come with. Metres.
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
/// Half a sphere without a lid: it encloses nothing.
TriangleMesh bowl(double radius, int rings);
/// All in one, vertices not shared.
TriangleMesh together(const std::vector<TriangleMesh>& meshes);
/// The same faces turned inside out.
TriangleMesh turned(TriangleMesh mesh);
/// Every triangle cut in four, `times` over.
TriangleMesh finer(TriangleMesh mesh, int times = 1);
/// All vertices moved by up to `size` along each axis.
TriangleMesh shaken(TriangleMesh mesh, double size, Random& random);

/// A point of the surface, uniform by area over any number of calls.
Eigen::Vector3d pointOn(const TriangleMesh& mesh, Random& random);

}  // namespace fcl_stpbv::test
