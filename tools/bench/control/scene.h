// Where a controller runs along something: a robot's arm or leg with what it holds,
// what is near, and the motion asked for.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv::benchmark {

/// How bodies are seen by the controller.
enum class Model {
  none,      ///< no collision rows: the floor of all figures
  hull,      ///< convex hulls with a margin r around
  manifold,  ///< a row for each near pair of a vertex and a body, or of two edges, of hulls with a margin r
             ///< around
  smooth,    ///< STP-BVs
  half       ///< an STP-BV against flat obstacles with a margin r around
};

struct Method {
  Model model;
  double r, R;  ///< m
  std::string name;
  bool bare = false;  ///< flat obstacles have no margin
};

/// What a method's margins add to the distances of its bodies (m).
double margins(const Method& method);

/// What one run of a scenario varies.
struct Variation {
  double phase[6], size, tilt, start[3];
};
Variation variationOf(int seed);

/// A link that follows a path.
struct Hand {
  int link;
  Eigen::Isometry3d start;
  double side;  ///< +1 left, -1 right
};

/// A convex body by its corners.
struct Solid {
  int link;  ///< -1: the world
  Eigen::Isometry3d pose;
  std::vector<Eigen::Vector3d> corners;
};

/// The corners of a box around the origin with these sides (m).
std::vector<Eigen::Vector3d> boxCorners(const Eigen::Vector3d& size);

struct Scene {
  std::shared_ptr<const Kinematics> kinematics;
  std::vector<int> joints;  ///< the coordinates that the controller moves
  Eigen::VectorXd start;
  std::vector<Hand> hands;
  std::vector<Solid> solids;
  std::vector<std::pair<int, int>> pairs;  ///< of solids
  double begin;                            ///< what comes before is the approach (s)
  std::string scenario;
  Variation variation;

  /// Pose asked of a hand at a time.
  Eigen::Isometry3d target(const Hand& hand, double time) const;
};

const std::vector<std::string>& scenarios();

/// @throws Error for an unknown scenario.
Scene makeScene(const std::string& scenario, int seed);

/// The scene's pairs as that method sees them; a hull's margins are not in its distances. Null for `none`.
std::unique_ptr<CollisionConstraints> constraintsOf(const Scene& scene, const Method& method);

}  // namespace fcl_stpbv::benchmark
