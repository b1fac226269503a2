// All distances of a robot and their Jacobian at q:
// 1. compute the poses of the links that rows need and each joint's twist, once for all rows;
// 2. for each row: skip the pair if its bounding spheres prove that it is beyond the influence; otherwise
//    compute the distance, starting from its last answer;
// 3. the row of J is the gradient's product with the twists of the joints that move the pair (paper, eq. 2);
// 4. let the row change from d to a constant before the influence distance, with continuous second
//    derivatives.
#include "fcl_stpbv/robot/constraints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/twist.h"

namespace fcl_stpbv {
namespace {

using detail::at;

}  // namespace

CollisionConstraints::CollisionConstraints(std::shared_ptr<const Kinematics> kinematics,
                                           std::shared_ptr<const RobotGeometry> geometry,
                                           std::vector<CheckedPair> pairs, ConstraintOptions options)
    : kinematics_(std::move(kinematics)),
      geometry_(std::move(geometry)),
      pairs_(std::move(pairs)),
      options_(std::move(options)),
      state_(kinematics_->makeState()),
      rate_(kinematics_->makeRate()),
      pose_(geometry_->bodies.size(), Eigen::Isometry3d::Identity()),
      centre_(geometry_->bodies.size(), Eigen::Vector3d::Zero()) {
  if (!(options_.influence > 0)) throw Error("CollisionConstraints: influence must be larger than 0");
  if (std::isnan(options_.exactUpTo)) throw Error("CollisionConstraints: exactUpTo is not a number");
  const bool always = options_.influence == detail::kInfinity;
  if (options_.exactUpTo >= 0 && always)
    throw Error(
        "CollisionConstraints: exactUpTo needs an influence; without one a row is its distance everywhere");
  if (options_.exactUpTo < 0) options_.exactUpTo = options_.influence / 2;
  if (!always && options_.exactUpTo >= options_.influence)
    throw Error(
        "CollisionConstraints: exactUpTo must be less than influence; rows bend over between the two");
  if (!(options_.handOver > 0)) throw Error("CollisionConstraints: handOver must be larger than 0");
  for (const Obstacle& obstacle : options_.obstacles) {
    pose_.push_back(obstacle.pose());
    centre_.push_back(obstacle.centre());
  }
  for (const CheckedPair& pair : pairs_)
    requireBodies(pair, *geometry_, options_.obstacles.size(), "CollisionConstraints");
  leaveOutReplaced();
  addWholePairs();
  for (const CheckedPair& pair : pairs_) addPair(pair);
  const detail::PairedBodies paired = detail::pairedBodies(pairs_, *geometry_);
  placed_ = paired.bodies;
  placing_ = kinematics_->subtree(paired.links);
  for (const SmoothConstraint& constraint : options_.smooth) addSmooth(constraint);
  caches_.resize(pairs_.size());
  found_.resize(pairs_.size());
  answers_.resize(pairs_.size());
  moves_.resize(pairs_.size());
  open_.resize(at(rows()));
  values_.resize(nonZeros());
  change_.resize(nonZeros());
  otherChange_.resize(nonZeros());
  moved_.resize(columns());
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
  const Body& body = geometry_->bodies[at(pair.body)];
  const StpBvGeometry* first = asStpBv(body.geometry.get());
  const StpBvGeometry* other = asStpBv(&second(pair));
  Row row;
  row.a = pair.body;
  row.b = pair.obstacle ? static_cast<int>(geometry_->bodies.size()) + pair.other : pair.other;
  row.far = options_.influence;
  row.start = options_.exactUpTo;
  row.end = options_.influence;
  row.group = groupOf_[rows_.size()];
  row.finite = hasFiniteCorners(*body.geometry) && hasFiniteCorners(second(pair));
  if (row.group >= 0) {
    row.whole = wholeRow_[at(row.group)] == rows_.size();
    row.start = std::min(options_.handOver / 2, options_.exactUpTo);
    row.end = std::min(options_.handOver, options_.influence);
    if (!row.whole) row.far = row.end;
  }
  if (first && other) {
    row.first = &first->volume();
    row.second = &other->volume();
  }
  row.far += body.radius + (pair.obstacle ? options_.obstacles[at(pair.other)].radius()
                                          : geometry_->bodies[at(pair.other)].radius);
  row.excess = body.volumeExcess + (pair.obstacle ? options_.obstacles[at(pair.other)].volumeExcess
                                                  : geometry_->bodies[at(pair.other)].volumeExcess);
  addTerms(pair, row);
  rows_.push_back(row);
}

// The motions that change the pair's distance, and the coordinates that they belong to.
void CollisionConstraints::addTerms(const CheckedPair& pair, Row& row) {
  const int link = geometry_->bodies[at(pair.body)].link;
  std::vector<Kinematics::Dependence> list;
  if (pair.obstacle) {
    list = kinematics_->dependence(link);
    for (Kinematics::Dependence& d : list) d.sign = -1;
  } else {
    list = kinematics_->dependence(link, geometry_->bodies[at(pair.other)].link);
  }
  std::vector<int> columns;
  for (const Kinematics::Dependence& d : list)
    columns.push_back(kinematics_->motions()[at(d.motion)].coordinate);
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  row.firstTerm = static_cast<int>(terms_.size());
  for (const Kinematics::Dependence& d : list) {
    const int coordinate = kinematics_->motions()[at(d.motion)].coordinate;
    const auto slot = std::lower_bound(columns.begin(), columns.end(), coordinate) - columns.begin();
    terms_.push_back({d.motion, d.sign < 0 ? 0 : 1, rowStart_.back() + static_cast<int>(slot)});
  }
  std::stable_sort(terms_.begin() + row.firstTerm, terms_.end(),
                   [](const Term& a, const Term& b) { return a.slot < b.slot; });
  row.lastTerm = static_cast<int>(terms_.size());
  row.firstCommon = static_cast<int>(common_.size());
  for (const Kinematics::Dependence& d : kinematics_->dependence(link)) {
    const int coordinate = kinematics_->motions()[at(d.motion)].coordinate;
    const bool own =
        std::any_of(list.begin(), list.end(), [&](const auto& l) { return l.motion == d.motion; });
    const auto slot = std::lower_bound(columns.begin(), columns.end(), coordinate);
    if (!own && slot != columns.end() && *slot == coordinate)
      common_.push_back({d.motion, rowStart_.back() + static_cast<int>(slot - columns.begin())});
  }
  row.lastCommon = static_cast<int>(common_.size());
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

const fcl::CollisionGeometryd& CollisionConstraints::second(const CheckedPair& pair) const {
  return pair.obstacle ? *options_.obstacles[at(pair.other)].geometry()
                       : *geometry_->bodies[at(pair.other)].geometry;
}

std::string CollisionConstraints::name(int row) const {
  requireRow(row);
  if (at(row) >= pairs_.size()) return options_.smooth[at(row) - pairs_.size()].name;
  return nameOf(pairs_[at(row)], *geometry_, options_.obstacles);
}

CollisionConstraints::SparseJacobian CollisionConstraints::makeJacobian() const {
  const std::vector<double> zeros(column_.size(), 0.0);
  return Eigen::Map<const SparseJacobian>(rows(), columns(), nonZeros(), rowStart_.data(), column_.data(),
                                          zeros.data());
}

void CollisionConstraints::forget() { std::fill(caches_.begin(), caches_.end(), PairCache{}); }

RowAnswer CollisionConstraints::answer(int row) const {
  requireRow(row);
  if (at(row) >= pairs_.size()) return {};
  const Row& r = rows_[at(row)];
  RowAnswer answer;
  DistanceAnswer& found = answer;
  // Of a pair that was not queried, found_ and answers_ have old values and the distance of its constant row.
  if (r.first)
    found = inFclTerms(found_[at(row)], pose_[at(r.a)], pose_[at(r.b)]);
  else if (answers_[at(row)].status != DistanceStatus::invalid)
    found = answers_[at(row)];
  found.geometry = {geometry_->bodies[at(r.a)].geometry.get(), &second(pairs_[at(row)])};
  if (answer.status == DistanceStatus::invalid) return answer;
  if (answer.distance > 0) answer.meshDistanceMost = answer.upper + r.excess;
  if (moving_) {
    answer.normalVelocity = moves_[at(row)].normal;
    answer.pointVelocity = moves_[at(row)].point;
  }
  return answer;
}

// Queries the row's pair. If its spheres are too far apart, the status is `invalid` and the distance is the
// largest value that a row may have. If the query fails, as with links 1e160 m away, the distance is the
// lowest value, because the pair is not proven clear.
CollisionConstraints::Witness CollisionConstraints::query(std::size_t row) {
  const Row& r = rows_[row];
  const double apart = (centre_[at(r.b)] - centre_[at(r.a)]).squaredNorm();
  const bool far = apart >= r.far * r.far && std::isfinite(apart);
  DistanceStatus& status = r.first ? found_[row].status : answers_[row].status;
  double& value = r.first ? found_[row].distance : answers_[row].distance;
  status = DistanceStatus::invalid;
  if (!far && r.first)
    found_[row] = distance(*r.first, pose_[at(r.a)], *r.second, pose_[at(r.b)], &caches_[row]);
  else if (!far)
    answers_[row] = distance(*geometry_->bodies[at(r.a)].geometry, pose_[at(r.a)], second(pairs_[row]),
                             pose_[at(r.b)], {&caches_[row], nullptr, nullptr, StartFrom::centres, r.finite});
  if (status == DistanceStatus::invalid)
    value = !far ? std::numeric_limits<double>::lowest() : r.whole ? options_.influence : r.end;
  return known(row);
}

// The result of the last query. If its status is `invalid`, only the distance has a meaning.
CollisionConstraints::Witness CollisionConstraints::known(std::size_t row) const {
  if (!rows_[row].first) {
    const DistanceAnswer& answer = answers_[row];
    return {answer.status, answer.distance, answer.normal, answer.points};
  }
  const Distance& found = found_[row];
  return {found.status, found.distance, found.normal, found.point};
}

double CollisionConstraints::pairRow(std::size_t row, double* values) {
  const Witness witness = ask(row);
  double slope, curvature;
  const double value = levelled(row, witness.distance, slope, curvature);
  if (values) writeRow(row, witness, slope, values);
  return value;
}

void CollisionConstraints::writeRow(std::size_t row, const Witness& witness, double slope,
                                    double* values) const {
  std::fill(values + rowStart_[row], values + rowStart_[row + 1], 0.0);
  if (witness.status == DistanceStatus::invalid) return;
  // The velocity of x along n is n.v + (x cross n).w for a motion (v, w).
  const Eigen::Vector3d n = slope * witness.normal;
  Eigen::Matrix<double, 6, 2> along;
  along << -n, n, n.cross(witness.point[0]), witness.point[1].cross(n);
  for (int t = rows_[row].firstTerm; t < rows_[row].lastTerm; ++t) {
    const Term& term = terms_[at(t)];
    values[term.slot] += along.col(term.side).dot(detail::stacked(state_.motion[at(term.motion)]));
  }
}

void CollisionConstraints::place(const ConstVector& q) {
  kinematics_->forward(q, state_, placing_);
  for (const int i : placed_) {
    const Body& body = geometry_->bodies[at(i)];
    pose_[at(i)] = state_.link[at(body.link)] * body.pose;
    centre_[at(i)] = state_.link[at(body.link)] * body.centre;
  }
  askWhole();
}

}  // namespace fcl_stpbv
