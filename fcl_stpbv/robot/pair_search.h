// The least distance of one pair of links, or of a link and an obstacle, over the joint box: descent, and a
// proof by branch and bound.
#pragma once

#include <Eigen/Core>
#include <chrono>
#include <memory>
#include <vector>

#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv {

/// One pair as a function of the coordinates between them.
class PairSearch {
 public:
  enum class Proof { clear, collision, undecided };

  PairSearch(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
             int link1, int link2);
  /// A link and something that stands still.
  PairSearch(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
             int link, const Obstacle& obstacle);

  /// Least distance over the bodies at q.
  double distance(const Eigen::VectorXd& q);

  /// Projected gradient descent from q within the limits, until the distance is at most `margin` or falls no
  /// more. Gives the distance reached; q becomes where.
  double descend(Eigen::VectorXd& q, double margin);

  /// Whether the distance exceeds `margin` all over the joint box: cut into boxes until in each the distance
  /// at the middle, less what the joints can change it by within the box, exceeds it (a Lipschitz bound:
  /// docs/robot.md). On `collision` q is one.
  Proof prove(double margin, std::chrono::steady_clock::time_point until, Eigen::VectorXd& q);

  /// Bound on the change of the distance per unit of each coordinate between the links, infinite where there
  /// is none.
  const std::vector<double>& lipschitz() const { return lipschitz_; }
  const std::vector<int>& coordinates() const { return coordinates_; }

 private:
  PairSearch(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
             std::vector<CheckedPair> pairs, ConstraintOptions options);
  double distanceAndGradient(const Eigen::VectorXd& q);
  double lowerBound() const;
  void boundSlopes(int link1, double reach1, int link2, double reach2);

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  CollisionConstraints constraints_;
  std::vector<int> coordinates_;
  std::vector<double> lipschitz_;
  Eigen::VectorXd d_, values_, gradient_;
};

}  // namespace fcl_stpbv
