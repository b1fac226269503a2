// Convex parts of a robot's concave links, beside the whole bodies, for the pairs that need them.
#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "fcl_stpbv/parts/convex_parts.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv {

/// A robot's bodies and their convex parts. Each mesh is split once for each number of parts.
class LinkParts {
 public:
  /// `whole` has no parts yet.
  explicit LinkParts(std::shared_ptr<const RobotGeometry> whole) : whole_(std::move(whole)) {}

  /// The bodies that stand for one whole body when it is split into `most` parts: with its radii, or flat as
  /// it is; `partOf` is `body`. One alone, or none, where there is nothing to split: a primitive, a convex
  /// mesh.
  /// @throws Error naming the mesh.
  const std::vector<Body>& of(int body, int most);

  /// The whole bodies, and beside them the parts of those links that have an entry in `most`; `byParts` as
  /// given.
  RobotGeometry geometry(const std::map<int, int>& most, const std::set<LinkPair>& byParts);

  /// The bodies as they were given.
  const RobotGeometry& whole() const { return *whole_; }

 private:
  std::shared_ptr<const RobotGeometry> whole_;
  std::map<std::pair<int, int>, std::vector<Body>> known_;  // by body and most
};

}  // namespace fcl_stpbv
