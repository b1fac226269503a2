// The bounding boxes of FCL's meshes: converts all types of bounding volumes to oriented boxes, detects boxes
// that may miss triangles, and fits replacements.
#pragma once

#include <fcl/geometry/bvh/BVH_model.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

#include "fcl_stpbv/adapter/element_tree.h"

namespace fcl_stpbv::detail {

inline OrientedBox boxAround(const fcl::AABBd& bv) {
  return {0.5 * (bv.min_ + bv.max_), Eigen::Matrix3d::Identity(), 0.5 * (bv.max_ - bv.min_)};
}
inline OrientedBox boxAround(const fcl::OBBd& bv) { return {bv.To, bv.axis, bv.extent}; }
inline OrientedBox boxAround(const fcl::RSSd& bv) {
  return {bv.center(), bv.axis, Eigen::Vector3d(0.5 * bv.l[0] + bv.r, 0.5 * bv.l[1] + bv.r, bv.r)};
}
inline OrientedBox boxAround(const fcl::OBBRSSd& bv) { return boxAround(bv.obb); }
inline OrientedBox boxAround(const fcl::kIOSd& bv) { return boxAround(bv.obb); }
template <std::size_t N>
OrientedBox boxAround(const fcl::KDOP<double, N>& bv) {  // the first three slabs are those of the axes
  const Eigen::Vector3d low(bv.dist(0), bv.dist(1), bv.dist(2));
  const Eigen::Vector3d high(bv.dist(N / 2), bv.dist(N / 2 + 1), bv.dist(N / 2 + 2));
  return {0.5 * (low + high), Eigen::Matrix3d::Identity(), 0.5 * (high - low)};
}

/// The bounding volume from which boxAround() takes the box.
template <typename BV>
const BV& boxed(const BV& bv) {
  return bv;
}
inline const fcl::OBBd& boxed(const fcl::OBBRSSd& bv) { return bv.obb; }
inline const fcl::OBBd& boxed(const fcl::kIOSd& bv) { return bv.obb; }

constexpr double kSameBox = 1e-9;  // share of the size

/// Whether FCL may have merged a bounding volume from two others, in a way that may leave parts of them out
/// (FCL 0.7, RSS-inl.h, OBB-inl.h). It tests a property that all such volumes have and few others do. OBB:
/// the upper end along its first axis is that of the two boxes, while the lower one may be lost. RSS: the
/// third axis is perpendicular to two axes of the first part.
inline bool mayBeMerged(const fcl::OBBd& both, const fcl::OBBd& first, const fcl::OBBd& second) {
  const Eigen::Vector3d n = both.axis.col(0);
  const auto top = [&](const fcl::OBBd& bv) {
    return n.dot(bv.To - both.To) + bv.extent.dot((bv.axis.transpose() * n).cwiseAbs());
  };
  return std::abs(std::max(top(first), top(second)) - both.extent[0]) <=
         kSameBox * (both.extent.sum() + both.To.lpNorm<1>());
}
inline bool mayBeMerged(const fcl::RSSd& both, const fcl::RSSd& first, const fcl::RSSd&) {
  return (both.axis.col(2) - first.axis.col(0).cross(first.axis.col(1))).lpNorm<1>() <= kSameBox;
}
template <typename BV>
bool mayBeMerged(const BV&, const BV&, const BV&) {
  return false;  // merged AABBs and KDOPs contain both parts
}

/// Whether the box's axes are orthonormal. For a triangle whose corners lie on a line, FCL's fit (after
/// vertices have moved) makes zero or skew axes, and a box at a wrong place.
inline bool hasAxes(const OrientedBox& box) {
  return (box.axes.transpose() * box.axes - Eigen::Matrix3d::Identity()).lpNorm<1>() <= kSameBox;
}

/// Whether the mesh's elements are points. A cloud that was begun with space for triangles has an empty array
/// of triangles.
template <typename BV>
bool isCloud(const fcl::BVHModel<BV>& mesh) {
  return mesh.num_tris == 0;
}

/// Calls `action` with each corner of a triangle, or with the point of a cloud.
template <typename BV, typename Action>
void forCorners(const fcl::BVHModel<BV>& mesh, int element, Action&& action) {
  if (isCloud(mesh)) return action(mesh.vertices[element]);
  const fcl::Triangle& t = mesh.tri_indices[element];
  for (const std::size_t i : {t[0], t[1], t[2]}) action(mesh.vertices[i]);
}

/// Whether an element is in a box, up to the rounding of the box's fit.
template <typename BV>
bool holdsElement(const fcl::BVHModel<BV>& mesh, int element, const OrientedBox& box) {
  const double rounding = kSameBox * (box.half.sum() + box.centre.lpNorm<1>());
  bool holds = true;
  forCorners(mesh, element, [&](const Eigen::Vector3d& p) {
    const Eigen::Vector3d local = box.axes.transpose() * (p - box.centre);
    holds = holds && (local.cwiseAbs() - box.half).maxCoeff() <= rounding;
  });
  return holds;
}

/// Whether a box is the one that FCL makes by merging the boxes of its two parts.
template <typename BV>
bool isMerged(const BV& both, const BV& first, const BV& second) {
  const OrientedBox own = boxAround(both), made = boxAround(boxed(first) + boxed(second));
  const double size = kSameBox * (own.half.sum() + own.centre.lpNorm<1>());
  return (own.centre - made.centre).lpNorm<1>() <= size && (own.half - made.half).lpNorm<1>() <= size &&
         (own.axes - made.axes).lpNorm<1>() <= kSameBox;
}

/// Whether all boxes on one path down look merged from their parts. A single fitted box may look so by
/// chance. A box without proper axes decides at once. For a single element its own box is tested, because FCL
/// merges the box before and the box after an update.
template <typename BV, typename LooksMerged>
bool lookMerged(const fcl::BVHModel<BV>& mesh, const LooksMerged& looksMerged) {
  for (int index = 0;; index = mesh.getBV(index).leftChild()) {
    const fcl::BVNode<BV>& node = mesh.getBV(index);
    const OrientedBox own = boxAround(node.bv);
    if (!hasAxes(own)) return true;
    if (node.isLeaf()) return index > 0 || !holdsElement(mesh, node.primitiveId(), own);
    if (!looksMerged(node.bv, mesh.getBV(node.leftChild()).bv, mesh.getBV(node.rightChild()).bv))
      return false;
  }
}

/// Whether FCL has fitted boxes to triangles that do not exist: for a cloud with an empty array of triangles,
/// FCL reads beyond the array. AABB and KDOP are fitted to the points instead.
template <typename BV>
bool hasStrayBoxes(const fcl::BVHModel<BV>& mesh) {
  using Boxed = std::decay_t<decltype(boxed(std::declval<const BV&>()))>;
  constexpr bool byArray = std::is_same_v<Boxed, fcl::OBBd> || std::is_same_v<Boxed, fcl::RSSd>;
  return byArray && isCloud(mesh) && mesh.tri_indices;
}

/// Whether the inner boxes were merged from their children's boxes (the default of `endReplaceModel()` and
/// `endUpdateModel()`), or are stray, instead of fitted to the elements below. A full test, which merges them
/// again, takes long. So a cheap test comes first, which decides for almost all meshes.
template <typename BV>
bool hasMergedBoxes(const fcl::BVHModel<BV>& mesh) {
  const auto maybe = [](const BV& both, const BV& first, const BV& second) {
    return mayBeMerged(boxed(both), boxed(first), boxed(second));
  };
  return hasStrayBoxes(mesh) || (lookMerged(mesh, maybe) && lookMerged(mesh, isMerged<BV>));
}

/// Boxes around everything below each node. Children come first, because FCL numbers nodes after their
/// parents.
template <typename BV>
std::vector<Eigen::AlignedBox3d> fittedBoxes(const fcl::BVHModel<BV>& mesh) {
  std::vector<Eigen::AlignedBox3d> box(static_cast<std::size_t>(mesh.getNumBVs()));
  const auto at = [&](int index) -> Eigen::AlignedBox3d& { return box[static_cast<std::size_t>(index)]; };
  for (int index = mesh.getNumBVs(); index-- > 0;) {
    const fcl::BVNode<BV>& node = mesh.getBV(index);
    if (!node.isLeaf()) {
      at(index) = at(node.leftChild()).merged(at(node.rightChild()));
    } else {
      forCorners(mesh, node.primitiveId(), [&](const Eigen::Vector3d& p) { at(index).extend(p); });
    }
  }
  return box;
}

}  // namespace fcl_stpbv::detail
