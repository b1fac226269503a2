// Measures c in three steps.
// 1. Compute both bodies' twists. The constraints give the velocities of normal and witness points.
// 2. Compute the bodies' relative motion at the witness points.
// 3. Compute c from turning, velocity and the slide of a point, as in docs/choosing_r_and_R.md. Keep the
//    largest.
#include "tools/bench/control/contacts.h"

#include <algorithm>

namespace fcl_stpbv::benchmark {

using Eigen::Vector3d;

ContactMeter::ContactMeter(const Scene& scene, const Method& method, double influence)
    : scene_(scene),
      influence_(influence),
      constraints_(constraintsOf(scene, method)),
      rates_(constraints_->makeRates()),
      jacobian_(constraints_->makeJacobian()),
      state_(scene.kinematics->makeState()),
      rate_(scene.kinematics->makeRate()) {}

void ContactMeter::measure(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
  constraints_->evaluate(q, qd, rates_, jacobian_);
  scene_.kinematics->forward(q, state_);
  scene_.kinematics->differentiate(q, qd, state_, rate_);
  for (int row = 0; row < constraints_->rows(); ++row) {
    if (rates_.d[row] > influence_) continue;
    const std::pair<int, int>& pair = scene_.pairs[static_cast<std::size_t>(row)];
    const auto twistOf = [&](int solid) {
      const int link = scene_.solids[static_cast<std::size_t>(solid)].link;
      return link < 0 ? Twist{} : rate_.link[static_cast<std::size_t>(link)];
    };
    const Twist first = twistOf(pair.first), second = twistOf(pair.second);
    const RowAnswer answer = constraints_->answer(row);
    const Vector3d &n = answer.normal, &x = answer.points[0];
    const Vector3d turn = first.angular - second.angular;
    const Vector3d velocity = first.linear - second.linear + turn.cross(x);
    const Vector3d slide = answer.pointVelocity[0] - first.linear - first.angular.cross(x);
    const Vector3d turned = answer.normalVelocity - second.angular.cross(n);
    most_.added = std::max(most_.added, std::abs(turned.dot(velocity) + n.dot(turn.cross(slide))));
    most_.speed = std::max(most_.speed, (velocity - n.dot(velocity) * n).norm());
    most_.turning = std::max(most_.turning, turn.cross(n).norm());
  }
}

}  // namespace fcl_stpbv::benchmark
