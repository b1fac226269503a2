// A frame of a link at a target. Errors are the position in the target's axes and the rotation vector from
// target to frame; with one free rotation, the rotation vector that tilts the axes together. Derivatives use
// the inverse of the rotation vector's rate matrix.
#include <cmath>

#include "fcl_stpbv/cross_matrix.h"
#include "fcl_stpbv/error.h"
#include "fcl_stpbv/posture/task.h"
#include "fcl_stpbv/robot/link_check.h"

namespace fcl_stpbv {
namespace {

using detail::crossMatrix;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Rotation vector of a rotation, at most half a turn.
Vector3d logarithm(const Matrix3d& rotation) {
  const Eigen::Quaterniond q(rotation);  // |q| = 1 to rounding, any sign
  const double sine = q.vec().norm(), sign = q.w() < 0 ? -1 : 1;
  const double angle = 2 * std::atan2(sine, std::abs(q.w()));
  return (sine > 0 ? sign * angle / sine : 2.0) * q.vec();
}

// The matrix that turns the angular velocity, in fixed axes, into the rate of the rotation vector e.
Matrix3d inverseRate(const Vector3d& e) {
  const double angle2 = e.squaredNorm(), angle = std::sqrt(angle2);
  // 1/t^2 - cot(t/2)/(2t); the series' next term is below 1e-15
  const double c = angle < 1e-2 ? 1.0 / 12 + angle2 / 720 * (1 + angle2 / 42)
                                : (1 - angle / 2 / std::tan(angle / 2)) / angle2;
  const Matrix3d k = crossMatrix(e);
  return Matrix3d::Identity() - k / 2 + c * k * k;
}

// angle / sin(angle), and its derivative by the cosine.
void angleBySine(double cosine, double sine, double& g, double& slope) {
  const double angle = std::atan2(sine, cosine);
  if (cosine > 0 && sine < 1e-2) {  // series in the sine; the next terms are below 1e-15
    const double s2 = sine * sine;
    g = 1 + s2 / 6 * (1 + s2 * 9 / 20 * (1 + s2 * 25 / 42));
    slope = -(1.0 / 3 + s2 * 3 / 10 * (1 + s2 * 25 / 28)) * cosine;
    return;
  }
  g = angle / sine;
  slope = (cosine * g - 1) / (sine * sine);
}

}  // namespace

PlacementRows::PlacementRows(const Kinematics& kinematics, Placement placement)
    : placement_(std::move(placement)) {
  int turns = 0;
  for (int k = 0; k < 6; ++k) {
    const bool isFree = placement_.free[static_cast<std::size_t>(k)];
    if (k >= 3 && isFree) {
      ++turns;
      freeAxis_ = k - 3;
    }
    if (!isFree) rows_.push_back(k);
  }
  if (turns == 2)
    throw Error("placement '" + placement_.name + "': two rotations are free; free one of them or all three");
  if (turns != 1) freeAxis_ = -1;
  detail::requireLink("placement '" + placement_.name + "'", placement_.link, kinematics.robot());
  for (const Kinematics::Dependence& d : kinematics.dependence(placement_.link)) {
    const std::size_t motion = static_cast<std::size_t>(d.motion);
    carriers_.push_back({motion, kinematics.motions()[motion].coordinate});
  }
}

std::string PlacementRows::name(int row) const {
  static const char* const kDirections[] = {"x", "y", "z", "rx", "ry", "rz"};
  return placement_.name + " " + kDirections[rows_[static_cast<std::size_t>(row)]];
}

void PlacementRows::rotation(const Matrix3d& frame, Vector3d& error, Matrix3d& rate) const {
  const Matrix3d& target = placement_.target.linear();
  const Matrix3d relative = target.transpose() * frame;
  if (freeAxis_ < 0) {
    error = logarithm(relative);
    rate = inverseRate(error) * target.transpose();
    return;
  }
  const Vector3d axis = Vector3d::Unit(freeAxis_), tilted = relative.col(freeAxis_);
  Vector3d turn = axis.cross(tilted);
  // Nearer to half a turn than this, the axis of the rotation is arbitrary. It is fixed, so that the rate
  // stays finite.
  constexpr double kHalfTurn = 1e-6;
  if (axis.dot(tilted) < 0 && turn.norm() < kHalfTurn) turn = kHalfTurn * Vector3d::Unit((freeAxis_ + 1) % 3);
  const double cosine = axis.dot(tilted);
  double g, slope;
  angleBySine(cosine, turn.norm(), g, slope);
  error = g * turn;
  const Matrix3d tiltedRate = -crossMatrix(tilted) * target.transpose();  // tilted changes by w x tilted
  rate = g * crossMatrix(axis) * tiltedRate + slope * turn * (axis.transpose() * tiltedRate);
}

void PlacementRows::evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values,
                             Eigen::Ref<RowMatrix> jacobian) {
  const Eigen::Isometry3d pose = at.state.link[static_cast<std::size_t>(placement_.link)] * placement_.frame;
  const Matrix3d toTarget = placement_.target.linear().transpose();
  const Vector3d position = toTarget * (pose.translation() - placement_.target.translation());
  Vector3d error;
  Matrix3d rate;
  rotation(pose.linear(), error, rate);
  for (int row = 0; row < size(); ++row) {
    const int k = rows_[static_cast<std::size_t>(row)];
    values[row] = k < 3 ? position[k] : error[k - 3];
  }
  for (const Carrier& carrier : carriers_) {
    const Twist& twist = at.state.motion[carrier.motion];
    const Vector3d linear = toTarget * (twist.linear + twist.angular.cross(pose.translation()));
    const Vector3d angular = rate * twist.angular;
    for (int row = 0; row < size(); ++row) {
      const int k = rows_[static_cast<std::size_t>(row)];
      jacobian(row, carrier.coordinate) += k < 3 ? linear[k] : angular[k - 3];
    }
  }
}

}  // namespace fcl_stpbv
