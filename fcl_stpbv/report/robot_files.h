// Loads the files of a robot and of its scene, for a tool. All faults are reported in one message, before any
// volume is built. Every pair that may be checked gets an STP-BV.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/checked_pairs.h"
#include "fcl_stpbv/robot/geometry_steps.h"
#include "fcl_stpbv/robot/kinematics.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/srdf.h"

namespace fcl_stpbv::report {

struct RobotFiles {
  std::string urdf, srdf, obstacles;  ///< "" if not given
  GeometryOptions geometry;           ///< also for the scene, except options that name single links
  bool flatObstacles = false;         ///< the scene's meshes stay convex polyhedra
  bool flatPrimitives = false;  ///< primitives get no smooth cover even if a pair needs one (checked_pairs.h)
  bool skipInvalid = false;     ///< go on without the wrong shapes
  bool writesPairs = false;     ///< the SRDF's pairs will be written anew, so it need not leave out any yet
  BaseMotion base = BaseMotion::fixed;  ///< a base that moves makes pairs of all links and obstacles
};

class RobotLoader {
 public:
  explicit RobotLoader(RobotFiles files);

  /// Reads everything. Faults are in faults(), to which the caller may add. Afterwards only robot(), srdf()
  /// and, if there is no error, kinematics() are available, and they may be incomplete.
  /// @throws Error if a file cannot be read at all.
  void read();
  /// Builds the volumes, and the covers of primitives that pairs need. @throws Error listing all faults, and
  /// if the robot or the scene has no body.
  void build();

  LoadFaults& faults() { return faults_; }
  std::shared_ptr<const RobotModel> robot() const { return robot_; }
  std::shared_ptr<const Srdf> srdf() const { return srdf_; }  ///< null if none was given
  std::shared_ptr<const Kinematics> kinematics() const { return kinematics_; }
  std::shared_ptr<const RobotGeometry> geometry() const { return geometry_; }
  /// The bodies behind obstacles(), in their order.
  std::shared_ptr<const RobotGeometry> sceneGeometry() const { return sceneGeometry_; }
  std::vector<Obstacle> obstacles() const;
  /// The shapes that read() found, of the robot and of the scene.
  const detail::ShapeSources& shapes() const { return shapes_; }
  const detail::ShapeSources& sceneShapes() const { return sceneShapes_; }
  /// The mesh files of the robot and of the scene.
  std::vector<std::string> meshFiles() const;
  /// Whole sentences for the user.
  std::vector<std::string> warnings() const;
  /// One entry for each shape that was left out; nothing is checked against it.
  const std::vector<std::string>& skipped() const { return faults_.shapes; }

 private:
  RobotFiles files_;
  GeometryOptions sceneOptions_;
  LoadFaults faults_;
  std::shared_ptr<const RobotModel> robot_, scene_;
  std::shared_ptr<const Kinematics> kinematics_;
  std::shared_ptr<const Srdf> srdf_;
  detail::ShapeSources shapes_, sceneShapes_;
  std::shared_ptr<const RobotGeometry> geometry_, sceneGeometry_;
};

}  // namespace fcl_stpbv::report
