// The files that a robot is converted to, in memory.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "fcl_stpbv/io/atomic_write.h"
#include "fcl_stpbv/report/part_urdf.h"
#include "fcl_stpbv/report/robot_conversion.h"
#include "fcl_stpbv/robot/link_geometry.h"

namespace fcl_stpbv::report {

/// Meshes and volumes of a robot's parts, its URDF and SRDF, and the manifest. Both arguments must outlive
/// it.
class PartFiles {
 public:
  PartFiles(const RobotConversion& conversion, const CollisionReport& report);

  /// To be called once. `inputs` and `key` go into the manifest.
  detail::FolderFiles make(const nlohmann::ordered_json& inputs, const std::string& key);

  int parts() const { return parts_; }       ///< number of parts written, of all meshes
  double excess() const { return excess_; }  ///< upper bound on the excess of any volume over its mesh (m)

 private:
  void certifyHulls();
  const Body* bodyOf(const LinkModel& link, std::size_t shape) const;
  std::vector<const Body*> partsOf(int index);
  std::string fileName(const std::string& body);
  void add(const LinkModel& link, const ShapeModel& shape, std::size_t number, PartUrdf& urdf);
  void addVolume(const Body& body, const std::string& name, nlohmann::ordered_json& entry);
  void addMesh(const Body& body, nlohmann::ordered_json& entry, std::vector<std::string>& meshes);
  std::string manifest(const nlohmann::ordered_json& inputs, const std::string& key, const std::string& stem);

  const RobotConversion& conversion_;
  const CollisionReport& report_;
  LinkParts hulls_;
  std::set<std::string> taken_;  // file names in use
  detail::FolderFiles files_;
  nlohmann::ordered_json links_ = nlohmann::ordered_json::array();
  int parts_ = 0;
  double excess_ = 0;
};

}  // namespace fcl_stpbv::report
