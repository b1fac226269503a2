// Another library's method for a robot's verdict, written as an experienced user would write it.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "test/reference/robots.h"

namespace fcl_stpbv::benchmark {

/// Holds a reference to the robot.
class Peer {
 public:
  explicit Peer(std::string itsName) : name(std::move(itsName)) {}
  virtual ~Peer() = default;
  /// Places the links, and counts the pairs whose hulls meet (polyhedra, without the margins r). With
  /// `first`, stops at the first one.
  virtual long hits(const Eigen::Ref<const Eigen::VectorXd>&, bool) { return 0; }
  /// Places the links, and computes the distances of all pairs of hulls. @returns how many are 0 or less.
  virtual long distances(const Eigen::Ref<const Eigen::VectorXd>&) { return 0; }
  /// Places the links. @returns the least distance of all pairs of hulls, or one that is 0 or less.
  virtual double leastDistance(const Eigen::Ref<const Eigen::VectorXd>&) { return 0; }

  const std::string name;
};

/// FCL's dynamic tree of boxes, whose callback calls `fcl::collide` or, for the least distance,
/// `fcl::distance` for the checked pairs. Distances are by `fcl::distance` for each pair.
std::unique_ptr<Peer> fclPeer(const test::Problem& robot);
/// Distances only: FCL's GJK on this library's hulls, from the last answer, stopped by the duality gap. Null
/// if a body is no hull.
std::unique_ptr<Peer> gapStopPeer(const test::Problem& robot);
/// Bullet's collision world with its tree of boxes; distances by its GJK for each pair. Null if a body is no
/// hull, or if Bullet was not found at build time.
std::unique_ptr<Peer> bulletPeer(const test::Problem& robot);

}  // namespace fcl_stpbv::benchmark
