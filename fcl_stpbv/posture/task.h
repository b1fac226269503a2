// What a robot is asked to do: placements of its links, static stability, its task file, and the optimisation
// problem made of it.
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

/// Mass and centre of mass of a robot's links, and how the coordinates move it.
class CentreOfMass {
 public:
  /// @throws Error for a robot without mass.
  explicit CentreOfMass(const Kinematics& kinematics);

  /// Of all links (kg).
  double mass() const { return mass_; }
  /// World frame. `jacobian` (3 x coordinates) is overwritten. @throws Error for another size, or the state
  /// of another robot.
  Eigen::Vector3d evaluate(const Kinematics::State& state, Eigen::Ref<Eigen::Matrix3Xd> jacobian);

 private:
  struct Link {
    int parent;
    double mass;
    Eigen::Vector3d centre;
  };
  struct Motion {
    int link;  // the first one that it carries
    int coordinate;
  };
  std::vector<Link> links_;
  std::vector<Motion> motions_;
  double mass_ = 0;
  int coordinates_ = 0;
  std::vector<double> below_;                 // mass of each link and all below it
  std::vector<Eigen::Vector3d> momentBelow_;  // their masses times positions
};

/// Points of one link that touch the ground: the corners of a convex patch, or any points of it.
struct Contact {
  int link = 0;                         ///< index into RobotModel::links
  std::vector<Eigen::Vector3d> points;  ///< in the link's frame (m)
};

/// The corners of a flat convex patch moved inwards so that each edge moves by `margin` (m). One or two
/// points have no inside: they stay where they are with a margin of 0. @throws Error where nothing is left,
/// and for a margin that is below 0 or no number.
std::vector<Eigen::Vector3d> shrunk(const std::vector<Eigen::Vector3d>& points, double margin);

/// Rows: the centre of mass, seen along z, is the sum of w_k times contact point k, with w_k >= 0 of sum 1.
/// The weights are variables of their own, from x[firstWeight] on, so that contacts may move with the posture
/// and nothing jumps as they do. Each contact, as it is seen along z, is shrunk by the margin, so the
/// centre of mass keeps at least that far from the support polygon's edges however the contacts are tilted.
class StaticStability : public PostureRows {
 public:
  /// Keeps a reference to `kinematics`. `margin` in m; with one, room() belongs to the problem as well.
  /// `world` turns the axes that `kinematics` has for the world's into those with z upwards.
  /// @throws Error where a contact has nothing left, and for a link that does not exist.
  StaticStability(const Kinematics& kinematics, const std::vector<Contact>& contacts, double margin,
                  int firstWeight, const Eigen::Matrix3d& world = Eigen::Matrix3d::Identity());

  /// Rows, not to be negative, that keep each contact wide enough for the margin as it is seen along z, and 3
  /// degrees from upright. Null without a margin. They refer to `kinematics` too.
  std::shared_ptr<PostureRows> room() const;
  /// Number of weights, one per contact point.
  int weights() const { return weights_; }
  Kind kind() const override { return Kind::equal; }
  int size() const override { return 3; }
  std::string name(int row) const override;
  void evaluate(const Point& at, Eigen::Ref<Eigen::VectorXd> values, Eigen::Ref<RowMatrix> jacobian) override;

 private:
  struct Patches;  // of the contacts

  const Kinematics& kinematics_;
  CentreOfMass centre_;
  std::shared_ptr<Patches> patches_;
  std::vector<std::vector<Kinematics::Dependence>> carriers_;  // of each contact
  Eigen::Matrix3d world_;
  int firstWeight_, weights_ = 0;
  Eigen::Matrix3Xd centreJacobian_;
};

/// A frame of a link and where it is to be.
struct Placement {
  std::string name;                                          ///< for messages
  int link = 0;                                              ///< index into RobotModel::links
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();   ///< in the link's frame
  Eigen::Isometry3d target = Eigen::Isometry3d::Identity();  ///< in the world
  /// Along and about the target's axes: x, y, z, rx, ry, rz. Of the rotations none, one or all are free; with
  /// one, the frame's axis of that name points as the target's.
  std::array<bool, 6> free{};
};

/// Rows that vanish where the link is placed: the frame's position in the target's axes, then the rotation
/// vector from target to frame, or with a free axis the rotation vector that tilts the target's axis into the
/// frame's. Neither vanishes anywhere else; both have a singularity at half a turn only.
class PlacementRows : public PostureRows {
 public:
  /// @throws Error for two free rotations, and for a link that does not exist.
  PlacementRows(const Kinematics& kinematics, Placement placement);

  Kind kind() const override { return Kind::equal; }
  int size() const override { return static_cast<int>(rows_.size()); }
  std::string name(int row) const override;
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
  bool saysBase = true;                    ///< whether the file says so, or it is the default
  std::string state;                       ///< SRDF state to start from; "" for the neutral configuration
  /// Of the root link, at the start; for good where the base is fixed. A planar one keeps its height, and
  /// has no roll or pitch.
  Eigen::Isometry3d basePose = Eigen::Isometry3d::Identity();
  /// At the start, over those of the state and of the base's pose. Names of coordinates
  /// (Kinematics::names()).
  std::map<std::string, double> joints;
  bool towardsStart = false;              ///< the cost's reference is the start instead of eq. 3's
  std::map<std::string, double> weights;  ///< of joints or coordinates in the cost, over those of eq. 3
  /// Turns the axes in which all is given into those with z upwards: withBaseAtOrigin().
  Eigen::Matrix3d toWorld = Eigen::Matrix3d::Identity();
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
  std::vector<LinkObstacles> pairs;   ///< checked; none: every body against every obstacle
  std::vector<LinkObstacles> ignore;  ///< left out all the same
  /// Concave links are split for the pairs that are in the way although their meshes are farther apart. For
  /// the program find_posture, or whoever makes the scene's bodies: setUp() takes these as they are.
  bool partsAuto = false;
  int parts = 1;              ///< or all of them into so many convex parts at most
  bool seenFromBase = false;  ///< withBaseAtOrigin() has been here: the state's pose of the base is settled
};

/// @throws Error naming the file and the key, and what would work.
PostureTask loadTask(const std::string& path);
/// The same from a text; `path` stands for it in messages.
PostureTask parseTask(const std::string& text, const std::string& path);

/// The problem of a task and where to start.
struct PostureSetup {
  std::shared_ptr<PostureProblem> problem;  ///< never null
  Eigen::VectorXd start;                    ///< q
  /// Kept apart, or where nothing moves one body against the other, checked: PostureProblem::still().
  std::vector<CheckedPair> pairs;
};

/// The coordinates of the task's start. @throws Error naming the task's key.
Eigen::VectorXd startOf(const PostureTask& task, const PostureScene& scene, const Kinematics& kinematics);
/// The pairs that the task asks to keep apart. @throws Error naming the task's key.
std::vector<CheckedPair> pairsOf(const PostureTask& task, const PostureScene& scene);
/// The same task as seen from a fixed base, whose root link then stands at the origin, and from the height of
/// a planar one: Kinematics has them there. Obstacles and targets are moved the other way. setUp() does so by
/// itself; this is for whoever shows a posture among obstacles. @throws Error for a planar base that is
/// tilted, and for a state that moves the base where basePose does not.
std::pair<PostureTask, PostureScene> withBaseAtOrigin(PostureTask task, PostureScene scene);
/// All but the collisions. @throws Error naming the task's key.
PostureSetup setUpWithoutCollisions(const PostureTask& task, const PostureScene& scene);
/// Asked for beyond a collision margin (m): more than a solver's tolerance, so that what it calls feasible
/// keeps the margin itself.
constexpr double kBeyondMargin = 2e-6;
/// The program of a task with its collision rows. Pairs farther apart than the margin, at least 0, plus
/// `influence` (m) cost one test of their bounding spheres. @throws Error naming the task's key.
PostureSetup setUp(const PostureTask& task, const PostureScene& scene, double influence = 0.2);

}  // namespace fcl_stpbv
