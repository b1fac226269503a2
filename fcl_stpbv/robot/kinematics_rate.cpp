// Time derivatives along a velocity of q. The twist of each link is the sum of the joints' twists from the
// root. A joint's own twist changes because the links above move it; that of a floating joint also because of
// the rate matrix of its rotation vector.
#include <cmath>

#include "fcl_stpbv/cross_matrix.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

using detail::at;
using detail::crossMatrix;

// Time derivative of a twist that is fixed to a body that moves with this velocity.
Twist carried(const Twist& velocity, const Twist& twist) {
  return {velocity.angular.cross(twist.linear) + velocity.linear.cross(twist.angular),
          velocity.angular.cross(twist.angular)};
}

void add(Twist& sum, double factor, const Twist& twist) {
  sum.linear += factor * twist.linear;
  sum.angular += factor * twist.angular;
}

// Change of the matrix I + b K + c K^2 while the rotation vector w moves by u. The matrix turns the rate of w
// into the angular velocity; b = (1 - cos)/angle^2, c = (angle - sin)/angle^3, K w = 0.
Matrix3d rateChange(const Vector3d& w, const Vector3d& u) {
  const double x = w.squaredNorm(), angle = std::sqrt(x);
  double b, c, bx, cx;  // bx, cx: derivatives with respect to the angle's square
  if (angle < 0.3) {    // the series' next terms are below 1e-15
    b = 1.0 / 2 - x / 24 * (1 - x / 30 * (1 - x / 56 * (1 - x / 90 * (1 - x / 132))));
    c = 1.0 / 6 - x / 120 * (1 - x / 42 * (1 - x / 72 * (1 - x / 110)));
    bx = -1.0 / 24 + x * (2.0 / 720 - x * (3.0 / 40320 - x * (4.0 / 3628800 - x * 5.0 / 479001600)));
    cx = -1.0 / 120 + x * (2.0 / 5040 - x * (3.0 / 362880 - x * (4.0 / 39916800 - x * 5.0 / 6227020800)));
  } else {
    const double a = std::sin(angle) / angle;
    b = (1 - std::cos(angle)) / x;
    c = (1 - a) / x;
    bx = (a - 2 * b) / (2 * x);
    cx = (b - 3 * c) / (2 * x);
  }
  const Matrix3d k = crossMatrix(w), ku = crossMatrix(u);
  const double change = 2 * w.dot(u);
  return b * ku + c * (k * ku + ku * k) + change * (bx * k + cx * k * k);
}

}  // namespace

Kinematics::Rate Kinematics::makeRate() const {
  return {std::vector<Twist>(robot_->links.size()), std::vector<Twist>(motions_.size()),
          std::vector<Twist>(robot_->links.size())};
}

void Kinematics::differentiate(const Eigen::Ref<const Eigen::VectorXd>& q,
                               const Eigen::Ref<const Eigen::VectorXd>& v, const State& state, Rate& rate,
                               const Subtree& only) const {
  if (stepOf_[0] < 0) rate.link[0] = rate.drift[0] = {};
  for (const int s : only.steps_) differentiate(steps_[at(s)], q, v, state, rate);
}

// Each motion's axis is carried by the parent link and by the motions of the same joint before it.
void Kinematics::differentiate(const Step& step, const Eigen::Ref<const Eigen::VectorXd>& q,
                               const Eigen::Ref<const Eigen::VectorXd>& v, const State& state,
                               Rate& rate) const {
  Twist velocity = step.parent < 0 ? Twist{} : rate.link[at(step.parent)];
  Twist drift = step.parent < 0 ? Twist{} : rate.drift[at(step.parent)];
  if (step.type == JointType::floating) {
    const Twist* twist = &state.motion[at(step.motion)];
    Twist* change = &rate.motion[at(step.motion)];
    for (int k = 0; k < 3; ++k) change[k] = carried(velocity, twist[k]);
    for (int k = 0; k < 3; ++k) add(velocity, v[step.coordinate + k], twist[k]);
    const Vector3d position = state.link[at(step.child)].translation();
    Matrix3d frame;
    for (int k = 0; k < 3; ++k) frame.col(k) = twist[k].linear;
    const Matrix3d turn =
        frame * rateChange(q.segment<3>(step.coordinate + 3), v.segment<3>(step.coordinate + 3));
    for (int k = 3; k < 6; ++k) {
      change[k] = carried(velocity, twist[k]);
      add(change[k], 1, {position.cross(turn.col(k - 3)), turn.col(k - 3)});
    }
    for (int k = 3; k < 6; ++k) add(velocity, v[step.coordinate + k], twist[k]);
    for (int k = 0; k < 6; ++k) add(drift, v[step.coordinate + k], change[k]);
  } else if (step.type != JointType::fixed) {
    const int freedoms = step.type == JointType::planar ? 3 : 1;
    for (int k = 0; k < freedoms; ++k) {
      const Twist& twist = state.motion[at(step.motion + k)];
      rate.motion[at(step.motion + k)] = carried(velocity, twist);
      add(velocity, v[step.coordinate + k], twist);
      add(drift, v[step.coordinate + k], rate.motion[at(step.motion + k)]);
    }
  }
  rate.link[at(step.child)] = velocity;
  rate.drift[at(step.child)] = drift;
}

}  // namespace fcl_stpbv
