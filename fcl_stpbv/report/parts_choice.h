// Which links are split into convex parts, and for which pairs: those that collide by their hulls alone.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "fcl_stpbv/report/collision_report.h"
#include "fcl_stpbv/report/pair_cause.h"
#include "fcl_stpbv/robot/link_parts.h"

namespace fcl_stpbv::report {

/// Coarse to fine: each link starts whole. A pair that collides although its meshes do not meet gets as few
/// parts as clear it there; all other pairs keep the whole bodies.
class PartsChoice {
 public:
  /// Of the report's bodies, none of which has parts yet; `options`: those that they were built with.
  /// `everyPair`: a link that is split is so for all its pairs.
  PartsChoice(const CollisionReport& report, const GeometryOptions& options, bool everyPair);

  /// Looks at the pairs of a report made with geometry(): in the configuration that each is reported in, and
  /// in `neutral` where the pair list leaves it out as colliding there. Whether more parts were found to
  /// help.
  bool refine(const CollisionReport& report, PairCauses& causes, const Eigen::VectorXd& neutral);

  /// Splits every concave link into at most `most` parts.
  void splitAll(int most);

  std::shared_ptr<const RobotGeometry> geometry() {
    return std::make_shared<const RobotGeometry>(parts_.geometry(most_, byParts_));
  }

 private:
  using Split = std::pair<int, int>;  // most parts of the first and of the second body

  /// A pair that parts may clear, and where.
  struct Candidate {
    LinkPair pair;
    Eigen::VectorXd q;
  };

  double clearance(const CollisionReport& report, const Candidate& candidate, const Split& split);
  std::optional<Split> splitFor(const CollisionReport& report, const Candidate& candidate);

  LinkParts parts_;
  int threads_;
  std::function<void(std::size_t, std::size_t, const std::string&)> progress_;
  std::map<int, int> most_;     // by link
  std::set<LinkPair> byParts_;  // as RobotGeometry's
};

}  // namespace fcl_stpbv::report
