// The shapes of a robot before volumes are built: selects them, finds their files and reads them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "fcl_stpbv/error.h"
#include "fcl_stpbv/robot/link_geometry.h"
#include "fcl_stpbv/robot/robot_model.h"

namespace fcl_stpbv::detail {

/// The error with the file's name before its message, unless the message contains the name.
Error namingFile(const std::string& file, const Error& error);

/// The key of a mesh in the cache (volume_cache.h): a digest of the file's content and of the scale.
/// @throws Error naming the file.
std::string meshKey(const std::string& file, const Eigen::Vector3d& scale);

/// The same of a body's mesh, which is read only where nobody has named it yet.
std::string meshKey(const Body& body);

/// One shape of one link; of a mesh, its file.
struct ShapeSource {
  int link = -1;
  int number = 1;  ///< of the link's shapes, from 1
  const ShapeModel* shape = nullptr;
  std::string file;  ///< "" for a primitive
  std::string key;   ///< meshKey(); "" for a primitive

  /// The mesh's points, scaled; read when first asked for and kept. @throws Error naming the file.
  const std::vector<Eigen::Vector3d>& points() const;

 private:
  mutable std::vector<Eigen::Vector3d> points_;
};

/// Whether a volume of the link (by name) built from the mesh of this key need not be built again.
using IsCached = std::function<bool(const std::string& link, const std::string& meshKey)>;

struct ShapeSources {
  std::vector<ShapeSource> shapes;    ///< in the order of the links; they point into the robot's model
  std::set<int> incomplete;           ///< links that a shape was left out of
  std::vector<std::string> warnings;  ///< whole sentences, to be told to the user
};

/// Finds all meshes of a robot and reads those that are not cached. What is wrong is added to
/// `faults.shapes`, and the shape is left out. `faults` holds what was wrong with the robot's URDF.
/// @param visual the visual shapes; they are taken as well, with a warning, where
/// the robot has no collision shape at all.
ShapeSources readShapes(const RobotModel& robot, bool visual, const std::vector<std::string>& packagePath,
                        const IsCached& isCached, LoadFaults& faults);

}  // namespace fcl_stpbv::detail
