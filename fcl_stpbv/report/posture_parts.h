// Splits links into convex parts for a posture search, as far as its task needs it.
#pragma once

#include <optional>

#include "fcl_stpbv/posture/find_posture.h"
#include "fcl_stpbv/report/pair_cause.h"
#include "fcl_stpbv/robot/detail_choice.h"

namespace fcl_stpbv::report {

/// Splits the links of a scene's robot, by the task's `parts` and `partsAuto`. The scene must outlive it.
class PostureParts {
 public:
  /// `around`: the bodies behind the scene's obstacles. All links are split at once if the task asks for a
  /// number of parts.
  PostureParts(const PostureTask& task, PostureScene& scene, std::shared_ptr<const RobotGeometry> around,
               const GeometryOptions& options);

  /// Solves the task. As long as that fails with pairs that are in the way only by their hulls, links are
  /// split and the task is solved again.
  /// @param setup the setup of the task; replaced if links are split
  Posture find(PostureSetup& setup, const PostureOptions& options);

 private:
  std::vector<SceneNeed> inTheWay(const PostureSetup& setup, const Eigen::VectorXd& q);
  void use(std::shared_ptr<const RobotGeometry> geometry);

  const PostureTask& task_;
  PostureScene& scene_;
  std::shared_ptr<const Kinematics> kinematics_;
  double near_;
  detail::DetailChoice choice_;
  PairCauses causes_;
};

}  // namespace fcl_stpbv::report
