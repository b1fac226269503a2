// The parts of the Python module, each filled in by its own file.
#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
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

/// A file that may be left out. @throws Error naming the argument where its name is empty: it was not left
/// out.
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

inline std::vector<std::string> toText(const std::vector<Path>& paths) {
  return {paths.begin(), paths.end()};
}

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
