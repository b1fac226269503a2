// Another library's way to a robot's verdict, as a good user of it would write it.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/kinematics.h"

namespace fcl_stpbv::benchmark {

/// A robot and the pairs that are asked about.
struct PosedModel {
  std::shared_ptr<const RobotModel> model;
  std::shared_ptr<const RobotGeometry> geometry;
  std::shared_ptr<const Kinematics> kinematics;
  std::vector<CheckedPair> pairs;
};

class Peer {
 public:
  explicit Peer(std::string itsName) : name(std::move(itsName)) {}
  virtual ~Peer() = default;
  /// Places the links, and counts the pairs whose hulls meet: polyhedra, without the margins r. Stops at the
  /// first if asked to.
  virtual long hits(const Eigen::Ref<const Eigen::VectorXd>& q, bool first) = 0;
  /// Distances of all pairs of hulls; how many it found to be 0 or less. 0 where the library has none.
  virtual long distances(const Eigen::Ref<const Eigen::VectorXd>&) { return 0; }

  const std::string name;
};

/// FCL's dynamic tree of boxes, whose callback asks `fcl::collide` about the checked
/// pairs; distances by `fcl::distance` of each.
std::unique_ptr<Peer> fclPeer(const PosedModel& robot);
/// Bullet's collision world with its tree of boxes; null where Bullet was not found when this was built.
std::unique_ptr<Peer> bulletPeer(const PosedModel& robot);

}  // namespace fcl_stpbv::benchmark
