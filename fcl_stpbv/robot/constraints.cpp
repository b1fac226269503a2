// See constraints.h.
#include "fcl_stpbv/robot/constraints.h"

#include <algorithm>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

CollisionConstraints::CollisionConstraints(std::shared_ptr<const Kinematics> kinematics,
                                           std::shared_ptr<const RobotGeometry> geometry,
                                           std::vector<CheckedPair> pairs, ConstraintOptions options)
    : kinematics_(std::move(kinematics)),
      geometry_(std::move(geometry)),
      pairs_(std::move(pairs)),
      options_(std::move(options)),
      state_(kinematics_->makeState()),
      pose_(geometry_->bodies.size(), Eigen::Isometry3d::Identity()),
      centre_(geometry_->bodies.size(), Eigen::Vector3d::Zero()) {
  if (!(options_.influence > 0)) throw Error("CollisionConstraints: influence must be larger than 0");
  if (options_.exactUpTo < 0) options_.exactUpTo = options_.influence / 2;
  if (options_.exactUpTo > options_.influence)
    throw Error("CollisionConstraints: exactUpTo must not exceed influence");
  leaveOutReplaced();
  for (const CheckedPair& pair : pairs_) addPair(pair);
  for (const SmoothConstraint& constraint : options_.smooth) addSmooth(constraint);
  caches_.resize(pairs_.size());
  answers_.resize(pairs_.size());
  values_.resize(nonZeros());
  otherValues_.resize(nonZeros());
  scratch_.resize(rows());
  moved_.resize(columns());
  pool_ = std::make_unique<WorkerPool>(std::max(1, options_.threads));
}

void CollisionConstraints::leaveOutReplaced() {
  const RobotModel& robot = kinematics_->robot();
  for (const SmoothConstraint& constraint : options_.smooth) {
    for (const auto& [name1, name2] : constraint.replaces) {
      const int link1 = robot.link(name1), link2 = robot.link(name2);
      if (link1 < 0 || link2 < 0)
        throw Error("CollisionConstraints: '" + constraint.name + "' replaces the pair " + name1 + ", " +
                    name2 + ", but the robot has no such links");
      const auto replaced = [&, l1 = link1, l2 = link2](const CheckedPair& pair) {
        if (pair.obstacle) return false;
        const int a = geometry_->bodies.at(at(pair.body)).link, b = geometry_->bodies.at(at(pair.other)).link;
        return (a == l1 && b == l2) || (a == l2 && b == l1);
      };
      pairs_.erase(std::remove_if(pairs_.begin(), pairs_.end(), replaced), pairs_.end());
    }
  }
}

void CollisionConstraints::addPair(const CheckedPair& pair) {
  const std::size_t others = pair.obstacle ? options_.obstacles.size() : geometry_->bodies.size();
  if (pair.body < 0 || at(pair.body) >= geometry_->bodies.size() || pair.other < 0 ||
      at(pair.other) >= others)
    throw Error("CollisionConstraints: a pair names a body or an obstacle that does not exist");
  const Body& body = geometry_->bodies[at(pair.body)];
  std::vector<Kinematics::Dependence> list;
  double reach = body.radius;
  if (pair.obstacle) {
    list = kinematics_->dependence(body.link);
    for (Kinematics::Dependence& d : list) d.sign = -1;
    reach += options_.obstacles[at(pair.other)].radius;
  } else {
    const Body& other = geometry_->bodies[at(pair.other)];
    list = kinematics_->dependence(body.link, other.link);
    reach += other.radius;
  }
  std::vector<int> columns;
  for (const Kinematics::Dependence& d : list)
    columns.push_back(kinematics_->motions()[at(d.motion)].coordinate);
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  const int first = static_cast<int>(terms_.size());
  for (const Kinematics::Dependence& d : list) {
    const int coordinate = kinematics_->motions()[at(d.motion)].coordinate;
    const auto slot = std::lower_bound(columns.begin(), columns.end(), coordinate) - columns.begin();
    terms_.push_back({d.motion, d.sign, rowStart_.back() + static_cast<int>(slot)});
  }
  rows_.push_back({first, static_cast<int>(terms_.size()), reach});
  column_.insert(column_.end(), columns.begin(), columns.end());
  rowStart_.push_back(nonZeros());
}

void CollisionConstraints::addSmooth(const SmoothConstraint& constraint) {
  const std::vector<int>& list = constraint.coordinates;
  const bool ascending =
      std::adjacent_find(list.begin(), list.end(), std::greater_equal<int>()) == list.end();
  if (!constraint.value || !ascending || (!list.empty() && (list.front() < 0 || list.back() >= columns())))
    throw Error("CollisionConstraints: '" + constraint.name +
                "' needs a function and existing coordinates in ascending order");
  column_.insert(column_.end(), list.begin(), list.end());
  rowStart_.push_back(nonZeros());
}

std::string CollisionConstraints::name(int row) const {
  if (at(row) >= pairs_.size()) return options_.smooth[at(row) - pairs_.size()].name;
  const CheckedPair& pair = pairs_[at(row)];
  return geometry_->bodies[at(pair.body)].name + " - " +
         (pair.obstacle ? options_.obstacles[at(pair.other)].name : geometry_->bodies[at(pair.other)].name);
}

CollisionConstraints::SparseJacobian CollisionConstraints::makeJacobian() const {
  const std::vector<double> zeros(column_.size(), 0.0);
  return Eigen::Map<const SparseJacobian>(rows(), columns(), nonZeros(), rowStart_.data(), column_.data(),
                                          zeros.data());
}

void CollisionConstraints::forget() { std::fill(caches_.begin(), caches_.end(), PairCache{}); }

double CollisionConstraints::bend(double d, double& slope) const {
  const double start = options_.exactUpTo, width = options_.influence - start;
  slope = 1;
  if (!(d > start)) return d;
  const double t = std::min(1.0, (d - start) / width);
  slope = 1 - t * t * (3 - 2 * t);
  return start + width * (t - t * t * t * (1 - t / 2));
}

double CollisionConstraints::pairRow(std::size_t row, double* values) {
  const CheckedPair& pair = pairs_[row];
  const std::size_t a = at(pair.body), b = at(pair.other);
  const Obstacle* obstacle = pair.obstacle ? &options_.obstacles[b] : nullptr;
  const Eigen::Vector3d& centre = obstacle ? obstacle->centre : centre_[b];
  if (values) std::fill(values + rowStart_[row], values + rowStart_[row + 1], 0.0);
  answers_[row].status = DistanceStatus::invalid;
  const double far = options_.influence + rows_[row].reach;
  if ((centre - centre_[a]).squaredNorm() >= far * far) return (options_.influence + options_.exactUpTo) / 2;

  DistanceAnswer& answer = answers_[row];
  answer = distance(*geometry_->bodies[a].geometry, pose_[a],
                    obstacle ? *obstacle->geometry : *geometry_->bodies[b].geometry,
                    obstacle ? obstacle->pose : pose_[b], {&caches_[row], nullptr});
  double slope = 1;
  const double value = options_.influence < std::numeric_limits<double>::infinity()
                           ? bend(answer.distance, slope)
                           : answer.distance;
  if (!values) return value;
  // The velocity of x along n is n.v + (x cross n).w for a motion (v, w).
  const Eigen::Vector3d n = slope * answer.normal;
  const Eigen::Vector3d moment[2] = {answer.points[0].cross(n), answer.points[1].cross(n)};
  for (int t = rows_[row].firstTerm; t < rows_[row].lastTerm; ++t) {
    const Term& term = terms_[at(t)];
    const Twist& motion = state_.motion[at(term.motion)];
    values[term.slot] +=
        term.sign * (n.dot(motion.linear) + moment[term.sign < 0 ? 0 : 1].dot(motion.angular));
  }
  return value;
}

void CollisionConstraints::compute(const ConstVector& q, double* d, double* values) {
  kinematics_->forward(q, state_);
  for (std::size_t i = 0; i < pose_.size(); ++i) {
    const Body& body = geometry_->bodies[i];
    pose_[i] = state_.link[at(body.link)] * body.pose;
    centre_[i] = state_.link[at(body.link)] * body.centre;
  }
  auto work = [&](int k) {  // every n-th row, so that far and near ones are shared out
    const std::size_t step = at(pool_->threads());
    for (std::size_t row = at(k); row < pairs_.size(); row += step) d[row] = pairRow(row, values);
  };
  pool_->run(work);
  for (std::size_t i = 0; i < options_.smooth.size(); ++i) {
    const std::size_t row = pairs_.size() + i;
    d[row] = options_.smooth[i].value(q, values ? values + rowStart_[row] : nullptr);
  }
}

void CollisionConstraints::evaluate(const ConstVector& q, Vector d) { compute(q, d.data(), nullptr); }

void CollisionConstraints::evaluateValues(const ConstVector& q, Vector d, Vector values) {
  compute(q, d.data(), values.data());
}

void CollisionConstraints::evaluate(const ConstVector& q, Vector d, SparseJacobian& jacobian) {
  compute(q, d.data(), jacobian.valuePtr());
}

void CollisionConstraints::evaluate(const ConstVector& q, Vector d, Eigen::Ref<Eigen::MatrixXd> jacobian) {
  compute(q, d.data(), values_.data());
  jacobian.setZero();
  for (int row = 0; row < rows(); ++row)
    for (int k = rowStart_[at(row)]; k < rowStart_[at(row) + 1]; ++k)
      jacobian(row, column_[at(k)]) = values_[k];
}

void CollisionConstraints::hessianVector(const ConstVector& q, const ConstVector& weights,
                                         const ConstVector& v, Vector out) {
  // Rounding in J divided by the step and what the step misses of a seam are then about equal.
  constexpr double kStep = 1e-6;
  moved_ = q + kStep * v;
  compute(moved_, scratch_.data(), values_.data());
  moved_ = q - kStep * v;
  compute(moved_, scratch_.data(), otherValues_.data());
  out.setZero();
  for (int row = 0; row < rows(); ++row) {
    for (int k = rowStart_[at(row)]; k < rowStart_[at(row) + 1]; ++k)
      out[column_[at(k)]] += weights[row] * (values_[k] - otherValues_[k]) / (2 * kStep);
  }
}

}  // namespace fcl_stpbv
