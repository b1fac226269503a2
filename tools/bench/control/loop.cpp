// One tick of the controller:
// 1. The hands' paths become least squares in the joints' velocities.
// 2. Collision rows come from the library's velocity damper, or from pairs of features.
// 3. The program is solved within the joints' largest speed.
// 4. The joints' commands are measured. True distances are those of the hulls.
#include "tools/bench/control/loop.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <random>
#include <set>

#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/velocity_damper.h"
#include "tools/bench/control/manifold.h"
#include "tools/bench/control/program.h"
#include "tools/bench/measurement.h"

namespace fcl_stpbv::benchmark {
namespace {

using Eigen::Isometry3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

using detail::at;

DamperOptions damperOf(const Method& m) {
  DamperOptions options;
  options.all = {kInfluence + margins(m), kSecurity + margins(m), kDamping};
  return options;
}

/// One run.
class Controller {
 public:
  Controller(const Scene& scene, const Method& method, const LoopOptions& options)
      : scene_(scene),
        method_(method),
        options_(options),
        size_(static_cast<int>(scene.joints.size())),
        constraints_(constraintsOf(scene, method)),
        truth_(constraintsOf(scene, {Model::hull, 0, 0, ""})),
        state_(scene.kinematics->makeState()) {
    if (constraints_ && method.model != Model::manifold) damper_.emplace(*constraints_, damperOf(method));
    if (options.contacts && damper_) contacts_.emplace(scene, method, kInfluence + margins(method));
  }

  Outcome go() {
    VectorXd q = scene_.start, read = q, qd = VectorXd::Zero(size_), change = qd,
             gain = VectorXd::Ones(size_);
    std::mt19937 random(7);
    if (options_.noise)
      for (double& g : gain) g += kModelError * (2.0 * static_cast<double>(random()) / 4294967295.0 - 1);
    const int ticks = static_cast<int>(options_.duration / kTick);
    for (int k = 0; k < ticks; ++k) {
      const double time = k * kTick;
      const VectorXd now = q;
      if (!options_.noise) read = q;
      const auto start = std::chrono::steady_clock::now();
      const VectorXd next = command(read, qd, time);
      spent_.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() * 1e6);
      const VectorXd difference = next - qd;
      if (time > scene_.begin) measure(now, difference, change);
      if (contacts_ && time > scene_.begin) contacts_->measure(now, spread(now.size(), next));
      change = difference;
      qd = next;
      if (options_.noise)  // read at the next tick; the true value is that of this tick
        for (int j : scene_.joints) read[j] = kEncoderStep * std::round(now[j] / kEncoderStep);
      for (int j = 0; j < size_; ++j) q[scene_.joints[at(j)]] += kTick * gain[j] * qd[j];
    }
    return result();
  }

 private:
  /// Puts the moved joints' velocities into a vector of all coordinates.
  VectorXd spread(Eigen::Index size, const VectorXd& qd) const {
    VectorXd all = VectorXd::Zero(size);
    for (int j = 0; j < size_; ++j) all[scene_.joints[at(j)]] = qd[j];
    return all;
  }

  void jacobian(int link, const Vector3d& x, MatrixXd& linear, MatrixXd& angular) const {
    linear.setZero(3, size_);
    angular.setZero(3, size_);
    if (link < 0) return;
    for (const Kinematics::Dependence& d : scene_.kinematics->dependence(link)) {
      const int coordinate = scene_.kinematics->motions()[at(d.motion)].coordinate;
      const auto found = std::find(scene_.joints.begin(), scene_.joints.end(), coordinate);
      if (found == scene_.joints.end()) continue;
      const Twist& motion = state_.motion[at(d.motion)];
      linear.col(found - scene_.joints.begin()) += motion.linear + motion.angular.cross(x);
      angular.col(found - scene_.joints.begin()) += motion.angular;
    }
  }

  /// Adds a hand's path to the program: proportional to its error, at most 0.3 m/s.
  void follow(const Hand& hand, double time, const VectorXd& qd, MatrixXd& H, VectorXd& f) {
    constexpr double kGain = 5, kRotation = 0.02, kVelocityGain = 20;  // 1/s, m^2/rad^2, 1/s
    const Isometry3d &is = state_.link[at(hand.link)], wanted = scene_.target(hand, time);
    const Vector3d error = wanted.translation() - is.translation();
    const Eigen::AngleAxisd turn(wanted.linear() * is.linear().transpose());
    Vector3d v = kGain * error, w = kGain * turn.angle() * turn.axis();
    if (v.norm() > 0.3) v *= 0.3 / v.norm();
    MatrixXd linear, angular;
    jacobian(hand.link, is.translation(), linear, angular);
    if (options_.acceleration) {  // desired velocity one tick later
      v = linear * qd + kVelocityGain * kTick * (v - linear * qd);
      w = angular * qd + kVelocityGain * kTick * (w - angular * qd);
    }
    H += linear.transpose() * linear + kRotation * angular.transpose() * angular;
    f += linear.transpose() * v + kRotation * angular.transpose() * w;
    Vector3d off = error;
    const std::string& s = scene_.scenario;
    off[s == "shelf" ? 0 : s == "wall" || s == "boxes" || s == "arms" ? 1 : 2] = 0;
    error_ += off.norm();
  }

  void manifoldRows(std::vector<VectorXd>& rows, std::vector<double>& bounds) {
    std::vector<FeaturePair> features;
    for (std::size_t p = 0; p < scene_.pairs.size(); ++p) {
      const Solid &a = scene_.solids[at(scene_.pairs[p].first)],
                  &b = scene_.solids[at(scene_.pairs[p].second)];
      const auto poseOf = [&](const Solid& s) {
        return s.link < 0 ? s.pose : state_.link[at(s.link)] * s.pose;
      };
      features.clear();
      featurePairs(a, poseOf(a), b, poseOf(b), kInfluence + margins(method_), features);
      for (const FeaturePair& f : features) {
        MatrixXd first, second, unused;
        jacobian(a.link, f.first, first, unused);
        jacobian(b.link, f.second, second, unused);
        rows.push_back((second - first).transpose() * f.normal);
        bounds.push_back(-kDamping * (f.d - margins(method_) - kSecurity) / (kInfluence - kSecurity));
        keys_.push_back(static_cast<int>(p) * 100000 + f.key);
      }
    }
  }

  void damperRows(const VectorXd& q, const VectorXd& qd, std::vector<VectorXd>& rows,
                  std::vector<double>& bounds) {
    damper_->update(q, spread(q.size(), qd));
    for (int row : damper_->near()) {
      VectorXd entries = VectorXd::Zero(size_);
      for (CollisionConstraints::SparseJacobian::InnerIterator it(damper_->A(), row); it; ++it) {
        const auto found = std::find(scene_.joints.begin(), scene_.joints.end(), it.col());
        if (found != scene_.joints.end()) entries[found - scene_.joints.begin()] = it.value();
      }
      rows.push_back(entries);
      bounds.push_back(damper_->b()[row]);
      keys_.push_back(row);
    }
  }

  VectorXd command(const VectorXd& q, const VectorXd& qd, double time) {
    scene_.kinematics->forward(q, state_);
    // Regularisation and largest speed of the joints (m^2/rad^2, rad/s).
    constexpr double kRegular = 1e-3, kFastest = 2;
    MatrixXd H = kRegular * MatrixXd::Identity(size_, size_);
    VectorXd f = VectorXd::Zero(size_);
    if (options_.acceleration) f = 0.98 * kRegular * qd;  // slightly damps motions that no task determines
    error_ = 0;
    for (const Hand& hand : scene_.hands) follow(hand, time, qd, H, f);
    std::vector<VectorXd> rows;
    std::vector<double> bounds;
    keys_.clear();
    if (method_.model == Model::manifold) manifoldRows(rows, bounds);
    if (damper_) damperRows(q, qd, rows, bounds);
    const int near = static_cast<int>(rows.size());
    MatrixXd A(near + 2 * size_, size_);
    VectorXd b(near + 2 * size_), x;
    for (int i = 0; i < near; ++i) {
      A.row(i) = rows[at(i)];
      b[i] = bounds[at(i)];
    }
    A.middleRows(near, size_).setIdentity();
    A.bottomRows(size_) = -MatrixXd::Identity(size_, size_);
    b.tail(2 * size_).setConstant(-kFastest);
    failed_ += !program_.solve(H, f, A, b, x);
    acting_.clear();
    for (int i = 0; i < near; ++i)
      if (program_.multipliers()[at(i)] > 0) acting_.insert(keys_[at(i)]);
    return x;
  }

  void measure(const VectorXd& q, const VectorXd& difference, const VectorXd& before) {
    ++count_;
    out_.peak = std::max(out_.peak, difference.lpNorm<Eigen::Infinity>() / kTick);
    rms_ += difference.squaredNorm();
    jerk_ += (difference - before).squaredNorm();
    for (int j = 0; j < size_; ++j)
      reversals_ +=
          difference[j] * before[j] < 0 && std::min(std::abs(difference[j]), std::abs(before[j])) > 1 * kTick;
    std::vector<int> changed;
    std::set_symmetric_difference(acting_.begin(), acting_.end(), acted_.begin(), acted_.end(),
                                  std::back_inserter(changed));
    switches_ += static_cast<long>(changed.size());
    acted_ = acting_;
    tracking_ += error_;
    VectorXd d(truth_->rows());
    truth_->evaluate(q, d);
    clearance_ = std::min(clearance_, d.minCoeff());
  }

  Outcome result() {
    const double n = static_cast<double>(count_), seconds = n * kTick;
    out_.rms = std::sqrt(rms_ / n) / kTick;
    out_.jerk = std::sqrt(jerk_ / n) / (kTick * kTick);
    out_.reversals = static_cast<double>(reversals_) / seconds / size_;
    out_.switches = static_cast<double>(switches_) / seconds;
    out_.clearance = clearance_;
    out_.tracking = tracking_ / n;
    out_.solve = median(spent_);
    out_.failed = failed_;
    if (contacts_) out_.contact = contacts_->most();
    return out_;
  }

  const Scene& scene_;
  const Method& method_;
  const LoopOptions& options_;
  const int size_;
  std::unique_ptr<CollisionConstraints> constraints_, truth_;
  std::optional<VelocityDamper> damper_;
  std::optional<ContactMeter> contacts_;
  Kinematics::State state_;
  Program program_;
  std::vector<int> keys_;
  std::set<int> acting_, acted_;
  double error_ = 0, rms_ = 0, jerk_ = 0, tracking_ = 0, clearance_ = 1e9;
  long count_ = 0, reversals_ = 0, switches_ = 0, failed_ = 0;
  std::vector<double> spent_;
  Outcome out_;
};

}  // namespace

Outcome run(const Scene& scene, const Method& method, const LoopOptions& options) {
  return Controller(scene, method, options).go();
}

}  // namespace fcl_stpbv::benchmark
