// Where a robot's links are at a configuration, and how each coordinate moves them.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/robot_model.h"
#include "fcl_stpbv/robot/srdf.h"

namespace fcl_stpbv {

/// How the root link moves in the world.
enum class BaseMotion { fixed, planar, floating };

/// Velocity of a rigid body per unit of one coordinate: that of the world's origin as if carried by the body,
/// and the angular one. World axes.
struct Twist {
  Eigen::Vector3d linear{0, 0, 0};   ///< m/s, or m per unit
  Eigen::Vector3d angular{0, 0, 0};  ///< rad/s, or rad per unit
};

/// Coordinates q of a robot: joints in the order of the URDF, the moving base before them. One per revolute,
/// continuous or prismatic joint (rad, m); x, y and angle for a planar one; position and rotation vector
/// (axis times angle, in the joint's frame, best kept below pi) for a floating one; none for a mimic joint.
class Kinematics {
 public:
  /// One degree of freedom of one joint. A mimic joint's belongs to the coordinate it follows.
  struct Motion {
    int joint;          ///< -1 for the base
    int coordinate;     ///< in q
    double multiplier;  ///< how far the joint moves per unit of the coordinate
  };

  /// What the pair of two links depends on: `sign` is +1 where the motion carries the second link and not the
  /// first, -1 where it is the other way round. Motions of both cancel and are left out.
  struct Dependence {
    int motion;   ///< index into motions()
    double sign;  ///< +1 or -1
  };

  /// Room for one configuration, to be used again and again.
  struct State {
    std::vector<Eigen::Isometry3d> link;  ///< pose of each link in the world
    std::vector<Twist> motion;            ///< of the links below each motion, multiplier included
  };

  /// How a State changes as q moves.
  struct Rate {
    std::vector<Twist> link;    ///< velocity of each link
    std::vector<Twist> motion;  ///< change of each motion's twist
    std::vector<Twist> drift;   ///< change of each link's velocity while that of q stays what it is
  };

  /// Some links and all that carry them, down from the root: what has to be placed to place them.
  class Subtree {
    friend class Kinematics;
    std::vector<int> steps_;  // parents first
  };

  /// Coordinates for a robot whose base moves like that. @throws Error naming the robot's file where two
  /// coordinates have one name, as those of a planar joint `p` and of a joint `p/x`.
  explicit Kinematics(std::shared_ptr<const RobotModel> robot, BaseMotion base = BaseMotion::fixed);

  /// The model given.
  const RobotModel& robot() const { return *robot_; }
  /// Number of coordinates.
  int size() const { return static_cast<int>(names_.size()); }
  /// A joint's name, with `/x`, `/y`, `/angle`, `/z`, `/rx`, `/ry`, `/rz` after it where it has several.
  const std::vector<std::string>& names() const { return names_; }
  /// Least values of the coordinates (rad or m), -infinity where nothing limits them.
  const Eigen::VectorXd& lower() const { return lower_; }
  /// Largest values.
  const Eigen::VectorXd& upper() const { return upper_; }
  /// All degrees of freedom, parents first.
  const std::vector<Motion>& motions() const { return motions_; }
  /// Whether the base has coordinates of its own.
  bool baseMoves() const { return !motions_.empty() && motions_.front().joint < 0; }

  /// All zero, clamped into the limits.
  const Eigen::VectorXd& neutral() const { return neutral_; }
  /// The neutral configuration with what a group_state says. Joints that the robot does not have count for
  /// nothing (loadSrdf() warns of them), and so does a virtual joint.
  /// @throws Error naming state and joint: where the number of values is wrong, or a joint that is fixed or
  /// mimics another one would have another value than it takes.
  Eigen::VectorXd configuration(const Srdf::State& state) const { return configuration(state, neutral_); }
  /// The same with `rest`, of size() entries, in place of the neutral configuration.
  Eigen::VectorXd configuration(const Srdf::State& state, Eigen::VectorXd rest) const;
  /// First coordinate of a joint by name, -1 for fixed, mimic and unknown ones.
  int coordinate(const std::string& joint) const;

  /// Room for forward().
  State makeState() const;
  /// These links and their ancestors. @throws Error for a link that does not exist.
  Subtree subtree(const std::vector<int>& links) const;
  /// Fills the state. Never throws or allocates; `q` has size() entries.
  void forward(const Eigen::Ref<const Eigen::VectorXd>& q, State& state) const { forward(q, state, whole_); }
  /// Fills what a part of the robot has in the state, as it is in forward(); the rest stays.
  void forward(const Eigen::Ref<const Eigen::VectorXd>& q, State& state, const Subtree& only) const;
  /// Fills the links' poses alone, as they are in forward(): all that a collision check needs.
  void forwardPoses(const Eigen::Ref<const Eigen::VectorXd>& q, State& state) const {
    forwardPoses(q, state, whole_);
  }
  /// The same of a part of the robot.
  void forwardPoses(const Eigen::Ref<const Eigen::VectorXd>& q, State& state, const Subtree& only) const;

  /// Room for differentiate().
  Rate makeRate() const;
  /// Fills the rate of `state`, which is that of q, as q moves with velocity v. Never throws or allocates.
  void differentiate(const Eigen::Ref<const Eigen::VectorXd>& q, const Eigen::Ref<const Eigen::VectorXd>& v,
                     const State& state, Rate& rate) const {
    differentiate(q, v, state, rate, whole_);
  }
  /// The same of a part of the robot that forward() has placed.
  void differentiate(const Eigen::Ref<const Eigen::VectorXd>& q, const Eigen::Ref<const Eigen::VectorXd>& v,
                     const State& state, Rate& rate, const Subtree& only) const;

  /// The motions that change where one link is to the other. @throws Error for a link that does not exist.
  std::vector<Dependence> dependence(int link1, int link2) const;
  /// The motions that carry a link. @throws Error for one that does not exist.
  std::vector<Dependence> dependence(int link) const;

 private:
  struct Step {  // one joint, or the base, ready for forward()
    JointType type;
    int parent, child;  // links; parent -1 is the world
    int motion;         // first one, -1 for none
    int coordinate;     // first one
    double multiplier, offset;
    Eigen::Isometry3d origin;
    Eigen::Vector3d axis;
    Eigen::Matrix3d plane;  // turns z into the axis
    // The frame's columns in the parent's, of a joint that turns: along + cos(angle) even + sin(angle) odd.
    Eigen::Matrix<double, 4, 3, Eigen::DontAlign> along, even, odd;

    /// Of a joint along or about one axis.
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
  std::vector<int> coordinateOf_;  // of each joint, -1 for none
  Eigen::VectorXd lower_, upper_, neutral_;
  std::vector<Motion> motions_;
  std::vector<Step> steps_;  // parents before children
  std::vector<int> stepOf_;  // the step that places each link, -1 for a root that stands still
  Subtree whole_;            // all steps
};

}  // namespace fcl_stpbv
