#include "fcl_stpbv/adapter/nearest_element.h"

#include <algorithm>

namespace fcl_stpbv {

using Eigen::Isometry3d;
using Eigen::Vector3d;

NearestElement::NearestElement(const StpBv& volume, const Isometry3d& poseVolume,
                               const Isometry3d& poseElements, PairCache* cache)
    : volume_(volume),
      poseVolume_(poseVolume),
      poseElements_(poseElements),
      rotation_(poseVolume.linear().transpose() * poseElements.linear()),
      translation_(poseVolume.linear().transpose() * (poseElements.translation() - poseVolume.translation())),
      centre_(rotation_.transpose() * (volume.centre() - translation_)),
      cache_(cache) {}

double NearestElement::lowerBound(const OrientedBox& box) const {
  const Vector3d local = box.axes.transpose() * (centre_ - box.centre);
  const double ball = (local.cwiseAbs() - box.half).cwiseMax(0.0).norm() - volume_.enclosingRadius();
  if (!any()) return ball;
  const double plane =
      n_.dot(box.centre - centre_) - box.half.dot((box.axes.transpose() * n_).cwiseAbs()) - support_;
  return std::max(ball, plane);
}

bool NearestElement::mayImprove(double bound) {
  if (!any() || bound < best_.distance) return true;
  runnerUp_ = std::min(runnerUp_, bound);
  return false;
}

void NearestElement::offer(const Shape& element, const Isometry3d& pose, std::intptr_t id) {
  PairCache start;
  if (any())
    start = {best_.normal, best_.patch};
  else if (cache_)
    start = *cache_;
  const Distance found = distance(volume_, poseVolume_, element, pose, &start);
  if (found.status == DistanceStatus::invalid) return;
  if (any() && found.distance >= best_.distance) {
    runnerUp_ = std::min(runnerUp_, found.distance);
    return;
  }
  if (any()) runnerUp_ = std::min(runnerUp_, best_.distance);
  best_ = found;
  any_ = true;
  element_ = id;
  const Vector3d n = poseVolume_.linear().transpose() * found.normal;
  n_ = rotation_.transpose() * n;
  // Anything this much below what it is stays a bound: rounding of the coordinates.
  support_ = volume_.support(n, found.patch[0]) - n.dot(volume_.centre()) +
             1e-14 * (volume_.enclosingRadius() + translation_.lpNorm<1>());
  if (cache_) *cache_ = start;
}

}  // namespace fcl_stpbv
