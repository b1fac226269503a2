// What a robot is asked to do: its task file, and the optimisation problem made of it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/posture/placement.h"
#include "fcl_stpbv/posture/problem.h"
#include "fcl_stpbv/posture/stability.h"
#include "fcl_stpbv/robot/checked_pairs.h"

namespace fcl_stpbv {

/// A robot and what stands around it, loaded once for any number of tasks.
struct PostureScene {
  std::shared_ptr<const RobotModel> robot;        ///< never null
  std::shared_ptr<const RobotGeometry> geometry;  ///< never null
  std::shared_ptr<const Srdf> srdf;               ///< null without one
  std::vector<Obstacle> obstacles;                ///< that stand still
  /// The robot's own pairs that are checked, such as searchedPairs(); none: those that the SRDF leaves, or
  /// without one searched for anew by each task.
  std::optional<std::vector<CheckedPair>> selfPairs = std::nullopt;
};

/// The robot's own pairs to be checked where there is no SRDF: all but those that the tree of joints or the
/// samples of pairList() leave out. Takes a second or so for a humanoid.
std::vector<CheckedPair> searchedPairs(std::shared_ptr<const RobotModel> robot,
                                       std::shared_ptr<const RobotGeometry> geometry);

/// All pairs of some links with some obstacles, or where `self` is given with some other links of the robot;
/// both where both are. An empty list stands for all of its kind.
struct LinkObstacles {
  std::vector<std::string> links;                ///< names; none: all
  std::vector<std::string> obstacles;            ///< names; none: all
  std::optional<std::vector<std::string>> self;  ///< other links, by name

  /// Whether obstacles are meant at all.
  bool withObstacles() const { return !self || !obstacles.empty(); }
};

/// A task as its file says it (docs/posture.md). Lengths in m, angles in rad.
struct PostureTask {
  std::string path;                        ///< for messages
  BaseMotion base = BaseMotion::floating;  ///< how the base moves
  std::string state;                       ///< SRDF state to start from; "" for the neutral configuration
  Eigen::Isometry3d basePose = Eigen::Isometry3d::Identity();  ///< at the start
  std::map<std::string, double> joints;                        ///< at the start, over those of the state
  bool towardsStart = false;              ///< the cost's reference is the start instead of eq. 3's
  std::map<std::string, double> weights;  ///< of joints in the cost, over those of eq. 3
  /// A link and where it is to be.
  struct Place {
    std::string link;     ///< by name
    Placement placement;  ///< its link is found by name
  };
  std::vector<Place> placements;  ///< frames that are asked for
  /// A link that stands on something.
  struct Touch {
    std::string link;                     ///< by name
    std::vector<Eigen::Vector3d> points;  ///< in the link's frame (m)
  };
  std::vector<Touch> contacts;        ///< none: no static stability
  double stabilityMargin = 0;         ///< m
  double collisionMargin = 0;         ///< m
  bool selfCollisions = true;         ///< whether the robot is kept from itself
  std::vector<LinkObstacles> pairs;   ///< checked; none: every moving body against every obstacle
  std::vector<LinkObstacles> ignore;  ///< left out all the same
  /// Concave links are split for the pairs that are in the way although their meshes are farther apart. For
  /// the program find_posture, or whoever makes the scene's bodies: setUp() takes these as they are.
  bool partsAuto = false;
  int parts = 1;  ///< or all of them into so many convex parts at most
};

/// @throws Error naming the file and the key, and what would work.
PostureTask loadTask(const std::string& path);
/// The same from a text; `path` stands for it in messages.
PostureTask parseTask(const std::string& text, const std::string& path);

/// The problem of a task and where to start.
struct PostureSetup {
  std::shared_ptr<PostureProblem> problem;  ///< never null
  Eigen::VectorXd start;                    ///< q
  std::vector<CheckedPair> pairs;           ///< kept apart
};

/// The coordinates of the task's start. @throws Error naming the task's key.
Eigen::VectorXd startOf(const PostureTask& task, const PostureScene& scene, const Kinematics& kinematics);
/// The pairs that the task asks to keep apart. @throws Error naming the task's key.
std::vector<CheckedPair> pairsOf(const PostureTask& task, const PostureScene& scene);
/// All but the collisions. @throws Error naming the task's key.
PostureSetup setUpWithoutCollisions(const PostureTask& task, const PostureScene& scene);
/// Asked for beyond a collision margin (m): more than a solver's tolerance, so that what it calls feasible
/// keeps the margin itself.
constexpr double kBeyondMargin = 2e-6;
/// Pairs farther apart than `influence` (m) cost one test of their bounding spheres.
PostureSetup setUp(const PostureTask& task, const PostureScene& scene, double influence = 0.2);

}  // namespace fcl_stpbv
