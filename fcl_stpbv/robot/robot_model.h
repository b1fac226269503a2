// What a URDF says about a robot's links, joints and shapes, checked and in the order of the tree.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace fcl_stpbv {

enum class JointType { fixed, revolute, continuous, prismatic, planar, floating };

/// Value of a mimic joint: `multiplier` times the other joint's plus `offset`.
struct Mimic {
  int joint;
  double multiplier;
  double offset;
};

struct JointModel {
  std::string name;
  JointType type = JointType::fixed;
  int parent = -1, child = -1;  ///< links
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis{1, 0, 0};  ///< unit; a planar joint's normal
  double lower = 0, upper = 0;    ///< rad or m; -pi and pi for a continuous joint
  std::optional<Mimic> mimic;     ///< never of a joint that mimics itself
};

struct ShapeModel {
  enum class Kind { sphere, capsule, box, cylinder, mesh };
  Kind kind = Kind::mesh;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< in the link's frame
  Eigen::Vector3d size{0, 0, 0};   ///< box: sides; else radius and length (without a capsule's caps) (m)
  std::string mesh;                ///< as the URDF names it
  Eigen::Vector3d scale{1, 1, 1};  ///< of the mesh, negative mirrors
};

struct LinkModel {
  std::string name;
  std::vector<ShapeModel> collision, visual;
  int parentJoint = -1;                   ///< -1 for the root
  double mass = 0;                        ///< kg; 0 without an inertial element
  Eigen::Vector3d centreOfMass{0, 0, 0};  ///< in the link's frame (m)
};

struct RobotModel {
  std::string name;
  std::string path;                ///< of the URDF
  std::vector<LinkModel> links;    ///< parents before their children; the root first
  std::vector<JointModel> joints;  ///< in the order of the file

  /// Index by name, -1 if there is none.
  int link(const std::string& name) const;
  int joint(const std::string& name) const;
};

/// Reads a URDF. A cylinder with a sphere of its radius at either end is a capsule, and so is `<capsule>`.
/// @throws Error naming the file, the link or the joint and what is wrong with it: links that form a loop or
/// have two parents, a mimic joint that follows itself, limits that exclude each other, numbers that are not
/// finite.
RobotModel loadUrdf(const std::string& path);
/// The same from a text; `path` stands for it in messages.
RobotModel parseUrdf(const std::string& text, const std::string& path);

}  // namespace fcl_stpbv
