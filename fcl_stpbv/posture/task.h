// A task for a robot: placements of its links and static stability. Reads task files and makes the
// optimisation problem of a task.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/posture/problem.h"
#include "fcl_stpbv/robot/checked_pairs.h"

namespace fcl_stpbv {

/// Mass and centre of mass of a robot, and the Jacobian of the centre of mass.
class CentreOfMass {
 public:
  /// @throws Error for a robot without mass.
  explicit CentreOfMass(const Kinematics& kinematics);

  /// Mass of all links (kg).
  double mass() const { return mass_; }
  /// Centre of mass in the world frame (m). `jacobian` (3 x coordinates) is overwritten. @throws Error if it
  /// has another size, or for the state of another robot.
  Eigen::Vector3d evaluate(const Kinematics::State& state, Eigen::Ref<Eigen::Matrix3Xd> jacobian);

 private:
  struct Link {
    int parent;
    double mass;
    Eigen::Vector3d centre;
  };
  struct Motion {
    int link;  // the first link that it carries
    int coordinate;
  };
  std::vector<Link> links_;
  std::vector<Motion> motions_;
  double mass_ = 0;
  int coordinates_ = 0;
  std::vector<double> below_;                 // mass of each link and all links below it
  std::vector<Eigen::Vector3d> momentBelow_;  // sum of mass times position over the same links
};

/// Contact of one link with the ground: the corners of a convex patch, or any points of the link.
struct Contact {
  int link = 0;                         ///< index into RobotModel::links
  std::vector<Eigen::Vector3d> points;  ///< in the link's frame (m)
};

/// The corners of a flat convex patch after each edge has moved inwards by `margin` (m). One or two points
/// have no inside, so they need a margin of 0 and stay unchanged. @throws Error if nothing is left of the
/// patch, and for a margin that is negative or not a number.
std::vector<Eigen::Vector3d> shrunk(const std::vector<Eigen::Vector3d>& points, double margin);

/// Static stability as constraints. The projection of the centre of mass along z is the sum of w_k times
/// contact point k, with w_k >= 0 and sum 1. The weights are additional variables, starting at
/// x[firstWeight]. So contacts may move with the posture, and the constraints stay smooth. The projection of
/// each contact along z is shrunk by the margin. So the centre of mass keeps that distance from the support
/// polygon's edges, even if contacts are tilted.
class StaticStability : public PostureRows {
 public:
  /// `margin` in m; if it is above 0, add room() to the problem too. `world` rotates the world axes of
  /// `kinematics` into axes with z upwards. @throws Error if the margin leaves nothing of a contact, and for
  /// a link that does not exist.
  StaticStability(std::shared_ptr<const Kinematics> kinematics, const std::vector<Contact>& contacts,
                  double margin, int firstWeight, const Eigen::Matrix3d& world = Eigen::Matrix3d::Identity());

  /// Inequality constraints that keep the projection of each contact along z wide enough for the margin, and
  /// each contact at least 3 degrees from upright. Null if the margin is 0.
  std::shared_ptr<PostureRows> room() const;
  /// Number of weights, one per contact point.
  int weights() const { return weights_; }
  Kind kind() const override { return Kind::equal; }
  int size() const override { return 3; }
  std::string name(int row) const override;
  std::string unit(int row) const override { return row < 2 ? "m" : ""; }
  void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values, Eigen::Ref<RowMatrix> jacobian) override;

 private:
  struct Patches;  // of the contacts

  std::shared_ptr<const Kinematics> kinematics_;
  CentreOfMass centre_;
  std::shared_ptr<Patches> patches_;
  std::vector<std::vector<Kinematics::Dependence>> carriers_;  // of each contact
  Eigen::Matrix3d world_;
  int firstWeight_, weights_ = 0;
  Eigen::Matrix3Xd centreJacobian_;
};

/// A frame of a link and its target pose.
struct Placement {
  std::string name;                                          ///< name of the placement, for messages
  int link = 0;                                              ///< index into RobotModel::links
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();   ///< pose of the frame in the link's frame
  Eigen::Isometry3d target = Eigen::Isometry3d::Identity();  ///< target pose of the frame in the world
  /// Which directions are free, along and about the target's axes: x, y, z, rx, ry, rz. None, one or all
  /// three of the rotations may be free. If one is free, the frame's axis of that name must point in the same
  /// direction as the target's.
  std::array<bool, 6> free{};
};

/// A placement as equality constraints. First the frame's position relative to the target, in the target's
/// axes; then the rotation vector from target to frame. If one rotation is free, it is the rotation vector
/// that tilts the target's axis into the frame's axis. The rows are zero only if the link is placed. The
/// rotations have a singularity only at half a turn.
class PlacementRows : public PostureRows {
 public:
  /// @throws Error for two free rotations, and for a link that does not exist.
  PlacementRows(const Kinematics& kinematics, Placement placement);

  Kind kind() const override { return Kind::equal; }
  int size() const override { return static_cast<int>(rows_.size()); }
  std::string name(int row) const override;
  std::string unit(int row) const override { return rows_[static_cast<std::size_t>(row)] < 3 ? "m" : "rad"; }
  void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values, Eigen::Ref<RowMatrix> jacobian) override;

 private:
  // Rotational error in the target's axes, and the matrix that turns an angular velocity into its rate.
  void rotation(const Eigen::Matrix3d& frame, Eigen::Vector3d& error, Eigen::Matrix3d& rate) const;

  Placement placement_;
  std::vector<int> rows_;  // directions that are not free
  int freeAxis_ = -1;
  struct Carrier {
    std::size_t motion;
    int coordinate;
  };
  std::vector<Carrier> carriers_;
};

/// A robot and its obstacles, loaded once for any number of tasks.
struct PostureScene {
  std::shared_ptr<const RobotModel> robot;        ///< never null
  std::shared_ptr<const RobotGeometry> geometry;  ///< never null
  std::shared_ptr<const Srdf> srdf;               ///< null without one
  std::vector<Obstacle> obstacles;                ///< static obstacles
  /// The robot's own pairs to check, for example from searchedPairs(). Without a value: the pairs that the
  /// SRDF leaves, or, without an SRDF, a new search for each task.
  std::optional<std::vector<CheckedPair>> selfPairs = std::nullopt;
};

/// The robot's own pairs to check if there is no SRDF: all pairs except those that pairList() leaves out
/// because of the joint tree or its samples. Takes about a second for a humanoid.
std::vector<CheckedPair> searchedPairs(std::shared_ptr<const RobotModel> robot,
                                       std::shared_ptr<const RobotGeometry> geometry);

/// All pairs of some links with some obstacles. If `self` is given, all pairs of these links with some other
/// links of the robot; those with obstacles are added if obstacles are named. An empty list means all of its
/// kind.
struct LinkObstacles {
  std::vector<std::string> links;                ///< names; empty: all
  std::vector<std::string> obstacles;            ///< names; empty: all, or none if `self` is given
  std::optional<std::vector<std::string>> self;  ///< other links, by name

  /// Whether pairs with obstacles are included.
  bool withObstacles() const { return !self || !obstacles.empty(); }
};

/// A task, with the contents of its file (docs/posture.md). Lengths in m, angles in rad.
struct PostureTask {
  std::string path;                        ///< path of the task file, for messages
  BaseMotion base = BaseMotion::floating;  ///< how the base moves
  bool saysBase = true;                    ///< whether the file states `base`; otherwise it is the default
  std::string state;                       ///< SRDF state to start from; "" for the neutral configuration
  /// Pose of the root link at the start. A fixed base keeps it. A planar base keeps its height, and has no
  /// roll or pitch.
  Eigen::Isometry3d basePose = Eigen::Isometry3d::Identity();
  /// Values at the start by coordinate (Kinematics::names()). They override the values of `state` and
  /// `basePose`.
  std::map<std::string, double> joints;
  /// The cost's reference is the start, instead of the reference of eq. 3.
  bool towardsStart = false;
  /// Weights of joints or coordinates in the cost; they override those of eq. 3.
  std::map<std::string, double> weights;
  /// Rotates the axes in which the task is given into axes with z upwards; set by withBaseAtOrigin().
  Eigen::Matrix3d toWorld = Eigen::Matrix3d::Identity();
  /// A placement, with the link's name.
  struct Place {
    std::string link;     ///< name of the link
    Placement placement;  ///< its `link` index is set later, by name
  };
  std::vector<Place> placements;  ///< frames that must reach their targets
  /// A link in contact with the ground.
  struct Touch {
    std::string link;                     ///< name of the link
    std::vector<Eigen::Vector3d> points;  ///< in the link's frame (m)
  };
  std::vector<Touch> contacts;        ///< empty: no static stability
  double stabilityMargin = 0;         ///< margin of the static stability (m)
  double collisionMargin = 0;         ///< margin of the distances (m)
  bool selfCollisions = true;         ///< whether to check the robot's own pairs
  std::vector<LinkObstacles> pairs;   ///< pairs to check; empty: every body against every obstacle
  std::vector<LinkObstacles> ignore;  ///< pairs to leave out, of `pairs` and of the robot's own
  /// Whether to split concave links into convex parts, for pairs that prevent a posture although their meshes
  /// are farther apart. Only the code that makes the scene's bodies uses this, such as the program
  /// find_posture. setUp() takes the bodies as they are.
  bool partsAuto = false;
  /// If above 1: split all concave links into at most this many convex parts each; used like `partsAuto`.
  int parts = 1;
  /// Set by withBaseAtOrigin(): the base's pose of the state is already taken into account.
  bool seenFromBase = false;
};

/// Reads a task file. @throws Error naming the file and the key, and what would work.
PostureTask loadTask(const std::string& path);
/// loadTask() from a text; `path` stands for the file in messages.
PostureTask parseTask(const std::string& text, const std::string& path);

/// The optimisation problem of a task, and its start.
struct PostureSetup {
  std::shared_ptr<PostureProblem> problem;  ///< never null
  Eigen::VectorXd start;                    ///< q
  /// How far random starts go from `start`, one entry per coordinate: infinite, for as far as the limits
  /// allow, except for joints that slide more than a hundred times as far as bodies can meet. None: all
  /// infinite.
  Eigen::VectorXd spread;
  /// The pairs that the problem keeps apart. Pairs whose bodies cannot move relative to each other are only
  /// checked; if they collide they are in PostureProblem::unavoidable().
  std::vector<CheckedPair> pairs;
};

/// The coordinates of the task's start. @throws Error naming the task's key.
Eigen::VectorXd startOf(const PostureTask& task, const PostureScene& scene, const Kinematics& kinematics);
/// The pairs that the task must keep apart. @throws Error naming the task's key.
std::vector<CheckedPair> pairsOf(const PostureTask& task, const PostureScene& scene);
/// Transforms a task and its scene to the frame in which Kinematics places the base. For a fixed base the
/// root link is then at the origin; for a planar base it is at height 0. Obstacles and targets are moved by
/// the inverse. setUp() does this itself; call it to show a posture among obstacles. @throws Error for a
/// planar base that is tilted, and for a state that moves the base if `basePose` does not.
std::pair<PostureTask, PostureScene> withBaseAtOrigin(PostureTask task, PostureScene scene);
/// The problem of a task without its collision constraints. @throws Error naming the task's key.
PostureSetup setUpWithoutCollisions(const PostureTask& task, const PostureScene& scene);
/// Added to a collision margin in the constraints (m). It is larger than the solver's tolerance, so that a
/// feasible posture keeps the margin itself.
constexpr double kBeyondMargin = 2e-6;
/// The problem of a task with its collision constraints. A pair costs only one test of bounding spheres if it
/// is farther apart than the margin (or 0 if the margin is negative) plus `influence` (m). @throws Error
/// naming the task's key.
PostureSetup setUp(const PostureTask& task, const PostureScene& scene, double influence = 0.2);

}  // namespace fcl_stpbv
