// The parts of the Python module, each filled in by its own file.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "fcl_stpbv/error.h"
#include "floats.h"

namespace fcl_stpbv {

using Path = std::filesystem::path;  ///< a str, bytes or os.PathLike in Python
using PointArray = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

void addVolume(pybind11::module_& module);
void addRobot(pybind11::module_& module);
void addShards(pybind11::module_& module);
void addPostures(pybind11::module_& module);

/// A file that may be omitted. @throws Error naming the argument if its name is empty, because then it was
/// not omitted.
inline const std::optional<Path>& named(const std::optional<Path>& file, const char* argument) {
  if (file && file->empty())
    throw Error(std::string(argument) + ": the file's name is empty; None leaves it out");
  return file;
}

/// @throws Error naming the argument.
inline void requireCount(long count, long least, const char* name) {
  if (count < least)
    throw Error(std::string(name) + ": got " + std::to_string(count) + ", expected " + std::to_string(least) +
                " or more");
}

/// Folders that contain packages: a single one in Python, or a list of them.
struct Folders {
  std::vector<std::string> names;

  /// The names. @throws Error for a name that is no folder.
  const std::vector<std::string>& existing() const {
    std::error_code ignored;
    for (const std::string& name : names)
      if (!std::filesystem::is_directory(name, ignored))
        throw Error("package_path: '" + name + "' is no folder; give one that holds packages");
    return names;
  }
};

inline std::vector<Eigen::Vector3d> toPoints(const PointArray& array) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<std::size_t>(array.rows()));
  for (Eigen::Index i = 0; i < array.rows(); ++i) points.emplace_back(array.row(i));
  return points;
}

inline PointArray toArray(const std::vector<Eigen::Vector3d>& points) {
  PointArray array(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) array.row(static_cast<Eigen::Index>(i)) = points[i];
  return array;
}

}  // namespace fcl_stpbv

template <>
struct pybind11::detail::type_caster<fcl_stpbv::Folders> {
  PYBIND11_TYPE_CASTER(fcl_stpbv::Folders, const_name("Union[os.PathLike, List[os.PathLike]]"));

  bool load(handle source, bool convert) {
    make_caster<fcl_stpbv::Path> one;
    if (one.load(source, convert)) {
      value.names = {cast_op<fcl_stpbv::Path&>(one).string()};
      return true;
    }
    PyErr_Clear();
    make_caster<std::vector<fcl_stpbv::Path>> several;
    if (!several.load(source, convert)) return false;
    for (const fcl_stpbv::Path& path : cast_op<std::vector<fcl_stpbv::Path>&>(several))
      value.names.push_back(path.string());
    return true;
  }
  static handle cast(const fcl_stpbv::Folders& folders, return_value_policy, handle) {
    list names;
    for (const std::string& name : folders.names) names.append(name);
    return names.release();
  }
};
