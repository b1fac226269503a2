// The optimisation problem of a posture: collects the constraints, variables, bounds and cost, and evaluates
// all of them together for an x.
#include "fcl_stpbv/posture/problem.h"

#include <algorithm>
#include <cmath>

#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/posture/mimic_limits.h"

namespace fcl_stpbv {
namespace {

using detail::kPi;
using detail::requireSize;

void sortWorstFirst(std::vector<Violation>& list) {
  std::stable_sort(list.begin(), list.end(),
                   [](const Violation& a, const Violation& b) { return a.amount > b.amount; });
}

}  // namespace

PostureCost quarterCost(const Kinematics& kinematics) {
  PostureCost cost{Eigen::VectorXd::Ones(kinematics.size()), Eigen::VectorXd::Zero(kinematics.size())};
  for (const Kinematics::Motion& motion : kinematics.motions())
    if (motion.joint < 0) cost.weights[motion.coordinate] = 0;
  for (int i = 0; i < kinematics.size(); ++i)
    if (std::isfinite(kinematics.lower()[i]) && std::isfinite(kinematics.upper()[i]))
      cost.reference[i] = (kinematics.lower()[i] + kinematics.upper()[i]) / 4;
  return cost;
}

PostureProblem::PostureProblem(std::shared_ptr<const Kinematics> kinematics, PostureCost cost,
                               const Eigen::VectorXd& start)
    : kinematics_(std::move(kinematics)),
      cost_(std::move(cost)),
      lower_(kinematics_->lower()),
      upper_(kinematics_->upper()),
      lowerOf_(static_cast<std::size_t>(kinematics_->size())),
      upperOf_(static_cast<std::size_t>(kinematics_->size())),
      state_(kinematics_->makeState()) {
  requireSize("PostureProblem", "start", start.size(), kinematics_->size());
  requireSize("PostureProblem", "the cost's weights", cost_.weights.size(), kinematics_->size());
  requireSize("PostureProblem", "the cost's reference", cost_.reference.size(), kinematics_->size());
  detail::keepMimicLimits(*kinematics_, {lower_, lowerOf_}, {upper_, upperOf_});
  std::vector<int> turns;  // of the base
  for (const Kinematics::Motion& motion : kinematics_->motions())
    if (motion.joint < 0 && std::isfinite(lower_[motion.coordinate])) turns.push_back(motion.coordinate);
  // One is the angle of a planar base, three are a rotation vector.
  const double most = turns.size() == 1 ? kPi : kPi / 2;
  for (const int i : turns) {
    lower_[i] = start[i] - most;
    upper_[i] = start[i] + most;
  }
}

int PostureProblem::addVariables(int count) {
  const int first = variables();
  lower_.conservativeResize(first + count);
  upper_.conservativeResize(first + count);
  lower_.tail(count).setZero();
  upper_.tail(count).setOnes();
  shares_.emplace_back(first, count);
  known_ = false;
  return first;
}

void PostureProblem::add(std::shared_ptr<PostureRows> rows) {
  (rows->kind() == PostureRows::Kind::equal ? equalities_ : inequalities_) += rows->size();
  rows_.push_back(std::move(rows));
  known_ = false;
}

Violation PostureProblem::rowOf(PostureRows::Kind kind, int row) const {
  for (const auto& rows : rows_) {
    if (rows->kind() != kind) continue;
    if (row < rows->size()) return {rows->name(row), 0, rows->unit(row)};
    row -= rows->size();
  }
  return {"", 0};
}

std::string PostureProblem::variableName(int i) const {
  return i < kinematics_->size() ? kinematics_->names()[static_cast<std::size_t>(i)] : "contact weight";
}

std::string PostureProblem::limitName(int i, bool upper) const {
  const std::vector<std::string>& of = upper ? upperOf_ : lowerOf_;
  const std::size_t k = static_cast<std::size_t>(i);
  return variableName(i) + (upper ? " (upper limit" : " (lower limit") +
         (k < of.size() && !of[k].empty() ? " by " + of[k] : "") + ")";
}

Eigen::VectorXd PostureProblem::variablesAt(const Eigen::VectorXd& q) const {
  requireSize("PostureProblem", "q", q.size(), kinematics_->size());
  Eigen::VectorXd x(variables());
  x.head(q.size()) = q;
  for (const auto& [first, count] : shares_) x.segment(first, count).setConstant(1.0 / count);
  return x.cwiseMax(lower_).cwiseMin(upper_);
}

Eigen::VectorXd PostureProblem::costCurvature() const {
  Eigen::VectorXd curvature = Eigen::VectorXd::Zero(variables());
  curvature.head(cost_.weights.size()) = 2 * cost_.weights;
  return curvature;
}

const PostureValues& PostureProblem::evaluate(const Eigen::Ref<const Eigen::VectorXd>& x) {
  requireSize("PostureProblem", "x", x.size(), variables());
  if (known_ && x == values_.x) return values_;
  known_ = false;  // also if rows throw
  values_.x = x;
  const int n = kinematics_->size();
  const Eigen::VectorXd away = x.head(n) - cost_.reference;
  values_.cost = away.cwiseAbs2().dot(cost_.weights);
  values_.costGradient = Eigen::VectorXd::Zero(variables());
  values_.costGradient.head(n) = 2 * cost_.weights.cwiseProduct(away);
  values_.equal.resize(equalities_);
  values_.atLeast.resize(inequalities_);
  values_.equalJacobian.setZero(equalities_, variables());
  values_.atLeastJacobian.setZero(inequalities_, variables());
  kinematics_->forward(x.head(n), state_);
  int equal = 0, atLeast = 0;
  for (const auto& rows : rows_) {
    const bool equality = rows->kind() == PostureRows::Kind::equal;
    int& first = equality ? equal : atLeast;
    RowMatrix& jacobian = equality ? values_.equalJacobian : values_.atLeastJacobian;
    Eigen::VectorXd& values = equality ? values_.equal : values_.atLeast;
    rows->evaluate({x, state_}, values.segment(first, rows->size()),
                   jacobian.middleRows(first, rows->size()));
    first += rows->size();
  }
  known_ = true;
  return values_;
}

long PostureProblem::queries() const {
  long sum = 0;
  for (const auto& rows : rows_) sum += rows->queries();
  return sum;
}

std::vector<Violation> PostureProblem::missed(const Eigen::Ref<const Eigen::VectorXd>& x, double tolerance) {
  const PostureValues& at = evaluate(x);
  std::vector<Violation> list;
  const auto note = [&](Violation of, double amount) {
    of.amount = amount;
    if (!(amount <= tolerance)) list.push_back(of);
  };
  for (int i = 0; i < equalities_; ++i) note(rowOf(PostureRows::Kind::equal, i), std::abs(at.equal[i]));
  for (int i = 0; i < inequalities_; ++i) note(rowOf(PostureRows::Kind::atLeast, i), -at.atLeast[i]);
  for (int i = 0; i < variables(); ++i)
    note({variableName(i), 0, ""}, std::max(lower_[i] - x[i], x[i] - upper_[i]));
  sortWorstFirst(list);
  return list;
}

std::vector<Violation> PostureProblem::violations(const Eigen::Ref<const Eigen::VectorXd>& x,
                                                  double tolerance) {
  std::vector<Violation> list = missed(x, tolerance);
  list.insert(list.end(), unavoidable_.begin(), unavoidable_.end());
  sortWorstFirst(list);
  return list;
}

}  // namespace fcl_stpbv
