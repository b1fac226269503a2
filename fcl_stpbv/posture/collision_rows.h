// The distances of a robot as inequality constraints: d(q) - margin >= 0.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/posture/problem.h"
#include "fcl_stpbv/posture/task.h"
#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv::detail {

/// One row per pair of bodies and per smooth constraint of CollisionConstraints.
class CollisionRows : public PostureRows {
 public:
  CollisionRows(CollisionConstraints constraints, double margin);

  Kind kind() const override { return Kind::atLeast; }
  int size() const override { return constraints_.rows(); }
  std::string name(int row) const override { return constraints_.name(row); }
  void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values, Eigen::Ref<RowMatrix> jacobian) override;

  /// Number of distances computed. It does not count pairs for which the bounding spheres were enough.
  long queries() const override { return queries_; }

 private:
  CollisionConstraints constraints_;
  double margin_;
  Eigen::VectorXd entries_;
  long queries_ = 0;
};

/// A pair of bodies and its distance.
struct NamedDistance {
  std::string name;
  double distance;  ///< signed (m)
};

/// The distances of all pairs in a configuration, in their order.
std::vector<NamedDistance> distancesOf(const std::vector<CheckedPair>& pairs, const PostureScene& scene,
                                       std::shared_ptr<const Kinematics> kinematics,
                                       const Eigen::VectorXd& q);

/// The pairs of bodies that are nearer than the margin (m), in their order, and how much nearer they are.
std::vector<Violation> nearerThan(double margin, const std::vector<CheckedPair>& pairs,
                                  const PostureScene& scene, std::shared_ptr<const Kinematics> kinematics,
                                  const Eigen::VectorXd& q);

}  // namespace fcl_stpbv::detail
