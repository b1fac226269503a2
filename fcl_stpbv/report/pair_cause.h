// The cause of a collision of two links: their meshes, their convex hulls, or the margins r and R.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fcl_stpbv/report/mesh_distance.h"
#include "fcl_stpbv/robot/constraints.h"
#include "fcl_stpbv/robot/volume_cache.h"

namespace fcl_stpbv::report {

inline constexpr const char* kMeshesMeet = "meshes meet";
inline constexpr const char* kHullOnly = "hull only";      ///< the convex hulls meet, the meshes do not
inline constexpr const char* kMarginOnly = "margin only";  ///< the volumes meet, the hulls do not
/// Result for a pair of links, or a link and an obstacle, in one configuration.
struct PairCause {
  double meshDistance = 0;  ///< least of all pairs of their bodies, 0 if two of them meet (m)
  std::string cause;        ///< one of the above; "" if the volumes are farther apart than the margin
};

/// Measures the meshes behind volumes. Each file is read again when it is first needed, once for all bodies
/// that it stands for, and kept.
class PairCauses {
 public:
  /// `scene`: the bodies behind `obstacles`, in their order. Results for pairs of meshes are stored in
  /// `cache` if it is given; it must outlive this object.
  PairCauses(std::shared_ptr<const Kinematics> kinematics, std::shared_ptr<const RobotGeometry> robot,
             std::vector<Obstacle> obstacles, std::shared_ptr<const RobotGeometry> scene,
             detail::VolumeCache* cache = nullptr);

  /// Volumes, hulls and meshes collide if their distance is not above `margin` (m). Meshes at the distance 0
  /// collide also if the margin is negative. `bodies` are those of one pair of links.
  PairCause explain(const std::vector<CheckedPair>& bodies, const Eigen::VectorXd& q, double margin);

  /// Uses the same robot with other parts from now on.
  void use(std::shared_ptr<const RobotGeometry> robot);

  /// The exact body behind a body of the robot or the scene; for a part it is the whole mesh.
  const ExactBody& exact(const Body& body);

 private:
  struct Placed {
    const ExactBody* body;
    const fcl::CollisionGeometryd* hull;
    Eigen::Isometry3d pose;
  };
  PairCause measured(const std::vector<CheckedPair>& bodies, const Eigen::VectorXd& q, double margin);
  std::optional<std::string> question(const std::vector<CheckedPair>& bodies, const Eigen::VectorXd& q,
                                      double margin);
  const std::string& contentDigest(const Body& body);
  const fcl::CollisionGeometryd& hull(const Body& body);
  Placed first(const CheckedPair& pair, const Kinematics::State& state);
  Placed second(const CheckedPair& pair, const Kinematics::State& state);

  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const RobotGeometry> robot_, scene_;
  std::vector<Obstacle> obstacles_;
  detail::VolumeCache* cache_;
  std::map<const Body*, std::string> digests_;  // of contentOf() of the bodies in robot_ and scene_
  // Key: file and scale, or the primitive itself.
  std::map<std::pair<std::string, const void*>, std::unique_ptr<ExactBody>> exact_;  // by mesh, or primitive
  std::map<const Body*, std::shared_ptr<const fcl::CollisionGeometryd>> partHulls_;
};

}  // namespace fcl_stpbv::report
