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

class KeyedMesh;

/// One shape of one link, and the file of a mesh.
struct ShapeSource {
  int link = -1;
  int number = 1;  ///< number among the link's shapes, from 1
  const ShapeModel* shape = nullptr;
  std::string file;  ///< "" for a primitive
  std::string key;   ///< of the mesh (keyed_mesh.h); "" for a primitive

  /// The mesh's points, scaled. They are read at the first call and kept. @throws Error naming the file, also
  /// if it does not have the key any more.
  const std::vector<Eigen::Vector3d>& points() const;
  /// Keeps the points of the mesh that gave the key. @throws Error naming the file.
  void keep(const KeyedMesh& mesh) const;

 private:
  mutable std::vector<Eigen::Vector3d> points_;
};

/// Whether the cache has the volume of the link (by name) from the mesh with this key.
using IsCached = std::function<bool(const std::string& link, const std::string& meshKey)>;

struct ShapeSources {
  std::vector<ShapeSource> shapes;    ///< in the order of the links; they point into the robot's model
  std::set<int> incomplete;           ///< links for which a shape was left out
  std::vector<std::string> warnings;  ///< whole sentences for the user
};

/// Finds all meshes of a robot and reads those that are not cached. Faults are added to `faults.shapes`, and
/// these shapes are left out. `faults` must contain the faults of the robot's URDF.
/// @param visual whether to use the visual shapes. If the robot has no collision shape at all, they are used
/// in any case, with a warning.
ShapeSources readShapes(const RobotModel& robot, bool visual, const std::vector<std::string>& packagePath,
                        const IsCached& isCached, LoadFaults& faults);

}  // namespace fcl_stpbv::detail
