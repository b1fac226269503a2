// Where the files are that a URDF names: package://, file://, absolute and relative names.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace fcl_stpbv::detail {

/// Turns the file names of one URDF into paths.
///
/// `package://name/rest` is looked for in each given folder (as `folder/name/rest`, or
/// `folder/rest` where the folder is that package itself), then in ROS_PACKAGE_PATH, in `share` of
/// AMENT_PREFIX_PATH, in the package that encloses the URDF, and beside that package; then in the
/// first two by the last folders of `rest`, for a package inside another; at last deeper in ROS_PACKAGE_PATH,
/// as a workspace has its packages in repositories. Paths that are not absolute are
/// the URDF's folder's, after file:// too. Where the URDF is a link, the folders around the file behind it
/// come after those around the link. After :// a %20 stands for a space where no file is named so. One thread
/// at a time may use one.
class PackagePath {
 public:
  /// `urdf` is the file that names will come from; `folders` go before everything else.
  explicit PackagePath(const std::string& urdf, std::vector<std::string> folders = {});

  /// The path of an existing file. @throws Error naming every path that was tried.
  std::string resolve(const std::string& uri) const;

  /// The folder that a relative name is of: where resolve() finds it, else the URDF's own.
  std::string folderOf(const std::string& name) const;

 private:
  std::vector<std::string> candidates(const std::string& uri) const;
  const std::vector<std::string>& deeper(const std::string& package) const;

  std::vector<std::string> urdfFolders_;                            // of the name, then of the file behind it
  std::vector<std::string> folders_;                                // may hold packages, or be one
  std::vector<std::string> rosFolders_;                             // of these, ROS_PACKAGE_PATH
  std::vector<std::string> prefixes_;                               // hold share/<package>
  mutable std::map<std::string, std::vector<std::string>> deeper_;  // packages found deeper, by name
  std::vector<std::string> above_;  // folders around the URDF, innermost first
};

}  // namespace fcl_stpbv::detail
