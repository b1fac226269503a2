// Distances of pairs of links in the neutral configuration and in random ones.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "fcl_stpbv/robot/batch.h"
#include "fcl_stpbv/robot/search_room.h"

namespace fcl_stpbv::detail {

/// The samples' results for one pair.
struct PairSamples {
  int samples = 0, collisions = 0;
  std::vector<std::pair<double, Eigen::VectorXd>>
      closest;               ///< the closest configurations with their distances, closest first
  double largest = 0;        ///< largest distance (m)
  Eigen::VectorXd farthest;  ///< configuration of `largest`
};

/// Distances of many pairs of links at once.
class PairSampler {
 public:
  PairSampler(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> geometry,
              const std::vector<LinkPair>& pairs, const std::vector<Obstacle>& obstacles, int threads);

  /// Least distance over the bodies of each pair (m).
  const Eigen::VectorXd& distances(const Eigen::VectorXd& q);

  /// Samples random configurations, the same for any number of threads. The `keep` closest of each pair are
  /// kept, at least one.
  std::vector<PairSamples> sample(int count, std::uint64_t seed, double margin, int keep,
                                  const std::function<void(int)>& progress);

 private:
  const Eigen::VectorXd& leastOf(const Eigen::Ref<const Eigen::VectorXd>& rows);

  std::shared_ptr<const Kinematics> kinematics_;
  SearchRoom room_;
  std::vector<Eigen::Index> pairOf_;  // index of the pair of each row
  CollisionConstraints constraints_;
  ConstraintsBatch batch_;
  Eigen::VectorXd rows_, least_;
};

}  // namespace fcl_stpbv::detail
