// An STP-BV as an FCL convex polyhedron. Each feature of the hull is matched with a patch of the volume:
// faces by their vertices, edges by their ends. The bounding box is that of the smooth surface.
#include "fcl_stpbv/adapter/stp_bv_geometry.h"

#include <algorithm>
#include <map>
#include <typeinfo>

#include "fcl_stpbv/adapter/fcl_shapes.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"

namespace fcl_stpbv {
namespace {

using namespace detail;
using Eigen::Vector3d;

const std::vector<Vector3d>& verticesOf(const StpBv::Ptr& volume) {
  if (!volume) throw Error("StpBvGeometry: the volume is null; build or load one first");
  return volume->vertices();
}

const HullGraph& given(const std::shared_ptr<const HullGraph>& hull) {
  if (!hull) throw Error("StpBvGeometry: the hull is null; leave it out, and it is made");
  return *hull;
}

}  // namespace

StpBvGeometry::StpBvGeometry(StpBv::Ptr volume)
    : StpBvGeometry(volume, std::make_shared<const HullGraph>(verticesOf(volume))) {}

// FCL's check of the mesh would throw on degenerate volumes, and everything
// else it checks holds by construction.
StpBvGeometry::StpBvGeometry(StpBv::Ptr volume, std::shared_ptr<const HullGraph> hull)
    : fcl::Convexd(fclVertices(given(hull), verticesOf(volume)), given(hull).faceCount(),
                   fclFaces(given(hull)),
                   /*throw_if_invalid=*/false),
      volume_(std::move(volume)),
      hull_(std::move(hull)) {
  nameFaces();
  nameEdges();
  computeLocalAABB();
}

void StpBvGeometry::nameFaces() {
  std::map<std::vector<int>, int> patches;  // key: a face's vertices, sorted
  for (int f = 0; f < volume_->faceCount(); ++f) {
    std::vector<int> ring = volume_->faces()[at(f)];
    std::sort(ring.begin(), ring.end());
    patches[ring] = volume_->facePatch(f);
  }
  for (int f = 0; f < hull_->faceCount(); ++f) {
    std::vector<int> ring;
    for (const int v : hull_->faces()[at(f)]) ring.push_back(hull_->cloudIndex(v));
    std::sort(ring.begin(), ring.end());
    const auto named = patches.find(ring);
    // The two sides of a flat body have the same vertices, so the normal tells them apart.
    const bool same = named != patches.end() && hull_->faceCount() > 2;
    facePatch_.push_back(same ? named->second : volume_->owner(hull_->faceNormal(f)));
  }
}

void StpBvGeometry::nameEdges() {
  // An edge's ends, ascending, and its patch; an edge may have several.
  std::vector<std::array<int, 3>> patches;
  for (int e = 0; e < volume_->edgeCount(); ++e) {
    const auto [a, b] = volume_->edges()[at(e)].vertex;
    patches.push_back({std::min(a, b), std::max(a, b), volume_->edgePatch(e)});
  }
  std::sort(patches.begin(), patches.end());
  for (int e = 0; e < hull_->edgeCount(); ++e) {
    const int a = hull_->cloudIndex(hull_->edges()[at(e)][0]),
              b = hull_->cloudIndex(hull_->edges()[at(e)][1]);
    const std::array<int, 2> ends{std::min(a, b), std::max(a, b)};
    const auto begin =
        std::lower_bound(patches.begin(), patches.end(), std::array<int, 3>{ends[0], ends[1], 0});
    const auto end = std::lower_bound(begin, patches.end(), std::array<int, 3>{ends[0], ends[1] + 1, 0});
    const std::array<int, 2>& sides = hull_->edgeFaces()[at(e)];
    if (sides[0] < 0) {  // a bare segment: any of its edge patches
      edgePatch_.push_back(begin != end ? (*begin)[2] : a);
      continue;
    }
    Vector3d middle = hull_->faceNormal(sides[0]) + hull_->faceNormal(sides[1]);
    if (!(middle.squaredNorm() > 1e-12)) {
      // The rim of a flat body: its normals point away from the body's centre, across the edge.
      const Vector3d p = hull_->point(hull_->edges()[at(e)][0]),
                     u = hull_->point(hull_->edges()[at(e)][1]) - p;
      middle = u.cross(hull_->faceNormal(sides[0]));
      if (middle.dot(p) < 0) middle = -middle;
    }
    middle.normalize();
    int best = -1;
    double least = 0;
    for (auto it = begin; it != end; ++it) {
      const double outside = volume_->outside((*it)[2], middle);
      if (best < 0 || outside < least) best = (*it)[2], least = outside;
    }
    edgePatch_.push_back(best >= 0 ? best : volume_->owner(middle));
  }
}

int StpBvGeometry::patchOf(const HullFeature& feature) const {
  if (feature.index < 0) return -1;
  switch (feature.kind) {
    case PatchKind::edge:
      return edgePatch_[at(feature.index)];
    case PatchKind::face:
      return facePatch_[at(feature.index)];
    case PatchKind::vertex:
      break;
  }
  return hull_->cloudIndex(feature.index);  // vertex patches have their vertices' numbers
}

void StpBvGeometry::computeLocalAABB() {
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d n = Vector3d::Unit(axis);
    aabb_local.max_[axis] = volume_->support(n);
    aabb_local.min_[axis] = -volume_->support(-n);
  }
  aabb_center = aabb_local.center();
  // FCL uses this sphere in place of the box for a rotated object. Of two spheres that contain the surface,
  // take the smaller one.
  const double corner = (aabb_local.max_ - aabb_center).norm();
  const double ball = (volume_->centre() - aabb_center).norm() + volume_->enclosingRadius();
  aabb_radius = std::min(corner, ball);
}

const StpBvGeometry* asStpBv(const fcl::CollisionGeometryd* geometry) {
  // First rules out FCL's other types, then tests for the usual type. Only a derived class needs the slower
  // cast.
  if (!geometry || geometry->getNodeType() != fcl::GEOM_CONVEX) return nullptr;
  return typeid(*geometry) == typeid(StpBvGeometry) ? static_cast<const StpBvGeometry*>(geometry)
                                                    : dynamic_cast<const StpBvGeometry*>(geometry);
}

}  // namespace fcl_stpbv
