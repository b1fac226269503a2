// Finds the files that a URDF refers to: package://, file://, absolute and relative names.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace fcl_stpbv::detail {

/// Turns the file names of one URDF into paths.
///
/// `package://name/rest` is searched in this order:
/// 1. in each given folder, as `folder/name/rest`, or `folder/rest` if the folder is that package itself;
/// 2. in ROS_PACKAGE_PATH, in the same way;
/// 3. in `share` of AMENT_PREFIX_PATH;
/// 4. in the package that contains the URDF, and beside that package;
/// 5. again in the places of 1 and 2, by the last folders of `rest`, for a package inside another one;
/// 6. in the URDF's folder and the two folders above it, as `folder/name/rest`;
/// 7. in deeper folders of ROS_PACKAGE_PATH, for workspaces with packages inside repositories.
/// Paths that are not absolute, also after file://, are relative to the URDF's folder. If the URDF is a
/// symbolic link, the folders around its target come after those around the link. After ://, %20 is read as a
/// space if no file has the literal name. Not thread-safe: one thread at a time may use an object.
class PackagePath {
 public:
  /// `urdf` is the file that contains the names. `folders` are searched first.
  explicit PackagePath(const std::string& urdf, std::vector<std::string> folders = {});

  /// The path of an existing file. @throws Error naming every path that was tried.
  std::string resolve(const std::string& uri) const;

  /// The folder that a relative name starts from: the one where resolve() finds the file, else the URDF's
  /// folder.
  std::string folderOf(const std::string& name) const;

 private:
  std::vector<std::string> candidates(const std::string& uri) const;
  const std::vector<std::string>& deeper(const std::string& package) const;

  // The folder of the URDF's name, then the folder of the file behind a symbolic link.
  std::vector<std::string> urdfFolders_;
  std::vector<std::string> folders_;     // each contains packages or is a package
  std::vector<std::string> rosFolders_;  // those of them that come from ROS_PACKAGE_PATH
  std::vector<std::string> prefixes_;    // each contains share/<package>
  mutable std::map<std::string, std::vector<std::string>> deeper_;  // packages found deeper, by name
  std::vector<std::string> above_;  // folders around the URDF, innermost first
};

}  // namespace fcl_stpbv::detail
