// The distance of one pair of links, or of a link and an obstacle, as a function of the joints between them:
// local minima and maxima, and Lipschitz constants.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/search_room.h"

namespace fcl_stpbv::detail {

/// One pair as a function of the coordinates between them.
class PairSearch {
 public:
  /// `obstacles` are those of the scene, which a pair with an obstacle refers to.
  PairSearch(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
             const LinkPair& pair, const std::vector<Obstacle>& obstacles = {});

  /// Least distance over the bodies at q.
  double distance(const Eigen::VectorXd& q);

  /// Projected gradient descent from q within the limits, until the distance is at most `margin` or no longer
  /// falls. Returns the distance reached; q becomes that configuration.
  double descend(Eigen::VectorXd& q, double margin);

  /// The same uphill, until the distance exceeds `margin` or no longer grows.
  double climb(Eigen::VectorXd& q, double margin);

  /// Bound on the change of the distance per unit of each coordinate between the links; infinite if there is
  /// no bound.
  const std::vector<double>& lipschitz() const { return lipschitz_; }
  const std::vector<int>& coordinates() const { return coordinates_; }

  /// The room of the robot and the pair's own obstacle: other obstacles do not make it larger.
  const SearchRoom& room() const { return room_; }

  /// The constraints, with the answers of the last distance().
  const CollisionConstraints& constraints() const { return constraints_; }
  /// Makes the next distance independent of earlier ones, to the last bit.
  void forget() { constraints_.forget(); }

 private:
  double distanceAndGradient(const Eigen::VectorXd& q);
  template <class Arrived>
  double follow(Eigen::VectorXd& q, double sign, Arrived arrived);
  void boundSlopes(int link1, double reach1, int link2, double reach2);

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> geometry_;
  CollisionConstraints constraints_;
  std::vector<int> coordinates_;
  std::vector<double> lipschitz_;
  Eigen::VectorXd d_, values_, gradient_;
  SearchRoom room_;
};

}  // namespace fcl_stpbv::detail
