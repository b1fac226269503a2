// FCL's simple geometries as this library's shapes: one case for each type, sizes and axes translated. And a
// convex hull in the format of fcl::Convexd: a list of vertices, and faces as [n, i0, i1, ...].
#include "fcl_stpbv/adapter/fcl_shapes.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cone.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/halfspace.h>
#include <fcl/geometry/shape/plane.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/triangle_p.h>

#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv::detail {

bool shapeOf(const fcl::CollisionGeometryd& geometry, Shape& shape) {
  switch (geometry.getNodeType()) {
    case fcl::GEOM_SPHERE:
      shape = Shape::sphere(static_cast<const fcl::Sphered&>(geometry).radius);
      return true;
    case fcl::GEOM_CAPSULE: {
      const auto& g = static_cast<const fcl::Capsuled&>(geometry);
      shape = Shape::capsule(g.radius, g.lz);
      return true;
    }
    case fcl::GEOM_ELLIPSOID:
      shape = Shape::ellipsoidOf(static_cast<const fcl::Ellipsoidd&>(geometry).radii);
      return true;
    case fcl::GEOM_BOX:
      shape = Shape::boxOf(static_cast<const fcl::Boxd&>(geometry).side);
      return true;
    case fcl::GEOM_CYLINDER: {
      const auto& g = static_cast<const fcl::Cylinderd&>(geometry);
      shape = Shape::cylinderOf(g.radius, g.lz);
      return true;
    }
    case fcl::GEOM_CONE: {
      const auto& g = static_cast<const fcl::Coned&>(geometry);
      shape = Shape::coneOf(g.radius, g.lz);
      return true;
    }
    case fcl::GEOM_CONVEX: {
      const auto& g = static_cast<const fcl::Convexd&>(geometry);
      const auto& vertices = g.getVertices();
      shape = Shape::polytopeOf(vertices.data(), static_cast<int>(vertices.size()), g.getInteriorPoint());
      return true;
    }
    case fcl::GEOM_HALFSPACE: {
      const auto& g = static_cast<const fcl::Halfspaced&>(geometry);
      shape = Shape::halfspaceOf(g.n, g.d);
      return true;
    }
    case fcl::GEOM_PLANE: {
      const auto& g = static_cast<const fcl::Planed&>(geometry);
      shape = Shape::planeOf(g.n, g.d);
      return true;
    }
    case fcl::GEOM_TRIANGLE: {
      const auto& g = static_cast<const fcl::TrianglePd&>(geometry);
      shape = Shape::triangleOf(g.a, g.b, g.c);
      return true;
    }
    default:
      return false;
  }
}

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
