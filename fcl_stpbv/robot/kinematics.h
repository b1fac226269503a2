// Forward kinematics: the poses of a robot's links at a configuration, and how each coordinate moves them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/robot_model.h"
#include "fcl_stpbv/robot/srdf.h"

namespace fcl_stpbv {

/// How the root link can move in the world.
enum class BaseMotion { fixed, planar, floating };

/// Velocity of a rigid body per unit of one coordinate. `linear` is the velocity of the body-fixed point that
/// is at the world's origin (spatial velocity). World axes.
struct Twist {
  Eigen::Vector3d linear{0, 0, 0};   ///< m/s, or m per unit
  Eigen::Vector3d angular{0, 0, 0};  ///< rad/s, or rad per unit
};

/// The coordinates q of a robot: first those of a moving base, then those of the joints in the order of the
/// URDF. A revolute, continuous or prismatic joint has one (rad or m). A planar joint has x, y and angle. A
/// floating joint has a position and a rotation vector (axis times angle, in the joint's frame; keep the
/// angle below pi). A mimic joint has none.
class Kinematics {
 public:
  /// One degree of freedom of one joint. For a mimic joint the coordinate is that of the joint it follows.
  struct Motion {
    int joint;          ///< index of the joint; -1 for the base
    int coordinate;     ///< in q
    double multiplier;  ///< how far the joint moves per unit of the coordinate
  };

  /// A motion that changes the pose of two links relative to each other. `sign` is +1 if it moves the second
  /// link but not the first, -1 if it moves the first but not the second. A motion that moves both cancels
  /// and is left out.
  struct Dependence {
    int motion;   ///< index into motions()
    double sign;  ///< +1 or -1
  };

  /// Poses and motions at one configuration. Make it once with makeState() and reuse it.
  struct State {
    std::vector<Eigen::Isometry3d> link;  ///< pose of each link in the world
    /// Velocity of the links below each motion, per unit of its coordinate (the multiplier is included).
    std::vector<Twist> motion;
  };

  /// Time derivatives of a State while q moves.
  struct Rate {
    std::vector<Twist> link;    ///< velocity of each link
    std::vector<Twist> motion;  ///< time derivative of each motion's twist
    std::vector<Twist> drift;   ///< time derivative of each link's velocity at constant velocity of q
  };

  /// Some links and all their ancestors: the links that must be computed to place them.
  class Subtree {
    friend class Kinematics;
    std::vector<int> steps_;  // parents first
  };

  /// Makes the coordinates for a robot with this base motion. @throws Error naming the robot's file if two
  /// coordinates have the same name, such as those of a planar joint `p` and a joint `p/x`.
  explicit Kinematics(std::shared_ptr<const RobotModel> robot, BaseMotion base = BaseMotion::fixed);

  /// The model given.
  const RobotModel& robot() const { return *robot_; }
  /// Number of coordinates.
  int size() const { return static_cast<int>(names_.size()); }
  /// Name of each coordinate: the joint's name, followed by `/x`, `/y`, `/angle`, `/z`, `/rx`, `/ry` or `/rz`
  /// if the joint has several coordinates.
  const std::vector<std::string>& names() const { return names_; }
  /// Lower limits of the coordinates (rad or m), -infinity for those without a limit.
  const Eigen::VectorXd& lower() const { return lower_; }
  /// Upper limits of the coordinates (rad or m), infinity for those without a limit.
  const Eigen::VectorXd& upper() const { return upper_; }
  /// All degrees of freedom, parents first.
  const std::vector<Motion>& motions() const { return motions_; }
  /// Whether the base has coordinates of its own.
  bool baseMoves() const { return !motions_.empty() && motions_.front().joint < 0; }

  /// The neutral configuration: all coordinates zero, clamped to the limits.
  const Eigen::VectorXd& neutral() const { return neutral_; }
  /// The neutral configuration with the values of an SRDF group_state. Joints that the robot does not have
  /// are ignored (loadSrdf() warns of them), and so is a virtual joint. @throws Error naming state and joint,
  /// if the number of values is wrong, or if the state gives a fixed or mimic joint a value that it cannot
  /// have.
  Eigen::VectorXd configuration(const Srdf::State& state) const { return configuration(state, neutral_); }
  /// configuration() with `rest`, of size() entries, instead of the neutral configuration.
  Eigen::VectorXd configuration(const Srdf::State& state, Eigen::VectorXd rest) const;
  /// First coordinate of a joint by name, -1 for fixed, mimic and unknown ones.
  int coordinate(const std::string& joint) const;

  /// A State of the right size for forward().
  State makeState() const;
  /// These links and their ancestors. @throws Error for a link that does not exist.
  Subtree subtree(const std::vector<int>& links) const;
  /// Fills the state. Never throws or allocates; `q` has size() entries.
  void forward(const Eigen::Ref<const Eigen::VectorXd>& q, State& state) const { forward(q, state, whole_); }
  /// forward() for a part of the robot. The rest of the state is not changed.
  void forward(const Eigen::Ref<const Eigen::VectorXd>& q, State& state, const Subtree& only) const;
  /// Fills only the links' poses, with the same values as forward(). A collision check needs no more.
  void forwardPoses(const Eigen::Ref<const Eigen::VectorXd>& q, State& state) const {
    forwardPoses(q, state, whole_);
  }
  /// forwardPoses() for a part of the robot.
  void forwardPoses(const Eigen::Ref<const Eigen::VectorXd>& q, State& state, const Subtree& only) const;

  /// A Rate of the right size for differentiate().
  Rate makeRate() const;
  /// Fills the rate of `state` while q moves with velocity v. `state` must be that of q. Never throws or
  /// allocates.
  void differentiate(const Eigen::Ref<const Eigen::VectorXd>& q, const Eigen::Ref<const Eigen::VectorXd>& v,
                     const State& state, Rate& rate) const {
    differentiate(q, v, state, rate, whole_);
  }
  /// differentiate() for a part of the robot that forward() has computed.
  void differentiate(const Eigen::Ref<const Eigen::VectorXd>& q, const Eigen::Ref<const Eigen::VectorXd>& v,
                     const State& state, Rate& rate, const Subtree& only) const;

  /// The motions that change the pose of link1 relative to link2. @throws Error for a link that does not
  /// exist.
  std::vector<Dependence> dependence(int link1, int link2) const;
  /// The motions that move a link in the world. @throws Error for a link that does not exist.
  std::vector<Dependence> dependence(int link) const;

 private:
  struct Step {  // one joint, or the base, ready for forward()
    JointType type;
    int parent, child;  // links; parent -1 is the world
    int motion;         // index of the first motion, -1 for none
    int coordinate;     // index of the first coordinate
    double multiplier, offset;
    Eigen::Isometry3d origin;
    Eigen::Vector3d axis;
    Eigen::Matrix3d plane;  // turns z into the axis
    // For a joint that turns, the columns of its frame in the parent's frame are
    // along + cos(angle) even + sin(angle) odd.
    Eigen::Matrix<double, 4, 3, Eigen::DontAlign> along, even, odd;

    /// The value of a joint with one axis (rad or m).
    double value(const Eigen::Ref<const Eigen::VectorXd>& q) const {
      return multiplier * q[coordinate] + offset;
    }
  };
  void addCoordinates(const std::string& name, JointType type, double lower, double upper);
  void addStep(int joint, const JointModel& model, int coordinate, double multiplier, double offset);
  template <bool withMotions>
  void place(const Step& step, const Eigen::Ref<const Eigen::VectorXd>& q, State& state) const;
  void placeFree(const Step& step, const Eigen::Ref<const Eigen::VectorXd>& q, State& state,
                 Twist* twist) const;
  void differentiate(const Step& step, const Eigen::Ref<const Eigen::VectorXd>& q,
                     const Eigen::Ref<const Eigen::VectorXd>& v, const State& state, Rate& rate) const;

  std::shared_ptr<const RobotModel> robot_;
  std::vector<std::string> names_;
  std::vector<int> coordinateOf_;  // first coordinate of each joint, -1 for none
  Eigen::VectorXd lower_, upper_, neutral_;
  std::vector<Motion> motions_;
  std::vector<Step> steps_;  // parents before children
  std::vector<int> stepOf_;  // the step that places each link, -1 for a fixed root
  Subtree whole_;            // all steps
};

}  // namespace fcl_stpbv
