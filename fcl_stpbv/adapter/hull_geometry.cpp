// A convex hull in the format of fcl::Convexd: a list of vertices, and faces as [n, i0, i1, ...].
#include "fcl_stpbv/adapter/hull_geometry.h"

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

std::shared_ptr<const std::vector<fcl::Vector3d>> fclVertices(const HullGraph& hull,
                                                              const std::vector<Eigen::Vector3d>& cloud) {
  auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
  for (int v = 0; v < hull.vertexCount(); ++v) vertices->push_back(cloud[at(hull.cloudIndex(v))]);
  return vertices;
}

std::shared_ptr<const std::vector<int>> fclFaces(const HullGraph& hull) {
  auto faces = std::make_shared<std::vector<int>>();
  for (const HullGraph::Ring& ring : hull.faces()) {
    faces->push_back(static_cast<int>(ring.size()));
    faces->insert(faces->end(), ring.begin(), ring.end());
  }
  return faces;
}

std::shared_ptr<fcl::Convexd> hullGeometry(const std::vector<Eigen::Vector3d>& cloud) {
  const HullGraph hull(cloud);
  // FCL's check of the mesh would throw on degenerate hulls.
  auto geometry = std::make_shared<fcl::Convexd>(fclVertices(hull, cloud), hull.faceCount(), fclFaces(hull),
                                                 /*throw_if_invalid=*/false);
  geometry->computeLocalAABB();
  return geometry;
}

}  // namespace fcl_stpbv::detail
