// The nearest element of a mesh or tree and the runner-up, by branch and bound down FCL's hierarchy (best
// child first, as in Larsen, Gottschalk, Lin, Manocha 1999):
// 1. bound a node's distance from below by its box;
// 2. descend into the nearer child first, skip what cannot hold one of the nearest two;
// 3. solve an element exactly, keep the two least.
#include "fcl_stpbv/adapter/nearest_element.h"

#include <algorithm>

namespace fcl_stpbv::detail {

using Eigen::Isometry3d;
using Eigen::Vector3d;

NearestElement::NearestElement(const StpBv& volume, const Isometry3d& poseVolume, const ElementTree& elements,
                               const Isometry3d& poseElements, PairCache* cache)
    : volume_(volume),
      elements_(elements),
      poseVolume_(poseVolume),
      poseElements_(poseElements),
      rotation_(poseVolume.linear().transpose() * poseElements.linear()),
      translation_(poseVolume.linear().transpose() * (poseElements.translation() - poseVolume.translation())),
      centre_(rotation_.transpose() * (volume.centre() - translation_)),
      cache_(cache) {
  if (!elements.any()) return;
  const ElementTree::Node root = elements.root();
  visit(root, lowerBound(root.box));
}

double NearestElement::lowerBound(const OrientedBox& box) const {
  const Vector3d local = box.axes.transpose() * (centre_ - box.centre);
  const double ball = (local.cwiseAbs() - box.half).cwiseMax(0.0).norm() - volume_.enclosingRadius();
  if (!any()) return ball;
  return std::max(ball, n_.dot(box.centre - centre_) - box.reach(n_) - support_);
}

double NearestElement::lowerBound(const Shape& element, const Vector3d& place) const {
  if (!any()) return -kInfinity;
  return n_.dot(place + element.support(-n_) - centre_) - element.margin - support_;
}

void NearestElement::visit(const ElementTree::Node& node, double bound) {
  // A bound that is no number is none.
  if (broken_ || (any() && bound >= runnerUp_)) return;
  if (node.leaf) {
    Shape shape;
    Vector3d place;
    if (elements_.element(node, shape, place) && !(any() && lowerBound(shape, place) >= runnerUp_))
      offer(shape, place, node.id);
    return;
  }
  std::array<ElementTree::Node, 8> child;
  std::array<double, 8> near;
  std::array<std::size_t, 8> order;
  const auto count = static_cast<std::size_t>(elements_.children(node, child));
  for (std::size_t i = 0; i < count; ++i) {
    near[i] = lowerBound(child[i].box);
    order[i] = i;
    for (std::size_t j = i; j > 0 && near[order[j]] < near[order[j - 1]]; --j)
      std::swap(order[j], order[j - 1]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = order[k];
    visit(child[i],
          k == 0 ? near[i] : std::max(near[i], lowerBound(child[i].box)));  // with the new best normal
  }
}

Distance NearestElement::best() const {
  Distance result = best_;
  result.lower = lower_;
  result.upper = upper_;
  if (best_.status == DistanceStatus::exact && !exact_) result.status = DistanceStatus::bounded;
  return result;
}

void NearestElement::takeBounds(const Distance& found, double rounding) {
  const double lower = found.lower - rounding;
  if (lower < lower_) exact_ = found.status == DistanceStatus::exact;
  lower_ = std::min(lower_, lower);
  upper_ = std::min(upper_, found.upper + rounding);
}

void NearestElement::offer(const Shape& element, const Vector3d& place, std::intptr_t id) {
  PairCache start;
  if (any())
    start = {best_.normal, best_.patch};
  else if (cache_)
    start = *cache_;
  Isometry3d at = poseElements_;
  at.translation() = poseElements_ * place;
  const Distance found = distance(volume_, poseVolume_, element, at, &start);
  if (found.status == DistanceStatus::invalid) {
    broken_ = true;
    return;
  }
  takeBounds(found, placeRounding(poseElements_, place));
  if (any() && found.distance >= best_.distance) {
    runnerUp_ = std::min(runnerUp_, found.distance);
    return;
  }
  if (any()) runnerUp_ = best_.distance;
  best_ = found;
  any_ = true;
  element_ = id;
  const Vector3d n = poseVolume_.linear().transpose() * found.normal;
  n_ = rotation_.transpose() * n;
  // Anything this much below what it is stays a bound: rounding of the coordinates.
  support_ = volume_.support(n, found.patch[0]) - n.dot(volume_.centre()) +
             1e-14 * (volume_.enclosingRadius() + translation_.lpNorm<1>() + centre_.lpNorm<1>());
  if (cache_) *cache_ = start;
}

}  // namespace fcl_stpbv::detail
