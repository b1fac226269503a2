// What a URDF says about a robot's links, joints and shapes, checked and in the order of the tree.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv {

namespace detail {
/// Where Eigen's types lie depends on the compiler's flags: -march=native and -mavx align them to more bytes,
/// -fsanitize=address takes their memory in another way. A program with other flags than the library would
/// read beside the members of a robot and free what was not allocated, so it does not link: only the library
/// has this, for its own flags (docs/tutorial.md, 1).
template <int alignment, int byMalloc>
struct [[gnu::visibility("default")]] EigenMemory {
  static void asInTheLibrary();  ///< Does nothing.
};
extern template struct EigenMemory<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED>;
[[gnu::used]] static void (*const eigenMemory)() =
    &EigenMemory<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED>::asInTheLibrary;
}  // namespace detail

/// Each entry is a whole message that names the file, the element and what would work.
struct LoadFaults {
  std::vector<std::string> errors;    ///< the robot cannot be loaded with these
  std::vector<std::string> shapes;    ///< each costs one shape; the others are sound
  std::vector<std::string> warnings;  ///< nothing is lost by these

  /// Runs `read`; an Error it throws becomes an entry of `list`.
  template <class Read>
  static void gather(std::vector<std::string>& list, Read read) {
    try {
      read();
    } catch (const Error& error) {
      list.emplace_back(error.what());
    }
  }

  /// @throws Error listing the errors and, unless they are to be left out, the shapes; where there are any.
  void refuse(bool leaveOutShapes = false) const;
};

/// How a joint moves, as the URDF says it.
enum class JointType { fixed, revolute, continuous, prismatic, planar, floating };

/// Value of a mimic joint: `multiplier` times the other joint's plus `offset`.
struct Mimic {
  int joint;          ///< index of the joint that is followed
  double multiplier;  ///< of that joint's value
  double offset;      ///< rad or m
};

/// A joint. Lengths in m, angles in rad.
struct JointModel {
  std::string name;                                          ///< as the URDF names it
  JointType type = JointType::fixed;                         ///< how it moves
  int parent = -1;                                           ///< link above it
  int child = -1;                                            ///< link below it
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< of the joint's frame in the parent link's
  Eigen::Vector3d axis{1, 0, 0};                             ///< unit; a planar joint's normal
  double lower = 0;  ///< rad or m; of a continuous joint -pi, less where what mimics it needs several turns
  double upper = 0;  ///< rad or m; of a continuous joint pi, or more likewise
  std::optional<Mimic> mimic;  ///< never of a joint that mimics itself
};

/// A shape of a link, for collision or for looks.
struct ShapeModel {
  /// What a shape can be.
  enum class Kind { sphere, capsule, box, cylinder, mesh };
  Kind kind = Kind::mesh;                                  ///< which one it is
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the link's frame
  Eigen::Vector3d size{0, 0, 0};   ///< box: sides; else radius and length (without a capsule's caps) (m)
  std::string mesh;                ///< as the URDF names it
  Eigen::Vector3d scale{1, 1, 1};  ///< of the mesh, negative mirrors
  int elements = 1;   ///< of the URDF that became this shape: 3 for a capsule joined from its parts
  std::string place;  ///< for messages: file, line, link and which of its shapes
};

/// A link and what hangs on it.
struct LinkModel {
  std::string name;                   ///< as the URDF names it
  std::vector<ShapeModel> collision;  ///< in the order of the file
  std::vector<ShapeModel> visual;     ///< likewise
  int parentJoint = -1;               ///< -1 for the root
  double mass = 0;                    ///< kg; 0 without an inertial element, or with a wrong one
  std::string massFault;  ///< what is wrong with the inertial element, and where; "" where it is sound
  Eigen::Vector3d centreOfMass{0, 0, 0};  ///< in the link's frame (m)
  bool lacksCollision = false;            ///< whether a collision shape that the file has could not be read
  bool lacksVisual = false;               ///< the same of the visual shapes
};

/// A robot as its URDF describes it: a tree of links.
struct RobotModel {
  std::string name;                ///< of the robot
  std::string path;                ///< of the URDF
  std::vector<LinkModel> links;    ///< parents before their children; the root first
  std::vector<JointModel> joints;  ///< in the order of the file
  std::vector<std::string>
      visualFaults;  ///< visual shapes that cannot be read; no matter until they are used

  /// Index by name, -1 if there is none.
  int link(const std::string& name) const;
  /// Index by name, -1 if there is none.
  int joint(const std::string& name) const;
};

/// Reads a URDF. A cylinder with a sphere of its radius at either end is a capsule, and so is `<capsule>`.
/// Every `<collision>` element of the text is in the model, or the robot is refused; nothing else in the file
/// can take one away. A bad `<inertial>` is a warning, and the link counts as without mass.
/// @throws Error naming all that is wrong, each with its line: links that form a loop or have
/// two parents, a mimic joint that follows itself, limits that exclude each other, numbers
/// that are not finite, words that look misspelt.
RobotModel loadUrdf(const std::string& path);
/// The same, but what is wrong is added to `faults` for the caller to refuse. Shapes that cannot be read are
/// not in the model then, and where there are errors the model is only fit to look for more of them.
RobotModel loadUrdf(const std::string& path, LoadFaults& faults);
/// The same from a text; `path` stands for it in messages.
RobotModel parseUrdf(const std::string& text, const std::string& path);
/// The same, but what is wrong is added to `faults` for the caller to refuse.
RobotModel parseUrdf(const std::string& text, const std::string& path, LoadFaults& faults);

}  // namespace fcl_stpbv
