// The files of a robot and of the scene around it, loaded for a tool: what is wrong with any of them is said
// in one message, before a volume is built.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fcl_stpbv/robot/geometry_steps.h"
#include "fcl_stpbv/robot/srdf.h"

namespace fcl_stpbv::report {

struct RobotFiles {
  std::string urdf, srdf, obstacles;  ///< "" where not given
  GeometryOptions geometry, sceneGeometry;
  bool skipInvalid = false;  ///< go on without the shapes that are wrong
};

class RobotLoader {
 public:
  explicit RobotLoader(RobotFiles files) : files_(std::move(files)) {}

  /// Reads everything. What is wrong is in faults(), to which the caller may add; only robot() and srdf() can
  /// be asked for, and they may be incomplete.
  /// @throws Error where a file cannot be read at all.
  void read();
  /// Builds the volumes. @throws Error listing all faults, and where a body is wanted and there is none.
  void build();

  LoadFaults& faults() { return faults_; }
  std::shared_ptr<const RobotModel> robot() const { return robot_; }
  std::shared_ptr<const Srdf> srdf() const { return srdf_; }  ///< null where none was given
  std::shared_ptr<const RobotGeometry> geometry() const { return geometry_; }
  std::shared_ptr<const RobotModel> scene() const { return scene_; }  ///< null where none was given
  const RobotGeometry& sceneGeometry() const { return sceneGeometry_; }
  /// Whole sentences, to be told to the user; those on shapes left out are the first.
  std::vector<std::string> warnings() const;
  /// One entry for each shape that was left out.
  const std::vector<std::string>& skipped() const { return faults_.shapes; }

 private:
  RobotFiles files_;
  LoadFaults faults_;
  std::shared_ptr<const RobotModel> robot_, scene_;
  std::shared_ptr<const Srdf> srdf_;
  detail::ShapeSources shapes_, sceneShapes_;
  std::shared_ptr<const RobotGeometry> geometry_;
  RobotGeometry sceneGeometry_;
};

}  // namespace fcl_stpbv::report
