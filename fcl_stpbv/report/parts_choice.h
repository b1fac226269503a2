// Which links are split into convex parts, and for which pairs: those that collide by their hulls alone.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_parts.h"

namespace fcl_stpbv::report {

/// What parts are chosen for.
struct PartsScene {
  std::shared_ptr<const Kinematics> kinematics;
  std::shared_ptr<const RobotGeometry> whole;  ///< no body of which has parts yet
  std::vector<Obstacle> obstacles;
  double margin = 0;  ///< parts are to be farther apart (m)
};

/// A pair that parts may clear, and in which configuration.
struct PartsCandidate {
  LinkPair pair;
  Eigen::VectorXd q;
};

/// Coarse to fine: each link starts whole. A pair that collides although its meshes do not meet gets as few
/// parts as clear it there; all other pairs keep the whole bodies.
class PartsChoice {
 public:
  /// `options`: those that the bodies were built with. `everyPair`: a link that is split is so for all its
  /// pairs.
  PartsChoice(PartsScene scene, const GeometryOptions& options, bool everyPair);

  /// Splits the links of these pairs as far as clears them.
  /// @return the pairs whose parts are others now; none where no split was found to help
  std::set<LinkPair> refine(const std::vector<PartsCandidate>& candidates);

  /// Splits every concave link into at most `most` parts.
  void splitAll(int most);

  std::shared_ptr<const RobotGeometry> geometry() {
    return std::make_shared<const RobotGeometry>(parts_.geometry(most_, byParts_));
  }

 private:
  using Split = std::pair<int, int>;  // most parts of the first and of the second body

  double clearance(const PartsCandidate& candidate, const Split& split);
  std::optional<Split> splitFor(const PartsCandidate& candidate);

  PartsScene scene_;
  LinkParts parts_;
  int threads_;
  std::function<void(std::size_t, std::size_t, const std::string&)> progress_;
  std::map<int, int> most_;     // by link
  std::set<LinkPair> byParts_;  // as RobotGeometry's
};

}  // namespace fcl_stpbv::report
