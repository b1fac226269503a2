// Chooses the level of detail of each link: the coarsest whole bodies, or the fewest convex parts, that meet
// the needs of the pairs.
#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/own_shapes.h"
#include "fcl_stpbv/robot/scene_model.h"

namespace fcl_stpbv::detail {

/// Works from coarse to fine: every link starts as a whole body at the first level. refine() makes links
/// finer, never coarser.
class DetailChoice {
 public:
  using Levels = std::vector<std::shared_ptr<const RobotGeometry>>;

  /// `levels`: whole bodies, from coarse to fine; parts get the radii of the last level. `everyPair`: a split
  /// link is split for all its pairs. @throws Error if the levels do not have the same shapes.
  DetailChoice(std::shared_ptr<const Kinematics> kinematics, Levels levels, std::vector<Obstacle> obstacles,
               const SceneModelOptions& options, bool everyPair);

  /// Refines links until these needs are met. Needs that even the finest bodies do not meet have no
  /// effect. @return the pairs whose bodies have changed
  std::set<LinkPair> refine(const std::vector<SceneNeed>& needs);

  /// Splits every concave link into at most `most` parts.
  void splitAll(int most);

  /// Whether the bodies as they are now meet a need.
  bool meets(const SceneNeed& need);

  std::shared_ptr<const RobotGeometry> geometry();

 private:
  using Detail = int;  // a level; numbers after the last level: at most 2, 3, 4 ... parts
  using Details = std::pair<Detail, Detail>;
  struct OpenNeed {
    SceneNeed need;
    std::size_t index;            // among all
    std::map<Details, bool> met;  // what is known; kOwn in place of parts: whether any parts may meet it
  };
  static constexpr Detail kOwn = std::numeric_limits<Detail>::max();  // the link's own shapes, as if a level

  Detail levels() const { return static_cast<Detail>(levels_.size()); }
  Detail inParts(int most) const { return levels() + most - 2; }
  int mostParts(Detail detail) const { return std::max(1, detail - levels() + 2); }
  Detail detailOf(int link) const;
  Details detailsOf(const LinkPair& pair) const;
  Details raised(const LinkPair& pair, int link, Detail detail) const;
  std::vector<const Body*> bodiesOf(int link, Detail detail);
  bool meets(const SceneNeed& need, Details details);
  bool meets(OpenNeed& open, Details details);
  bool mayMeet(OpenNeed& open, Details details);
  bool refineOneLink(std::vector<OpenNeed>& open, Detail detail);
  bool refineBothLinks(OpenNeed& open);
  void raise(int link, Detail detail);
  void take(const LinkPair& pair, Details details);

  std::shared_ptr<const Kinematics> kinematics_;
  Levels levels_;
  std::vector<Obstacle> obstacles_;
  LinkParts parts_;
  OwnShapes ownShapes_;
  SceneModelOptions options_;
  std::map<int, Detail> detail_;  // by link, if above 0
  std::set<LinkPair> byParts_;    // RobotGeometry::byParts
  std::set<LinkPair> changed_;    // pairs changed since refine() began
  std::vector<Detail> ladder_;    // the details that refine() tries
};

}  // namespace fcl_stpbv::detail
