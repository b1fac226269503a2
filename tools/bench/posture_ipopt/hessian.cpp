// A function of a link's pose has a slope by the link's twist. Its second derivative by q_i and q_j is the
// slope's change along the twist of q_i, times the twist of q_j, plus the slope times the change of the twist
// of q_j as q_i moves.
#include "tools/bench/posture_ipopt/hessian.h"

#include <cmath>

#include "fcl_stpbv/cross_matrix.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/twist.h"

namespace fcl_stpbv::benchmark {
namespace {

using detail::at;
using detail::crossMatrix;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// The distances of setUp(), in an object of their own.
CollisionConstraints distancesOf(const PostureSetup& setup, const PostureTask& task,
                                 const PostureScene& scene, double influence) {
  const double from = std::max(0.0, task.collisionMargin);
  ConstraintOptions options;
  options.influence = from + influence;
  options.exactUpTo = from + influence / 2;
  options.obstacles = scene.obstacles;
  return {setup.problem->sharedKinematics(), scene.geometry, setup.pairs, options};
}

// The rate of a rotation's error, and how it changes with each component of the angular velocity.
struct Rotation {
  Matrix3d rate;
  std::array<Matrix3d, 3> change;
};

// The rate is (1 - K/2 + c K^2) times the target's inverse, where K w = e x w for the rotation vector e.
Rotation fullRotation(const Matrix3d& relative, const Matrix3d& toTarget) {
  const Eigen::AngleAxisd turn(relative);
  const Vector3d e = turn.angle() * turn.axis();
  const double x = e.squaredNorm(), angle = std::sqrt(x);
  double c, slope;     // slope: derivative of c by the angle's square
  if (angle < 1e-2) {  // the series' next terms are below 1e-13
    c = 1.0 / 12 + x / 720 * (1 + x / 42);
    slope = 1.0 / 720 + x / 15120 * (1 + x * 3 / 80);
  } else {
    const double cotangent = 1 / std::tan(angle / 2), sine = std::sin(angle / 2);
    c = (1 - angle / 2 * cotangent) / x;
    slope = (1 / (8 * sine * sine) - cotangent / (4 * angle) - c) / x;
  }
  const Matrix3d k = crossMatrix(e);
  Rotation rotation{(Matrix3d::Identity() - k / 2 + c * k * k) * toTarget, {}};
  for (int i = 0; i < 3; ++i) {
    const Vector3d rate = rotation.rate.col(i);
    const Matrix3d ki = crossMatrix(rate);
    rotation.change[at(i)] = (-ki / 2 + c * (ki * k + k * ki) + 2 * slope * e.dot(rate) * k * k) * toTarget;
  }
  return rotation;
}

// The error is g times axis x tilted, where g is angle / sine as a function of the cosine.
Rotation tilt(const Vector3d& axis, const Vector3d& tilted, const Matrix3d& toTarget) {
  const Vector3d turn = axis.cross(tilted);
  const double cosine = axis.dot(tilted), sine = turn.norm(), u = 1 - cosine;
  double g, slope, bend;         // and its derivatives
  if (u < 5e-5 && cosine > 0) {  // the series' next terms are below 1e-12
    g = 1 + u / 3 * (1 + u * 2 / 5 * (1 + u * 3 / 7));
    slope = -1.0 / 3 - u * 4 / 15 - u * u * 6 / 35;
    bend = 4.0 / 15 + u * 12 / 35 + u * u * 32 / 105;
  } else {
    g = std::atan2(sine, cosine) / sine;
    slope = (cosine * g - 1) / (sine * sine);
    bend = (g + 3 * cosine * slope) / (sine * sine);
  }
  const Matrix3d tiltedRate = -crossMatrix(tilted) * toTarget, turnRate = crossMatrix(axis) * tiltedRate;
  const Eigen::RowVector3d cosineRate = axis.transpose() * tiltedRate;
  Rotation rotation{g * turnRate + slope * turn * cosineRate, {}};
  for (int i = 0; i < 3; ++i) {
    const Matrix3d tiltedChange = -crossMatrix(tiltedRate.col(i)) * toTarget;
    rotation.change[at(i)] = slope * cosineRate[i] * turnRate + g * crossMatrix(axis) * tiltedChange +
                             (bend * cosineRate[i] * turn + slope * turnRate.col(i)) * cosineRate +
                             slope * turn * (axis.transpose() * tiltedChange);
  }
  return rotation;
}

Twist unitTwist(int k) {
  Twist twist;
  (k < 3 ? twist.linear[k] : twist.angular[k - 3]) = 1;
  return twist;
}

}  // namespace

PostureHessian::PostureHessian(const PostureSetup& setup, const PostureTask& task, const PostureScene& scene,
                               double influence)
    : kinematics_(setup.problem->sharedKinematics()),
      world_(task.toWorld),
      distances_(distancesOf(setup, task, scene, influence)),
      ofDistances_(distances_.makeHessian()),
      state_(kinematics_->makeState()),
      along_(at(kinematics_->size()), kinematics_->makeRate()) {
  for (const PostureTask::Place& place : task.placements) {
    placements_.push_back(place.placement);
    placements_.back().link = scene.robot->link(place.link);
  }
  for (const PostureTask::Touch& touch : task.contacts) {
    links_.push_back(scene.robot->link(touch.link));
    patches_.emplace_back(touch.points, task.stabilityMargin);
  }
  if (!links_.empty()) centre_ = std::make_unique<CentreOfMass>(*kinematics_);
  for (std::size_t link = 0; link < scene.robot->links.size(); ++link)
    carriers_.push_back(kinematics_->dependence(static_cast<int>(link)));
}

void PostureHessian::evaluate(const VectorXd& x, const VectorXd& equal, const VectorXd& atLeast,
                              MatrixXd& lower) {
  const int n = kinematics_->size();
  const VectorXd q = x.head(n);
  lower.setZero(x.size(), x.size());
  kinematics_->forward(q, state_);
  for (int i = 0; i < n; ++i) kinematics_->differentiate(q, VectorXd::Unit(n, i), state_, along_[at(i)]);
  int row = 0;
  for (const Placement& placement : placements_) {
    Vector3d position = Vector3d::Zero(), rotation = Vector3d::Zero();
    for (int k = 0; k < 6; ++k)
      if (!placement.free[at(k)]) (k < 3 ? position[k] : rotation[k - 3]) = equal[row++];
    LinkTerm term;
    addPosition(state_.link[at(placement.link)] * placement.frame.translation(),
                placement.target.linear() * position, term);
    addRotation(placement, rotation, term);
    add(placement.link, term, lower);
  }
  if (!links_.empty()) addStability(x, equal.segment<3>(row), lower);
  int room = 0;
  for (std::size_t c = 0; c < links_.size(); room += patches_[c++].rooms())
    addContact(
        c,
        [&](const detail::SupportPatch& patch, const Twist& twist) {
          double slope = 0;
          for (int k = 0; k < patch.rooms(); ++k) slope += atLeast[room + k] * patch.roomRate(k, twist);
          return slope;
        },
        lower);
  distances_.hessian(q, atLeast.tail(distances_.rows()), ofDistances_);
  lower.topLeftCorner(n, n) += ofDistances_;
}

void PostureHessian::addPosition(const Vector3d& point, const Vector3d& weight, LinkTerm& term) {
  term.slope.head<3>() += weight;
  term.slope.tail<3>() += point.cross(weight);
  term.change.topRightCorner<3, 3>() += crossMatrix(weight);
  term.change.bottomRightCorner<3, 3>() +=
      weight * point.transpose() - point.dot(weight) * Matrix3d::Identity();
}

void PostureHessian::addRotation(const Placement& placement, const Vector3d& weight, LinkTerm& term) const {
  const auto isFree = [&](int k) { return placement.free[at(k + 3)]; };
  if (isFree(0) && isFree(1) && isFree(2)) return;
  const Matrix3d toTarget = placement.target.linear().transpose();
  const Matrix3d relative = toTarget * state_.link[at(placement.link)].linear() * placement.frame.linear();
  const int axis = isFree(0) ? 0 : isFree(1) ? 1 : isFree(2) ? 2 : -1;
  const Rotation rotation =
      axis < 0 ? fullRotation(relative, toTarget) : tilt(Vector3d::Unit(axis), relative.col(axis), toTarget);
  term.slope.tail<3>() += rotation.rate.transpose() * weight;
  for (int i = 0; i < 3; ++i) term.change.row(i + 3).tail<3>() += weight.transpose() * rotation.change[at(i)];
}

// Which edges a contact's corners and room depend on changes with its tilt. So their second derivatives are
// central differences of slope(patch, twist), accurate to about 1e-10.
template <class Slope>
void PostureHessian::addContact(std::size_t contact, const Slope& slope, MatrixXd& lower) {
  constexpr double kStep = 1e-5;  // m, rad
  detail::SupportPatch& patch = patches_[contact];
  const Eigen::Isometry3d& pose = state_.link[at(links_[contact])];
  const auto slopeAt = [&](const Eigen::Isometry3d& moved) {
    patch.place(moved, world_);
    Vector6 all;
    for (int k = 0; k < 6; ++k) all[k] = slope(patch, unitTwist(k));
    return all;
  };
  LinkTerm term;
  for (int k = 0; k < 6; ++k) {
    const Twist step = unitTwist(k);
    Eigen::Isometry3d move(Eigen::AngleAxisd(kStep * step.angular.norm(), Vector3d::Unit(k % 3)));
    move.translation() = kStep * step.linear;
    term.change.row(k) = (slopeAt(move * pose) - slopeAt(move.inverse() * pose)) / (2 * kStep);
  }
  term.slope = slopeAt(pose);
  add(links_[contact], term, lower);
}

void PostureHessian::addStability(const VectorXd& x, const Vector3d& weight, MatrixXd& lower) {
  const int n = kinematics_->size();
  const Vector3d pull = world_.transpose() * Vector3d(weight.x(), weight.y(), 0);
  Eigen::Matrix3Xd ofCentre(3, n);
  centre_->evaluate(state_, ofCentre);
  int first = n;  // index of the contact's first share
  for (std::size_t c = 0; c < links_.size(); first += patches_[c++].corners()) {
    const auto rate = [&](const detail::SupportPatch& patch, int corner, const Twist& twist) {
      return -weight.head<2>().dot(patch.cornerRate(corner, twist));
    };
    addContact(
        c,
        [&](const detail::SupportPatch& patch, const Twist& twist) {
          double slope = 0;
          for (int k = 0; k < patch.corners(); ++k) slope += x[first + k] * rate(patch, k, twist);
          return slope;
        },
        lower);
    for (int k = 0; k < patches_[c].corners(); ++k) {
      lower.row(first + k).head(n) += pull.transpose() * ofCentre;
      for (const Kinematics::Dependence& d : carriers_[at(links_[c])])
        lower(first + k, kinematics_->motions()[at(d.motion)].coordinate) +=
            rate(patches_[c], k, state_.motion[at(d.motion)]);
    }
  }
  const Vector3d perMass = x.tail(x.size() - n).sum() / centre_->mass() * pull;
  for (std::size_t link = 0; link < carriers_.size(); ++link) {
    const LinkModel& model = kinematics_->robot().links[link];
    LinkTerm term;
    addPosition(state_.link[link] * model.centreOfMass, model.mass * perMass, term);
    add(static_cast<int>(link), term, lower);
  }
}

void PostureHessian::add(int link, const LinkTerm& term, MatrixXd& lower) const {
  const auto coordinate = [&](const Kinematics::Dependence& d) {
    return kinematics_->motions()[at(d.motion)].coordinate;
  };
  for (const Kinematics::Dependence& a : carriers_[at(link)]) {
    const int i = coordinate(a);
    const Vector6 changed = term.change.transpose() * detail::stacked(state_.motion[at(a.motion)]);
    for (const Kinematics::Dependence& b : carriers_[at(link)]) {
      const int j = coordinate(b);
      if (j < i) continue;
      lower(j, i) += changed.dot(detail::stacked(state_.motion[at(b.motion)])) +
                     term.slope.dot(detail::stacked(along_[at(i)].motion[at(b.motion)]));
    }
  }
}

}  // namespace fcl_stpbv::benchmark
