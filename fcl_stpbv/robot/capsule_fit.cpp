// Joins a cylinder and two spheres of its radius at its ends to a capsule, because URDF has no capsule.
#include "fcl_stpbv/robot/capsule_fit.h"

#include <algorithm>
#include <cmath>

namespace fcl_stpbv::detail {
namespace {

// Numbers may differ by this, because writers of URDF keep about six digits (m).
constexpr double kAlike = 1e-6;

int sphereAt(const std::vector<ShapeModel>& shapes, const Eigen::Vector3d& centre, double radius) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].kind == ShapeModel::Kind::sphere && std::abs(shapes[i].size.x() - radius) < kAlike &&
        (shapes[i].pose.translation() - centre).norm() < kAlike)
      return static_cast<int>(i);
  }
  return -1;
}

}  // namespace

void joinCapsules(std::vector<ShapeModel>& shapes) {
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    if (shapes[i].kind != ShapeModel::Kind::cylinder) continue;
    const Eigen::Vector3d half(0, 0, shapes[i].size.y() / 2);
    const Eigen::Vector3d topAt = shapes[i].pose * half, bottomAt = shapes[i].pose * -half;
    const int top = sphereAt(shapes, topAt, shapes[i].size.x());
    const int bottom = sphereAt(shapes, bottomAt, shapes[i].size.x());
    if (top < 0 || bottom < 0 || top == bottom) continue;
    shapes[i].kind = ShapeModel::Kind::capsule;
    // The capsule is wide enough for spheres that are off by their last digit.
    const auto take = [&](const ShapeModel& sphere, const Eigen::Vector3d& centre) {
      const double off = (sphere.pose.translation() - centre).norm();
      shapes[i].size.x() = std::max(shapes[i].size.x(), sphere.size.x() + off);
      shapes[i].elements += sphere.elements;
    };
    take(shapes[static_cast<std::size_t>(top)], topAt);
    take(shapes[static_cast<std::size_t>(bottom)], bottomAt);
    shapes.erase(shapes.begin() + std::max(top, bottom));
    shapes.erase(shapes.begin() + std::min(top, bottom));
    i = static_cast<std::size_t>(-1);  // the indices have changed: search again from the start
  }
}

}  // namespace fcl_stpbv::detail
