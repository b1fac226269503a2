// The rows d(q) - margin >= 0 of a robot's CollisionConstraints, with their Jacobian.
#include "fcl_stpbv/posture/collision_rows.h"

namespace fcl_stpbv::detail {

CollisionRows::CollisionRows(CollisionConstraints constraints, double margin)
    : constraints_(std::move(constraints)), margin_(margin), entries_(constraints_.nonZeros()) {}

void CollisionRows::evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values,
                             Eigen::Ref<RowMatrix> jacobian) {
  constraints_.evaluateValues(at.x.head(constraints_.columns()), values, entries_);
  values.array() -= margin_;
  for (int row = 0; row < constraints_.rows(); ++row) {
    const std::size_t r = static_cast<std::size_t>(row);
    for (int k = constraints_.rowStart()[r]; k < constraints_.rowStart()[r + 1]; ++k)
      jacobian(row, constraints_.columnIndices()[static_cast<std::size_t>(k)]) = entries_[k];
    const bool asked =
        r < constraints_.pairs().size() && constraints_.answer(row).status != DistanceStatus::invalid;
    queries_ += asked;
  }
}

std::vector<NamedDistance> distancesOf(const std::vector<CheckedPair>& pairs, const PostureScene& scene,
                                       std::shared_ptr<const Kinematics> kinematics,
                                       const Eigen::VectorXd& q) {
  std::vector<NamedDistance> found;
  if (pairs.empty()) return found;
  ConstraintOptions options;
  options.obstacles = scene.obstacles;
  CollisionConstraints distances(std::move(kinematics), scene.geometry, pairs, std::move(options));
  Eigen::VectorXd d(distances.rows());
  distances.evaluate(q, d);
  for (int row = 0; row < d.size(); ++row) found.push_back({distances.name(row), d[row]});
  return found;
}

std::vector<Violation> nearerThan(double margin, const std::vector<CheckedPair>& pairs,
                                  const PostureScene& scene, std::shared_ptr<const Kinematics> kinematics,
                                  const Eigen::VectorXd& q) {
  std::vector<Violation> found;
  for (const NamedDistance& pair : distancesOf(pairs, scene, std::move(kinematics), q))
    if (!(pair.distance >= margin)) found.push_back({pair.name, margin - pair.distance});
  return found;
}

}  // namespace fcl_stpbv::detail
