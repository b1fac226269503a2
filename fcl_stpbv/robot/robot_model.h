// The contents of a URDF: a robot's links, joints and shapes, checked and in the order of the tree.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "fcl_stpbv/error.h"

namespace fcl_stpbv {

namespace detail {
/// Makes a program with incompatible compiler flags fail at link time. The memory layout of Eigen's types
/// depends on the flags: -march=native and -mavx align them to more bytes, and -fsanitize=address allocates
/// them differently. Such a program would access members of a robot at wrong addresses and free memory that
/// was never allocated. So only the library defines this symbol, for its own flags (docs/tutorial.md, 1).
template <int alignment, int byMalloc>
struct [[gnu::visibility("default")]] EigenMemory {
  static void asInTheLibrary();  ///< Does nothing.
};
extern template struct EigenMemory<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED>;
[[gnu::used]] static void (*const eigenMemory)() =
    &EigenMemory<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED>::asInTheLibrary;
}  // namespace detail

/// Faults found while loading. Each entry is a whole message that names the file, the element and what would
/// work.
struct LoadFaults {
  std::vector<std::string> errors;    ///< the robot cannot be loaded
  std::vector<std::string> shapes;    ///< one shape per entry cannot be read; the others are sound
  std::vector<std::string> warnings;  ///< nothing is missing in the model because of these

  /// Runs `read`. If it throws an Error, the message is added to `list`.
  template <class Read>
  static void gather(std::vector<std::string>& list, Read read) {
    try {
      read();
    } catch (const Error& error) {
      list.emplace_back(error.what());
    }
  }

  /// @throws Error if there are entries in `errors` or, unless `leaveOutShapes`, in `shapes`; its message
  /// lists them.
  void refuse(bool leaveOutShapes = false) const;
};

/// The type of a joint, as in the URDF.
enum class JointType { fixed, revolute, continuous, prismatic, planar, floating };

/// A mimic joint's rule: its value is `multiplier` times the other joint's value plus `offset`.
struct Mimic {
  int joint;          ///< index of the joint that is followed
  double multiplier;  ///< factor of that joint's value
  double offset;      ///< rad or m
};

/// A joint. Lengths in m, angles in rad.
struct JointModel {
  std::string name;                                          ///< as the URDF names it
  JointType type = JointType::fixed;                         ///< type of the joint
  int parent = -1;                                           ///< index of the parent link
  int child = -1;                                            ///< index of the child link
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();  ///< the joint's frame in the parent link's frame
  /// Unit vector in the joint's frame; for a planar joint the normal of the plane.
  Eigen::Vector3d axis{1, 0, 0};
  /// Lower limit (rad or m); for a continuous joint -pi, or less if a joint that mimics it needs several
  /// turns.
  double lower = 0;
  double upper = 0;  ///< upper limit (rad or m); for a continuous joint pi, or more for the same reason
  std::optional<Mimic> mimic;  ///< set for a mimic joint; the joint it follows is never a mimic joint itself
};

/// A collision or visual shape of a link.
struct ShapeModel {
  /// The kinds of shapes.
  enum class Kind { sphere, capsule, box, cylinder, mesh };
  Kind kind = Kind::mesh;                                  ///< the shape's kind
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the link's frame
  /// Box: side lengths; other kinds: radius and length, for a capsule without its caps (m).
  Eigen::Vector3d size{0, 0, 0};
  std::string mesh;                ///< as the URDF names it
  Eigen::Vector3d scale{1, 1, 1};  ///< scale of the mesh; a negative value mirrors it
  /// Number of URDF elements that this shape was made from: 3 for a capsule made of a cylinder and two
  /// spheres.
  int elements = 1;
  std::string place;  ///< for messages: file, line, link and number of the shape
};

/// A link with its shapes and mass.
struct LinkModel {
  std::string name;                   ///< as the URDF names it
  std::vector<ShapeModel> collision;  ///< in the order of the file
  std::vector<ShapeModel> visual;     ///< in the order of the file
  int parentJoint = -1;               ///< index of the joint to its parent; -1 for the root
  double mass = 0;                    ///< kg; 0 without an inertial element, or with a wrong one
  std::string massFault;  ///< what is wrong with the inertial element, and where; "" if it is sound
  Eigen::Vector3d centreOfMass{0, 0, 0};  ///< in the link's frame (m)
  bool lacksCollision = false;            ///< whether a collision shape of the file could not be read
  bool lacksVisual = false;               ///< the same for the visual shapes
};

/// A robot as its URDF describes it: a tree of links.
struct RobotModel {
  std::string name;                ///< name of the robot
  std::string path;                ///< path of the URDF
  std::vector<LinkModel> links;    ///< parents before their children; the root first
  std::vector<JointModel> joints;  ///< in the order of the file
  /// Faults of visual shapes that cannot be read; an error only when visual shapes are used.
  std::vector<std::string> visualFaults;

  /// Index by name, -1 if there is none.
  int link(const std::string& name) const;
  /// Index by name, -1 if there is none.
  int joint(const std::string& name) const;
};

/// Reads a URDF. A cylinder with a sphere of the same radius at both ends becomes a capsule, and so does
/// `<capsule>`. Either every `<collision>` element of the file is in the model, or loading fails. A wrong
/// `<inertial>` element is only a warning, and the link gets no mass.
/// @throws Error listing everything that is wrong, with line numbers: links that form a loop or have two
/// parents, a mimic joint that follows itself, a lower limit above the upper one, numbers that are not
/// finite, names that look misspelt.
RobotModel loadUrdf(const std::string& path);
/// loadUrdf() that adds faults to `faults`, and the caller decides. Shapes that cannot be read are then
/// missing in the model. If there are errors, use the model only to search for further faults.
RobotModel loadUrdf(const std::string& path, LoadFaults& faults);
/// loadUrdf() from a text; `path` stands for the file in messages.
RobotModel parseUrdf(const std::string& text, const std::string& path);
/// parseUrdf() that adds faults to `faults`, and the caller decides.
RobotModel parseUrdf(const std::string& text, const std::string& path, LoadFaults& faults);

}  // namespace fcl_stpbv
