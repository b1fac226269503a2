#include "fcl_stpbv/adapter/mesh_traversal.h"

#include <fcl/geometry/bvh/BVH_model.h>

namespace fcl_stpbv {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

OrientedBox boxAround(const fcl::AABBd& bv) {
  return {0.5 * (bv.min_ + bv.max_), Matrix3d::Identity(), 0.5 * (bv.max_ - bv.min_)};
}
OrientedBox boxAround(const fcl::OBBd& bv) { return {bv.To, bv.axis, bv.extent}; }
OrientedBox boxAround(const fcl::RSSd& bv) {
  return {bv.center(), bv.axis, Vector3d(0.5 * bv.l[0] + bv.r, 0.5 * bv.l[1] + bv.r, bv.r)};
}
OrientedBox boxAround(const fcl::OBBRSSd& bv) { return boxAround(bv.obb); }
OrientedBox boxAround(const fcl::kIOSd& bv) { return boxAround(bv.obb); }
template <std::size_t N>
OrientedBox boxAround(const fcl::KDOP<double, N>& bv) {  // its first three slabs are the axes'
  const Vector3d low(bv.dist(0), bv.dist(1), bv.dist(2));
  const Vector3d high(bv.dist(N / 2), bv.dist(N / 2 + 1), bv.dist(N / 2 + 2));
  return {0.5 * (low + high), Matrix3d::Identity(), 0.5 * (high - low)};
}

/// Rounding in FCL's fitting of a bounding volume may leave a triangle's corner outside by this part of its
/// size.
constexpr double kFit = 1e-9;

template <typename BV>
class Walk {
 public:
  Walk(const fcl::BVHModel<BV>& mesh, NearestElement& search) : mesh_(mesh), search_(search) {}

  void visit(int index, double bound) {
    const fcl::BVNode<BV>& node = mesh_.getBV(index);
    if (!search_.mayImprove(bound)) return;
    if (node.isLeaf()) {
      offer(node.primitiveId());
      return;
    }
    const int left = node.leftChild(), right = node.rightChild();
    const double toLeft = boundOf(left), toRight = boundOf(right);
    visit(toLeft <= toRight ? left : right, std::min(toLeft, toRight));
    // The bound may have grown with the new best normal.
    const int other = toLeft <= toRight ? right : left;
    visit(other, std::max(std::max(toLeft, toRight), boundOf(other)));
  }

  double boundOf(int index) const {
    const OrientedBox box = boxAround(mesh_.getBV(index).bv);
    return search_.lowerBound(box) - kFit * (box.half.sum() + box.centre.lpNorm<1>());
  }

 private:
  void offer(int id) {
    if (!mesh_.tri_indices) {
      const Vector3d p = mesh_.vertices[id];
      search_.offer(Shape::triangleOf(p, p, p), search_.pose(), id);
      return;
    }
    const fcl::Triangle& t = mesh_.tri_indices[id];
    search_.offer(Shape::triangleOf(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]),
                  search_.pose(), id);
  }

  const fcl::BVHModel<BV>& mesh_;
  NearestElement& search_;
};

template <typename BV>
bool search(const fcl::CollisionGeometryd& geometry, NearestElement& search) {
  const auto& mesh = static_cast<const fcl::BVHModel<BV>&>(geometry);
  if (mesh.getNumBVs() < 1 || !mesh.vertices) return true;  // nothing to find
  Walk<BV> walk(mesh, search);
  walk.visit(0, walk.boundOf(0));
  return true;
}

}  // namespace

bool searchMesh(const fcl::CollisionGeometryd& mesh, NearestElement& found) {
  switch (mesh.getNodeType()) {
    case fcl::BV_AABB:
      return search<fcl::AABBd>(mesh, found);
    case fcl::BV_OBB:
      return search<fcl::OBBd>(mesh, found);
    case fcl::BV_RSS:
      return search<fcl::RSSd>(mesh, found);
    case fcl::BV_kIOS:
      return search<fcl::kIOSd>(mesh, found);
    case fcl::BV_OBBRSS:
      return search<fcl::OBBRSSd>(mesh, found);
    case fcl::BV_KDOP16:
      return search<fcl::KDOP<double, 16>>(mesh, found);
    case fcl::BV_KDOP18:
      return search<fcl::KDOP<double, 18>>(mesh, found);
    case fcl::BV_KDOP24:
      return search<fcl::KDOP<double, 24>>(mesh, found);
    default:
      return false;
  }
}

}  // namespace fcl_stpbv
