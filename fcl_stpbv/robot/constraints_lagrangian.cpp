// Full Hessians of rows and their weighted sum in a fixed sparse structure, as IPOPT needs them: the pair's
// 12 x 12 Hessian multiplied by the twists of the joints from both sides, plus the change of these twists
// with each joint further up.
#include <algorithm>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/number_check.h"
#include "fcl_stpbv/numbers.h"
#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv {
namespace {

using Eigen::Vector3d;

using detail::at;

}  // namespace

CollisionConstraints::SparseHessian CollisionConstraints::makeHessian() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t row = 0; row + 1 < rowStart_.size(); ++row)
    for (int j = rowStart_[row]; j < rowStart_[row + 1]; ++j)
      for (int i = j; i < rowStart_[row + 1]; ++i) entries.emplace_back(column_[at(i)], column_[at(j)], 0.0);
  SparseHessian lower(columns(), columns());
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

void CollisionConstraints::requireStructure(const SparseHessian& lower) const {
  const Eigen::Index columns = structure_.cols(), entries = structure_.nonZeros();
  if (lower.rows() != columns || lower.cols() != columns || !lower.isCompressed() ||
      lower.nonZeros() != entries ||
      !std::equal(structure_.outerIndexPtr(), structure_.outerIndexPtr() + columns, lower.outerIndexPtr()) ||
      !std::equal(structure_.innerIndexPtr(), structure_.innerIndexPtr() + entries, lower.innerIndexPtr()))
    throw Error("CollisionConstraints: the Hessian needs the structure that makeHessian() gives it");
}

void CollisionConstraints::makeRoomForHessian() {
  if (!alongEach_.empty()) return;
  int most = 0;
  for (std::size_t row = 0; row < rows_.size(); ++row)
    most = std::max(most, rowStart_[row + 1] - rowStart_[row]);
  alongEach_.assign(at(columns()), kinematics_->makeRate());
  twists_.resize(12, most);
  pushes_.resize(12, most);
  square_.resize(most, most);
  axis_.resize(columns());
  structure_ = makeHessian();
}

// Computes the poses, and how every motion changes as each coordinate moves.
void CollisionConstraints::prepareHessian(const ConstVector& q) {
  makeRoomForHessian();
  place(q);
  // Rows that are not queried now must not keep the answers of another q. Whole bodies were queried.
  for (std::size_t row = 0; row < pairs_.size(); ++row)
    if (!rows_[row].whole) found_[row].status = answers_[row].status = DistanceStatus::invalid;
  moved_.setZero();
  for (int k = 0; k < columns(); ++k) {
    moved_[k] = 1;
    kinematics_->differentiate(q, moved_, state_, alongEach_[at(k)], placing_);
    moved_[k] = 0;
  }
  moving_ = false;
}

// The twist of each body that each of the row's columns gives it.
void CollisionConstraints::fillTwists(std::size_t row) {
  const Row& r = rows_[row];
  const int start = rowStart_[row];
  const Vector3d origin[2] = {pose_[at(r.a)].translation(), pose_[at(r.b)].translation()};
  twists_.leftCols(rowStart_[row + 1] - start).setZero();
  for (int t = r.firstTerm; t < r.lastTerm; ++t) {
    const Term& term = terms_[at(t)];
    const Twist& motion = state_.motion[at(term.motion)];
    twists_.col(term.slot - start).segment<3>(6 * term.side) +=
        motion.linear + motion.angular.cross(origin[term.side]);
    twists_.col(term.slot - start).segment<3>(6 * term.side + 3) += motion.angular;
  }
}

// Adds the gradient times the change of the twists as each coordinate moves.
void CollisionConstraints::addTwistChanges(std::size_t row, const Witness& witness) {
  const Row& r = rows_[row];
  const int start = rowStart_[row], count = rowStart_[row + 1] - start;
  for (int t = r.firstTerm; t < r.lastTerm; ++t) {
    const Term& term = terms_[at(t)];
    const int i = term.slot - start;
    const Vector3d along = (term.side == 0 ? -1 : 1) * witness.normal;
    const Vector3d moment = witness.point[at(term.side)].cross(along);
    const Twist& motion = state_.motion[at(term.motion)];
    const Vector3d turned = along.cross(motion.angular);  // along.(w x v) = turned.v
    const auto add = [&](int j, double entry) {
      square_(i, j) += entry / 2;
      square_(j, i) += entry / 2;
    };
    for (int j = 0; j < count; ++j) {
      const Twist& change = alongEach_[at(column_[at(start + j)])].motion[at(term.motion)];
      add(j, along.dot(change.linear) + moment.dot(change.angular) +
                 turned.dot(twists_.col(j).segment<3>(6 * term.side)));
    }
    // Seen from the link that carries both bodies: what moves that one is no change of the twists.
    for (int c = r.firstCommon; c < r.lastCommon; ++c) {
      const Twist& by = state_.motion[at(common_[at(c)].motion)];
      const Vector3d linear = by.angular.cross(motion.linear) + by.linear.cross(motion.angular);
      add(common_[at(c)].slot - start, -along.dot(linear) - moment.dot(by.angular.cross(motion.angular)));
    }
  }
}

// Along a line of q the poses' second derivatives are the pair's own at the bodies' twists and, by the
// gradient, the change of those twists. Entries in the order of the row's columns.
bool CollisionConstraints::rowHessian(std::size_t row) {
  const Row& r = rows_[row];
  const int start = rowStart_[row], count = rowStart_[row + 1] - start;
  auto h = square_.topLeftCorner(count, count);
  h.setZero();
  const Witness witness = ask(row);
  if (witness.status == DistanceStatus::invalid) return true;
  DistanceHessian pair;
  const Eigen::Isometry3d &pose1 = pose_[at(r.a)], &pose2 = pose_[at(r.b)];
  const bool known = r.first ? fcl_stpbv::hessian(*r.first, pose1, *r.second, pose2, found_[row], pair)
                             : fcl_stpbv::hessian(*geometry_->bodies[at(r.a)].geometry, pose1,
                                                  second(pairs_[row]), pose2, answers_[row], pair);
  if (!known) return false;
  fillTwists(row);
  const auto twists = twists_.leftCols(count);
  auto pushes = pushes_.leftCols(count);
  pushes.noalias() = pair.matrix * twists;
  h.noalias() = twists.transpose() * pushes;
  addTwistChanges(row, witness);
  double slope, curvature;
  levelled(row, witness.distance, slope, curvature);
  if (slope != 1 || curvature != 0) {
    writeRow(row, witness, 1.0, change_.data());
    const auto g = change_.segment(start, count);
    h *= slope;
    h.noalias() += curvature * g * g.transpose();
  }
  for (int j = 0; j < count; ++j)  // make it symmetric to the last bit
    for (int i = 0; i < j; ++i) h(i, j) = h(j, i) = (h(i, j) + h(j, i)) / 2;
  return true;
}

// Calls add(i, j, value, row) for the open rows' entries, with half of each from either side of the diagonal.
template <class Add>
void CollisionConstraints::openHessians(const ConstVector& q, const Add& add) {
  if (std::find(open_.begin(), open_.end(), 1) == open_.end()) return;
  for (int j = 0; j < columns(); ++j) {
    axis_.setZero();
    axis_[j] = 1;
    differences(q, axis_);
    for (std::size_t row = 0; row < open_.size(); ++row) {
      if (!open_[row]) continue;
      const auto first = column_.begin() + rowStart_[row], last = column_.begin() + rowStart_[row + 1];
      if (!std::binary_search(first, last, j)) continue;
      for (int k = rowStart_[row]; k < rowStart_[row + 1]; ++k)
        add(column_[at(k)], j, change_[k], static_cast<int>(row));
    }
  }
}

bool CollisionConstraints::hessian(const ConstVector& q, const ConstVector& weights, SparseHessian& lower) {
  requireSizes(q, rows(), nonZeros());
  detail::requireSize("CollisionConstraints", "weights", weights.size(), rows());
  makeRoomForHessian();
  requireStructure(lower);
  Eigen::Map<Eigen::VectorXd>(lower.valuePtr(), lower.nonZeros()).setZero();
  if (!q.allFinite() || !isUsable(weights)) return false;
  prepareHessian(q);
  for (std::size_t row = 0; row < open_.size(); ++row) {
    const double weight = weights[static_cast<Eigen::Index>(row)];
    open_[row] = weight != 0 && (row >= pairs_.size() || !rowHessian(row));
    if (weight == 0 || open_[row]) continue;
    const int start = rowStart_[row], count = rowStart_[row + 1] - start;
    for (int j = 0; j < count; ++j) {
      // The row's columns ascend, and so do the entries of a column of `lower`, which contains all of them.
      int place = lower.outerIndexPtr()[column_[at(start + j)]];
      for (int i = j; i < count; ++i) {
        while (lower.innerIndexPtr()[place] != column_[at(start + i)]) ++place;
        lower.valuePtr()[place] += weight * square_(i, j);
      }
    }
  }
  openHessians(q, [&](int i, int j, double value, int row) {
    lower.coeffRef(std::max(i, j), std::min(i, j)) += weights[row] * (i == j ? value : value / 2);
  });
  return true;
}

bool CollisionConstraints::hessian(const ConstVector& q, int row, Eigen::Ref<Eigen::MatrixXd> full) {
  requireRow(row);
  requireSizes(q, rows(), nonZeros());
  if (full.rows() != columns() || full.cols() != columns())
    throw Error("CollisionConstraints: the Hessian of a row needs a row and a column for each coordinate");
  full.setZero();
  if (!q.allFinite()) return false;
  prepareHessian(q);
  std::fill(open_.begin(), open_.end(), 0);
  if (at(row) < pairs_.size() && rowHessian(at(row))) {
    const int start = rowStart_[at(row)], count = rowStart_[at(row) + 1] - start;
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) full(column_[at(start + i)], column_[at(start + j)]) = square_(i, j);
    return true;
  }
  open_[at(row)] = 1;
  openHessians(q, [&](int i, int j, double value, int) {
    full(i, j) += value / 2;
    full(j, i) += value / 2;
  });
  return true;
}

}  // namespace fcl_stpbv
