// The scenarios of the controller's benchmark: a robot's arm or leg with a held body, the near bodies, and
// the desired motion.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/constraints.h"

namespace fcl_stpbv::benchmark {

/// The controller's model of the bodies.
enum class Model {
  none,  ///< no collision rows: the lower limit of all figures
  hull,  ///< convex hulls with a margin r
  /// A row for each near pair of a vertex and a body, or of two edges, of hulls with a margin r.
  manifold,
  smooth,  ///< STP-BVs
  half     ///< an STP-BV against flat obstacles with a margin r
};

struct Method {
  Model model;
  double r, R;  ///< m
  std::string name;
  bool bare = false;  ///< whether flat obstacles have no margin
};

/// Sum of the margins that a method adds between its bodies (m).
double margins(const Method& method);

/// What varies between the runs of a scenario.
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

/// A convex body, given by its corners.
struct Solid {
  int link;  ///< the link that holds it; -1: the world
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
  std::vector<std::pair<int, int>> pairs;  ///< pairs of solids
  double begin;                            ///< end of the approach (s)
  std::string scenario;
  Variation variation;

  /// Desired pose of a hand at a time.
  Eigen::Isometry3d target(const Hand& hand, double time) const;
};

const std::vector<std::string>& scenarios();

/// @throws Error for an unknown scenario.
Scene makeScene(const std::string& scenario, int seed);

/// The scene's pairs with the bodies of a method. A hull's margins are not part of its distances. Null for
/// `none`.
std::unique_ptr<CollisionConstraints> constraintsOf(const Scene& scene, const Method& method);

}  // namespace fcl_stpbv::benchmark
