// Which links are split into convex parts, and for which pairs: those that collide by their hulls alone.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <utility>

#include "fcl_stpbv/report/collision_report.h"
#include "fcl_stpbv/report/pair_cause.h"
#include "fcl_stpbv/robot/link_parts.h"

namespace fcl_stpbv::report {

/// Coarse to fine: each link starts whole. A pair that collides although its meshes do not meet gets as few
/// parts as clear it there; all other pairs keep the whole bodies.
class PartsChoice {
 public:
  explicit PartsChoice(std::shared_ptr<const RobotGeometry> whole) : parts_(std::move(whole)) {}

  /// Looks at the pairs of a report made with geometry(): in the configuration that each is reported in, and
  /// in `neutral` where the pair list leaves it out as colliding there. Whether more parts were found to
  /// help.
  bool refine(const CollisionReport& report, PairCauses& causes, const Eigen::VectorXd& neutral);

  /// Splits every concave link into at most `most` parts, for all pairs.
  void splitAll(const CollisionReport& report, int most);

  std::shared_ptr<const RobotGeometry> geometry() {
    return std::make_shared<const RobotGeometry>(parts_.geometry(most_, byParts_));
  }

 private:
  using Split = std::pair<int, int>;  // most parts of the first and of the second body

  double clearance(const CollisionReport& report, const LinkPair& pair, const Eigen::VectorXd& q,
                   const Split& split, double enough);
  bool refinePair(const CollisionReport& report, const LinkPair& pair, const Eigen::VectorXd& q);

  LinkParts parts_;
  std::map<int, int> most_;     // by link
  std::set<LinkPair> byParts_;  // as RobotGeometry's
};

}  // namespace fcl_stpbv::report
